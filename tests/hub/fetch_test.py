#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""`ovimap models fetch` against a hub on this machine that answers, and fails, as the real one does.
Usage: fetch_test.py PROGRAM"""
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import numpy as np
    import yaml
    import tiny_models
except ImportError as missing:  # set up by tools/setup.sh --tests
    print(f"skipped: {missing}; tools/setup.sh --tests installs what this test needs")
    sys.exit(77)
import standin

PROGRAM = ""
FAST = ["--set", "hub.first_wait_s=0.01", "--set", "hub.stall_timeout_s=5", "--set", "hub.connect_timeout_s=5"]
REPOSITORIES = {
    "tests/clip": tiny_models.encoder_files("clip"), "tests/siglip": tiny_models.encoder_files("siglip"),
    "tests/siglip2": tiny_models.encoder_files("siglip2"), "tests/sam": tiny_models.sam_files(boxes=False),
    "tests/sam2": tiny_models.sam_files(boxes=True),
}
NETWORK = "onnx/text_model.onnx"  # the large one


class Fetches(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name)
        self.models = self.scratch / "models"
        self.hub = standin.Hub()
        self.addCleanup(self.hub.close)
        for name, files in REPOSITORIES.items():
            self.hub.repositories[name] = standin.Repository(dict(files))
        self.catalogue = self.scratch / "catalogue.yaml"
        entry = tiny_models.catalogue_entry
        self.catalogue.write_text("models:\n" + entry("tiny-clip", "dual_encoder", "tests/clip", 30)
                                  + entry("tiny-siglip", "dual_encoder", "tests/siglip", 40)
                                  + entry("tiny-siglip2", "dual_encoder", "tests/siglip2", 20)
                                  + entry("tiny-sam", "sam", "tests/sam") + entry("tiny-sam2", "sam", "tests/sam2")
                                  + entry("tiny-nothing", "sam", "tests/nothing"))

    def environment(self, **more):
        ours = {"HF_ENDPOINT": self.hub.address, "HOME": str(self.scratch), "PATH": os.environ["PATH"]}
        return ours | {key: str(text) for key, text in more.items()}

    def run_models(self, *arguments, env=None, **options):
        command = [PROGRAM, "models", *arguments, "--model-dir", str(self.models), "--catalogue", str(self.catalogue)]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.scratch, timeout=120,
                              env=self.environment(**(env or {})), **options)

    def fetch(self, name, *arguments, **options):
        done = self.run_models("fetch", name, *FAST, *arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def refusal(self, *arguments, **options):
        """The one line with which a fetch ends; nothing of it is usable then."""
        done = self.run_models("fetch", *arguments, *FAST, **options)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(self.installed(), {})
        return done.stderr

    def installed(self):
        done = self.run_models("list", "--json")
        rows = json.loads(done.stdout)["models"]  # with those beside the program
        return {row["name"]: row for row in rows if row["folder"].startswith(str(self.models))}

    def description(self, name):
        return yaml.safe_load((self.models / name / "model.yaml").read_text())

    def downloads(self, path):
        return [headers for server, headers in self.hub.asked(path) if server == "content"]


class WhatIsFetched(Fetches):
    def test_an_encoder_is_fetched_whole_and_works(self):
        done = self.fetch("tiny-clip")
        self.assertIn("8 of 8 plain colours and 4 of 4 drawn shapes told right", done.stdout)
        self.assertEqual(done.stderr, "")
        model = self.description("tiny-clip")
        self.assertEqual(model["revision"], standin.COMMIT)
        self.assertEqual((model["kind"], model["license"], model["variant"]), ("dual_encoder", "MIT", "full"))
        self.assertEqual(model["self_test"], "passed")
        self.assertNotIn("items_at_once", model)
        files = REPOSITORIES["tests/clip"]
        for path in ("onnx/vision_model.onnx", NETWORK, "config.json", "LICENSE"):
            self.assertEqual((self.models / "tiny-clip" / path).read_bytes(), files[path])
            self.assertEqual(model["sha256"][path], hashlib.sha256(files[path]).hexdigest())
            self.assertEqual(int(model["bytes"][path]), len(files[path]))
        self.assertEqual(model["git_blob"]["config.json"], standin.git_blob(files["config.json"]))
        self.assertFalse((self.models / "tiny-clip/onnx/model.onnx").exists())
        self.assertEqual(self.run_models("verify", "tiny-clip").returncode, 0)
        self.assertEqual([p.name for p in (self.models / ".partial").iterdir()], ["tiny-clip.lock"])

    def test_sizes_and_tensors_are_read_not_assumed(self):
        self.fetch("tiny-clip")
        model = self.description("tiny-clip")
        self.assertEqual(int(model["input"]["size"]), tiny_models.SIDE)
        self.assertEqual(model["input"]["mean"], [127.5] * 3)
        self.assertEqual((model["input"]["resize"], model["input"]["filter"]), ("stretch", "bilinear"))
        self.assertEqual(model["networks"]["text"]["inputs"], {"ids": "input_ids", "mask": "attention_mask"})
        self.assertEqual(model["networks"]["image"]["outputs"], {"embedding": "image_embeds"})
        self.assertEqual((int(model["embedding_dim"]), int(model["context_length"])), (tiny_models.WIDTH, tiny_models.CONTEXT))

    def test_words_and_pictures_find_each_other(self):
        for name in ("tiny-clip", "tiny-siglip2"):
            self.fetch(name)
            picture = self.scratch / "picture.png"
            write_png(picture, tiny_models.drawing("yellow"))
            done = self.run_models("try", name, str(picture), "the colour blue", "the colour yellow", "the colour red", "--json")
            answer = json.loads(done.stdout)
            self.assertEqual(answer["texts"][0]["text"], "the colour yellow", name)
            expected = tiny_models.cells(tiny_models.drawing("yellow"))
            np.testing.assert_allclose(answer["embedding"], expected / np.linalg.norm(expected), atol=1e-3)

    def test_gemmas_tokenizer_comes_from_tokenizer_json(self):
        self.assertIn("8 of 8 plain colours and 4 of 4", self.fetch("tiny-siglip2").stdout)
        model = self.description("tiny-siglip2")
        self.assertEqual((model["tokenizer"], model["text_rule"], int(model["pad_id"]), int(model["eos_id"])),
                         ("sentencepiece", "none", 0, 1))
        self.assertNotIn("bos_id", model)
        self.assertIn("spiece.model", model["sha256"])

    def test_a_model_that_tells_nothing_right_gets_a_loud_warning(self):
        done = self.fetch("tiny-siglip")  # random weights
        self.assertIn("WARNING: tiny-siglip: of drawn colours and shapes it tells", done.stderr)
        self.assertEqual(self.description("tiny-siglip")["self_test"], "doubtful")
        rows = self.installed()
        self.assertTrue(rows["tiny-siglip"]["doubtful"])

    def test_half_precision_with_weights_in_a_file_beside(self):
        self.fetch("tiny-clip", "--variant", "fp16")
        model = self.description("tiny-clip-fp16")
        self.assertEqual(model["self_test"], "passed")
        self.assertIn("onnx/text_model_fp16.onnx_data", model["sha256"])
        self.assertNotIn(NETWORK, model["sha256"])

    def test_networks_that_mix_what_stands_side_by_side_run_one_by_one(self):
        done = self.fetch("tiny-clip", "--variant", "quantized", "--as", "small")
        self.assertIn("one by one", done.stdout)
        self.assertEqual(int(self.description("small")["items_at_once"]), 1)

    def test_mask_networks(self):
        for name, labels in (("tiny-sam", "false"), ("tiny-sam2", None)):
            done = self.fetch(name)
            self.assertGreater(float(re.search(r"IoU (\S+)", done.stdout)[1]), 0.8)
            model = self.description(name)
            self.assertEqual(model.get("box_corners"), None if labels is None else False)
            self.assertEqual("boxes" in model["networks"]["decoder"]["inputs"], labels is None)

    def test_fetching_again_is_nothing_to_do_and_a_new_revision_replaces(self):
        self.fetch("tiny-clip")
        before = len(self.hub.requests)
        self.assertIn("is there already", self.fetch("tiny-clip").stdout)
        self.assertEqual(len(self.hub.requests) - before, 2)  # what main is now, and its list
        self.hub.repositories["tests/clip"].commit = "f" * 40
        self.fetch("tiny-clip")
        self.assertEqual(self.description("tiny-clip")["revision"], "f" * 40)

    def test_a_harmed_model_is_fetched_anew(self):
        self.fetch("tiny-clip")
        (self.models / "tiny-clip" / NETWORK).write_bytes(b"harm")
        self.assertNotIn("already", self.fetch("tiny-clip").stdout)
        self.assertEqual(self.run_models("verify", "tiny-clip").returncode, 0)

    def test_a_folder_of_ones_own_is_left_alone(self):
        own = self.models / "tiny-clip"
        shutil.copytree(tiny_models.GOLDEN / "golden_clip", own)
        done = self.run_models("fetch", "tiny-clip", *FAST)
        self.assertEqual(done.returncode, 2)
        self.assertIn("was not fetched; name another with --as", done.stderr)
        self.assertIn("golden clip", (own / "model.yaml").read_text())

    def test_the_list_says_what_there_is_and_what_auto_takes(self):
        done = self.run_models("list")
        self.assertIn("tiny-sam2", done.stdout)
        self.assertIn("full 1 MB", done.stdout)
        self.fetch("tiny-clip")
        self.fetch("tiny-siglip2")
        self.fetch("tiny-siglip")  # preferred to both, but doubtful
        listed = json.loads(self.run_models("list", "--json").stdout)
        self.assertEqual(listed["auto"], "tiny-clip")
        self.assertEqual({row["name"] for row in listed["fetchable"]} >= {"tiny-sam", "tiny-clip"}, True)
        lines = self.run_models("list").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines if "taken by --encoder auto" in line], ["tiny-clip"])

    def test_the_built_in_list_says_that_nothing_was_tried(self):
        done = subprocess.run([PROGRAM, "models", "list"], capture_output=True, text=True, env=self.environment(),
                              cwd=self.scratch)
        rows = [line for line in done.stdout.splitlines() if line.startswith("siglip-large-384")]
        self.assertEqual(len(rows), 1)
        self.assertIn("not tried here", rows[0])


class Hints(Fetches):
    """Whoever has the small default encoder alone is told of a better one, by the demo only where it could be fetched."""

    def demo(self, hub):
        done = subprocess.run([PROGRAM, "demo", "shown", "--masks", "gt"], capture_output=True, text=True, cwd=self.scratch,
                              timeout=300, env=self.environment(HF_ENDPOINT=hub))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("words go by the small default encoder; a better one: ovimap models fetch siglip-base-224", done.stderr)
        return done.stdout.splitlines()

    def test_the_demo_says_how_to_get_better_words(self):
        self.assertRegex(self.demo(self.hub.address)[-1], r"^Better +words: ovimap models fetch siglip-base-224")

    def test_the_demo_names_nothing_that_cannot_be_fetched(self):
        self.assertFalse([line for line in self.demo("http://127.0.0.1:9") if line.startswith("Better")])


class Transfers(Fetches):
    def test_a_broken_transfer_is_gone_on_with(self):
        self.hub.faults.where, self.hub.faults.cut_after = NETWORK, [30000, 40000]
        self.fetch("tiny-clip")
        ranges = [headers.get("Range") for headers in self.downloads(NETWORK)]
        self.assertEqual(ranges, [None, "bytes=30000-", "bytes=70000-"])
        self.assertEqual(self.run_models("verify", "tiny-clip").returncode, 0)

    def test_a_fetch_that_gave_up_is_resumed_by_the_next(self):
        self.hub.faults.where, self.hub.faults.cut_after = NETWORK, [20000, 20000]
        message = self.refusal("tiny-clip", "--set", "hub.attempts=2")
        self.assertIn("broke", message)
        self.assertIn("goes on where it was", message)
        self.fetch("tiny-clip")
        self.assertEqual([h.get("Range") for h in self.downloads(NETWORK)], [None, "bytes=20000-", "bytes=40000-"])
        self.assertEqual(len(self.downloads("onnx/vision_model.onnx")), 1)  # not fetched twice

    def test_a_server_without_ranges_begins_anew(self):
        self.hub.faults.where, self.hub.faults.cut_after, self.hub.faults.no_ranges = NETWORK, [30000], True
        self.fetch("tiny-clip")
        self.assertEqual(self.run_models("verify", "tiny-clip").returncode, 0)

    def test_a_killed_fetch_leaves_nothing_usable_and_is_gone_on_with(self):
        self.hub.faults.where, self.hub.faults.cut_after = NETWORK, [50000]
        command = [PROGRAM, "models", "fetch", "tiny-clip", "--model-dir", str(self.models), "--catalogue", str(self.catalogue),
                   "--set", "hub.first_wait_s=60"]
        running = subprocess.Popen(command, env=self.environment(), cwd=self.scratch, stdout=subprocess.DEVNULL)
        while not self.downloads(NETWORK):
            time.sleep(0.01)
        time.sleep(0.2)  # it now waits to try again
        running.send_signal(signal.SIGKILL)
        running.wait()
        self.assertEqual(self.installed(), {})
        self.fetch("tiny-clip")
        self.assertEqual(self.downloads(NETWORK)[-1].get("Range"), "bytes=50000-")

    def test_an_interrupted_fetch_says_how_to_go_on(self):
        self.hub.faults.where, self.hub.faults.cut_after = NETWORK, [50000]
        command = [PROGRAM, "models", "fetch", "tiny-clip", "--model-dir", str(self.models), "--catalogue", str(self.catalogue),
                   "--set", "hub.first_wait_s=60"]
        running = subprocess.Popen(command, env=self.environment(), cwd=self.scratch, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        while not self.downloads(NETWORK):
            time.sleep(0.01)
        time.sleep(0.2)  # it now waits to try again
        running.send_signal(signal.SIGINT)
        self.assertIn("the fetch was stopped; run it again", running.communicate(timeout=30)[1])
        self.assertEqual(running.returncode, 2)
        self.assertEqual(self.installed(), {})

    def test_what_lay_there_and_is_no_part_of_it_is_thrown_away(self):
        place = self.models / ".partial" / f"tiny-clip.full.{standin.COMMIT}" / "onnx"
        place.mkdir(parents=True)
        (place / "text_model.onnx").write_bytes(b"x" * 1000)
        self.fetch("tiny-clip")
        self.assertEqual([h.get("Range") for h in self.downloads(NETWORK)], ["bytes=1000-", None])

    def test_a_list_of_several_pages(self):
        self.hub.faults.page = 4
        self.fetch("tiny-clip")
        self.assertGreater(len(self.hub.asked("/tree/")), 3)

    def test_a_busy_hub_is_asked_again(self):
        self.hub.faults.statuses, self.hub.faults.retry_after = [503, 429], "1"
        start = time.monotonic()
        self.fetch("tiny-clip")
        self.assertGreaterEqual(time.monotonic() - start, 2)  # as long as it was asked to wait

    def test_one_fetch_at_a_time(self):
        self.fetch("tiny-sam")
        with open(self.models / ".partial/tiny-clip.lock", "w") as lock:
            import fcntl
            fcntl.flock(lock, fcntl.LOCK_EX)
            done = self.run_models("fetch", "tiny-clip", *FAST)
        self.assertEqual(done.returncode, 2)
        self.assertIn("a fetch of tiny-clip is under way already", done.stderr)

    def test_a_proxy_is_gone_through(self):
        env = {"HF_ENDPOINT": "http://hub.invalid", "http_proxy": self.hub.address}
        self.hub.repositories["tests/sam"].is_large = lambda _: False  # all from the hub itself
        self.fetch("tiny-sam", env=env)
        self.assertTrue(all(address.startswith("http://hub.invalid/") for *_, address in self.hub.requests))


class Tokens(Fetches):
    def test_a_token_stays_with_its_hub(self):
        self.hub.faults.token = "hf_secret"
        self.fetch("tiny-clip", env={"HF_TOKEN": "hf_secret"})
        sent = {(server, headers.get("Authorization")) for server, _, headers, _ in self.hub.requests}
        self.assertEqual(sent, {("hub", "Bearer hf_secret"), ("content", None)})

    def test_no_token_or_a_wrong_one(self):
        self.hub.faults.token = "hf_secret"
        self.assertIn("401", self.refusal("tiny-clip"))
        self.assertIn("needs a token in HF_TOKEN", self.refusal("tiny-clip"))
        self.assertIn("the token in HF_TOKEN may not read it", self.refusal("tiny-clip", env={"HF_TOKEN": "other"}))

    def test_a_token_never_travels_in_the_clear(self):
        message = self.refusal("tiny-clip", env={"HF_TOKEN": "t", "HF_ENDPOINT": "http://hub.example"})
        self.assertIn("unencrypted", message)


class Refusals(Fetches):
    def test_no_such_name(self):
        self.assertIn("did you mean 'tiny-clip'?", self.refusal("tiny-clop"))

    def test_no_such_variant(self):
        message = self.refusal("tiny-sam", "--variant", "fp16")
        self.assertIn("has no variant 'fp16'; it has full", message)
        self.assertIn("accepted is full, fp16, quantized", self.refusal("tiny-clip", "--variant", "int4"))

    def test_no_such_repository(self):
        self.assertIn("404", self.refusal("tiny-nothing"))

    def test_no_hub(self):
        message = self.refusal("tiny-clip", env={"HF_ENDPOINT": "http://127.0.0.1:1"})
        self.assertIn("the model hub cannot be reached at http://127.0.0.1:1/", message)
        self.assertIn("HF_ENDPOINT is 'here'", self.refusal("tiny-clip", env={"HF_ENDPOINT": "here"}))
        done = self.run_models("hub", env={"HF_ENDPOINT": "http://127.0.0.1:1"})
        self.assertEqual((done.returncode, done.stdout), (1, "http://127.0.0.1:1 does not answer\n"))

    def test_too_many_requests(self):
        self.hub.faults.statuses, self.hub.faults.retry_after = [429], "3600"
        message = self.refusal("tiny-clip")
        self.assertIn("429, too many requests", message)
        self.assertIn("try again in 3600 s", message)

    def test_a_wrong_digest(self):
        for path in ("config.json", NETWORK):  # by git's digest, by SHA-256; what came right is not fetched again
            content = bytearray(REPOSITORIES["tests/clip"][path])
            content[-5] ^= 1
            self.hub.faults.other_content = {path: bytes(content)}
            message = self.refusal("tiny-clip")
            self.assertIn("has the digest", message)
            self.assertIn(path, message)
        self.hub.faults.other_content = {}
        self.fetch("tiny-clip")

    def test_more_than_was_listed(self):
        self.hub.faults.other_content = {NETWORK: REPOSITORIES["tests/clip"][NETWORK] + b"more"}
        self.assertIn("more than the listed", self.refusal("tiny-clip"))

    def test_no_room(self):
        self.hub.repositories["tests/clip"].listed_bytes[NETWORK] = 10**16
        message = self.refusal("tiny-clip")
        self.assertIn("no room for tiny-clip", message)
        self.assertIn("MB are free", message)
        self.assertEqual(self.downloads("onnx"), [])

    def test_a_disk_that_fills_up(self):
        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (50000, 50000))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

        message = self.refusal("tiny-clip", preexec_fn=small_files, restore_signals=False)
        self.assertIn("cannot write", message)
        self.assertIn("make room", message)
        self.fetch("tiny-clip")
        self.assertEqual(self.downloads(NETWORK)[-1].get("Range"), "bytes=50000-")

    def test_redirects_without_end(self):
        self.hub.faults.loop = True
        self.assertIn("redirects more than", self.refusal("tiny-clip", "--set", "hub.attempts=1"))

    def test_a_list_that_leads_out_of_the_folder(self):
        files = self.hub.repositories["tests/clip"].files
        files["../outside"] = b"x"
        self.assertIn("leaves the folder", self.refusal("tiny-clip"))

    def test_a_commit_that_is_none(self):
        self.hub.repositories["tests/clip"].commit = "../../elsewhere"
        self.assertIn("as the commit of tests/clip", self.refusal("tiny-clip"))

    def test_an_answer_that_is_no_list(self):
        self.hub.repositories["tests/clip"].entry = lambda path: {"type": "file"}
        self.assertIn("is HF_ENDPOINT a model hub?", self.refusal("tiny-clip"))


class WrongModels(Fetches):
    """Files that came whole and do not fit."""

    def changed(self, path, **keys):
        files = self.hub.repositories["tests/clip"].files
        files[path] = json.dumps(json.loads(files[path]) | keys).encode()
        return self.refusal("tiny-clip")

    def test_image_settings_that_ovimap_cannot_follow(self):
        self.assertIn("filter 1", self.changed("preprocessor_config.json", resample=1))

    def test_a_size_that_is_not_the_networks(self):
        files = self.hub.repositories["tests/clip"].files
        files["onnx/vision_model.onnx"] = tiny_models.image_tower("image_embeds", side=(16, 16))
        self.assertIn("preprocessor_config.json makes 20 pixels",
                      self.changed("preprocessor_config.json", size={"height": 20, "width": 20}))

    def test_another_kind_of_model(self):
        self.assertIn("of type 'blip'", self.changed("config.json", model_type="blip"))

    def test_another_tokenizer(self):
        backend = json.loads(REPOSITORIES["tests/clip"]["tokenizer.json"])
        self.assertIn("none of SigLIP's", self.changed("tokenizer.json", model=backend["model"] | {"type": "WordPiece"}))

    def test_pieces_of_another_tokenizer(self):
        files = self.hub.repositories["tests/siglip"].files
        backend = json.loads(files["tokenizer.json"])
        backend["model"]["vocab"][7][0] = "other"
        files["tokenizer.json"] = json.dumps(backend).encode()
        self.assertIn("its piece 7 is", self.refusal("tiny-siglip"))

    def test_half_precision_outside(self):
        files = self.hub.repositories["tests/clip"].files
        files["onnx/vision_model_fp16.onnx"] = tiny_models.image_tower("image_embeds", half_outside=True)
        self.assertIn("take --variant full", self.refusal("tiny-clip", "--variant", "fp16"))

    def test_wrong_normalisation_is_noticed(self):
        files = self.hub.repositories["tests/clip"].files
        settings = json.loads(files["preprocessor_config.json"]) | {"image_mean": [9, -9, 9]}
        files["preprocessor_config.json"] = json.dumps(settings).encode()
        self.assertIn("WARNING", self.fetch("tiny-clip").stderr)

    def test_a_network_that_gives_no_numbers(self):
        rows = np.full((1000, tiny_models.WIDTH), np.nan)
        self.hub.repositories["tests/clip"].files[NETWORK] = tiny_models.text_tower(rows, "text_embeds", mask=True)
        self.assertIn("not finite", self.refusal("tiny-clip"))


def write_png(path, picture):
    import struct
    import zlib
    height, width, _ = picture.shape
    rows = b"".join(b"\0" + row.astype(np.uint8).tobytes() for row in picture)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    text = b"".join(struct.pack(">I", len(c)) + k + c + struct.pack(">I", zlib.crc32(k + c)) for k, c in chunks)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + text)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
