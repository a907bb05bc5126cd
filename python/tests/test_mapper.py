# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Mapper: the program's result, and callables that do anything but what they should."""
import json
import os
import shutil
import subprocess
import sys
import threading

import numpy as np
import ovimap
import pytest
from conftest import wall

FRAMES = "::15"


def map_frames(frames, path, **options):
    mapper = ovimap.Mapper(**options)
    for frame in frames:
        mapper.process(frame)
    mapper.save(path)
    return ovimap.Map.open(path)


def copied(frame):
    """The same frame, through arrays."""
    return ovimap.Frame(
        np.array(frame.color), np.array(frame.depth), frame.world_from_camera, frame.camera, index=frame.index, name=frame.name
    )


@pytest.fixture(scope="module")
def frames(room):
    return list(ovimap.open_source(room).frames(FRAMES))


def test_gives_the_map_that_the_program_gives(room, frames, tmp_path):
    program = os.environ.get("OVIMAP_PROGRAM")
    if not program:
        pytest.skip("OVIMAP_PROGRAM does not name the program")
    subprocess.run([program, "run", room, "--frames", FRAMES, "-o", tmp_path / "program.ovimap"], check=True, capture_output=True)
    expected = ovimap.Map.open(tmp_path / "program.ovimap").content_hash
    assert map_frames(frames, tmp_path / "read.ovimap").content_hash == expected
    assert map_frames(map(copied, frames), tmp_path / "arrays.ovimap").content_hash == expected
    by_run = ovimap.run(room, tmp_path / "run.ovimap", frames=FRAMES)
    assert by_run.content_hash == expected and by_run.source == f"replica:{room}"


def test_masks_of_a_callable_are_those_of_the_truth(room, frames, tmp_path):
    source = ovimap.open_source(room)
    asked = []

    def truth(frame, prompts):
        asked.append(frame.index)
        assert prompts and prompts[0].area_px > 0 and len(prompts[0].extent_px) == 4
        return source.truth_ids(frame.index).astype(np.int64)

    every_frame = {"mask_interval": 1}
    mine = map_frames(frames, tmp_path / "mine.ovimap", masks=truth, settings=every_frame)
    theirs = map_frames(frames, tmp_path / "gt.ovimap", masks=ovimap.make_mask_source("gt", source), settings=every_frame)
    assert mine.content_hash == theirs.content_hash and mine.mask_frames == len(frames)
    assert asked == [frame.index for frame in frames]


def test_rated_masks_of_a_callable_are_those_of_a_rated_folder(room, tmp_path):
    source = ovimap.open_source(room)
    kept = tmp_path / "masks"
    kept.mkdir()

    def rated(frame, prompts):
        ids = source.truth_ids(frame.index)
        return ids, [0.5 + 0.4 * (i % 2) for i in range(int(ids.max()))]

    for frame in source.frames(FRAMES):
        ids, scores = rated(frame, [])
        (kept / f"{frame.index}.png").write_bytes(ovimap.encode_png(np.ascontiguousarray(ids)))
        (kept / f"{frame.index}.json").write_text(json.dumps({"scores": scores}))

    def mapped(name, masks):
        return ovimap.run(room, tmp_path / name, masks=masks, encoder=None, frames=FRAMES, settings={"mask_interval": 1}).content_hash

    hashes = [mapped("mine.ovimap", rated), mapped("kept.ovimap", kept), mapped("plain.ovimap", lambda frame, prompts: rated(frame, prompts)[0])]
    assert hashes[0] == hashes[1] != hashes[2]


@pytest.mark.parametrize(
    "returned, error, words",
    [
        (np.zeros((2, 2), int), ValueError, r"must be integers or bool \[\d+, \d+\], the size of the colour image; came int64 \[2, 2\]"),
        ("full", TypeError, "float64"),
        ("negative", ValueError, "ids from 0 to 65535; came the id -1"),
        (["high"], TypeError, "list of numbers"),
        ([1.5], ValueError, "from 0 to 1, not 1.5"),
        ([0.5, float("nan")], ValueError, "from 0 to 1"),
        ([0.5], ValueError, "id 2, but only 1 scores"),
    ],
)
def test_masks_that_do_not_fit_are_refused(frames, returned, error, words):
    def masks(frame, prompts):
        if isinstance(returned, str):
            size = frame.color.shape[:2]
            return np.zeros(size) if returned == "full" else np.full(size, -1)
        if isinstance(returned, list):
            return np.full(frame.color.shape[:2], 2), returned
        return returned

    mapper = ovimap.Mapper(masks, settings={"mask_interval": 1})
    with pytest.raises(error, match=words):
        mapper.process(frames[0])
    assert mapper.frames == 0


def test_frames_without_masks_are_no_evidence_and_empty_masks_are(room, tmp_path):
    source = ovimap.open_source(room)

    def mapped(name, on_other_frames):
        def masks(frame, prompts):
            return source.truth_ids(frame.index) if frame.index % 16 == 0 else on_other_frames(frame)

        settings = {"mask_interval": 1, "map.voxel_size_m": 0.03}
        return ovimap.run(room, tmp_path / name, masks=masks, encoder=None, frames=":40", settings=settings)

    sparse = mapped("sparse.ovimap", lambda frame: None)
    assert sparse.frames == 40 and sparse.mask_frames == 3
    empty = mapped("empty.ovimap", lambda frame: np.zeros(frame.color.shape[:2], np.uint8))
    assert empty.frames == 40 and empty.mask_frames == 40
    assert 0 < len(empty) < len(sparse)


def test_a_run_whose_frames_have_no_masks_says_so(room, tmp_path):
    with pytest.warns(UserWarning, match="none of the .* frames had masks"):
        ovimap.run(room, tmp_path / "a.ovimap", masks=lambda frame, prompts: None, encoder=None, frames="::30")


def test_what_masks_raise_comes_out_with_its_traceback(frames):
    class Mine(Exception):
        pass

    def broken(frame, prompts):
        raise Mine("the network is on fire")

    mapper = ovimap.Mapper(broken, settings={"mask_interval": 1})
    with pytest.raises(Mine, match="on fire") as raised:
        mapper.process(frames[0])
    assert raised.traceback[-1].name == "broken"


def test_a_frame_whose_masks_raise_frame_error_is_left_out(room, tmp_path):
    source = ovimap.open_source(room)

    def masks(frame, prompts):
        if frame.index == 10:
            raise ovimap.FrameError("blurred")
        return source.truth_ids(frame.index)

    made = ovimap.run(room, tmp_path / "a.ovimap", masks=masks, encoder=None, frames="0:31:10", settings={"mask_interval": 1})
    assert made.frames == 3 and made.skipped == {"blurred": 1}
    assert repr(made).endswith("from 3 frames, no embeddings; 1 frame skipped: 1 blurred)")


def test_a_run_counts_what_it_left_out_by_reason(room, tmp_path):
    shutil.copytree(room, tmp_path / "room")
    shutil.copy(f"{room}/../cam_params.json", tmp_path)
    for number in (3, 5):
        (tmp_path / f"room/results/depth{number:06d}.png").write_bytes(b"none")
    made = ovimap.run(tmp_path / "room", tmp_path / "a.ovimap", frames=":8")
    assert made.frames == 6 and list(made.skipped.values()) == [2], made.skipped
    assert "6 frames, no embeddings; 2 frames skipped: 2 " in repr(made)
    assert ovimap.Map.open(tmp_path / "a.ovimap").skipped == {}


def test_a_call_from_its_own_callback_is_refused(frames):
    mapper = ovimap.Mapper(lambda frame, prompts: mapper.process(frame), settings={"mask_interval": 1})
    with pytest.raises(ovimap.Error, match="at work, in another thread or below this very callback"):
        mapper.process(frames[0])


def test_a_second_thread_is_refused_and_the_first_goes_on(frames):
    inside, go_on = threading.Event(), threading.Event()

    def masks(frame, prompts):
        inside.set()
        assert go_on.wait(60)
        return np.zeros(frame.color.shape[:2], np.uint8)

    mapper = ovimap.Mapper(masks, settings={"mask_interval": 1})
    first = threading.Thread(target=mapper.process, args=(frames[0],))
    first.start()
    assert inside.wait(60)
    with pytest.raises(ovimap.Error, match="at work"):
        mapper.process(frames[1])
    go_on.set()
    first.join()
    mapper.process(frames[1])
    assert mapper.frames == 2


def test_other_threads_run_while_a_frame_is_fused(frames):
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1

    counter = threading.Thread(target=count)
    mapper = ovimap.Mapper()
    mapper.process(frames[0])
    counter.start()
    before = counted[0]
    mapper.process(frames[1])
    during = counted[0] - before
    stop.set()
    counter.join()
    assert during > 1000


class ColorEncoder:
    """Embeds the mean colour; words are colours."""

    name, dimension = "colours", 3

    def __init__(self):
        self.threads = set()

    def encode_images(self, images):
        self.threads.add(threading.get_ident())
        assert all(image.dtype == np.uint8 and image.ndim == 3 for image in images)
        return np.array([image.reshape(-1, 3).mean(0) for image in images])

    def encode_texts(self, texts):
        words = {"red": [1, 0, 0], "green": [0, 1, 0], "blue": [0, 0, 1]}
        unknown = np.random.default_rng(len(texts)).uniform(0, 1, (len(texts), 3))
        return np.array([words.get(text, other) for text, other in zip(texts, unknown)], np.float32)


def test_an_encoder_of_ones_own_embeds_and_answers(room, tmp_path):
    encoder = ColorEncoder()
    made = ovimap.run(room, tmp_path / "a.ovimap", masks="gt", encoder=encoder, frames="::4")
    assert made.encoder == "colours" and encoder.threads and threading.get_ident() not in encoder.threads
    assert made.embeddings.shape == (len(made), 3) and np.linalg.norm(made.embeddings, axis=1).max() == pytest.approx(1)
    asked = ovimap.Map.open(tmp_path / "a.ovimap", encoder=encoder)
    best = asked.query("blue").matches[0]
    bluest = np.argmax(asked.embeddings[:, 2])
    assert best.score == pytest.approx(asked.embeddings[best.row, 2], abs=1e-3) and len(asked.query("red").matches) > 0
    assert bluest >= 0
    with pytest.raises(ovimap.Error, match="colours"):  # the file alone does not know the encoder
        made.query("blue")


@pytest.mark.parametrize(
    "rows, error, words",
    [
        (lambda images: None, TypeError, "what encode_images returned must be float32 .* came None"),
        (lambda images: np.zeros((len(images), 2)), ValueError, r"must be float32 or float64 \[\d+, 3\]; came float64 \[\d+, 2\]"),
        (lambda images: 1 / 0, ZeroDivisionError, "division"),
    ],
)
def test_an_encoder_that_fails_is_told_from_its_thread(room, tmp_path, rows, error, words):
    encoder = ColorEncoder()
    encoder.encode_images = rows
    with pytest.raises(error, match=words):
        ovimap.run(room, tmp_path / "a.ovimap", masks="gt", encoder=encoder, frames="::4")


def test_what_is_no_encoder_and_what_are_no_masks_is_refused():
    with pytest.raises(TypeError, match="encoder must be None, the name"):
        ovimap.Mapper(encoder=3)
    with pytest.raises(TypeError, match="masks must be None, the name"):
        ovimap.Mapper(masks=3)
    with pytest.raises(ovimap.Error, match="no-such-model"):
        ovimap.Mapper(masks="no-such-model")
    with pytest.raises(ovimap.Error, match="voxel_size"):
        ovimap.Mapper(settings={"map.voxel_sise_m": 0.02})


def test_a_map_that_cannot_be_written_is_kept(frames, tmp_path):
    mapper = ovimap.Mapper()
    for frame in frames:
        mapper.process(frame)
    with pytest.raises(ovimap.Error, match="missing"):
        mapper.save(tmp_path / "missing" / "a.ovimap")
    assert mapper.save(tmp_path / "a.ovimap") >= 0 and mapper.save(tmp_path / "b.ovimap") >= 0
    assert (tmp_path / "a.ovimap").read_bytes() == (tmp_path / "b.ovimap").read_bytes()
    with pytest.raises(ovimap.Error, match="was saved, which ends it"):
        mapper.process(frames[0])


def test_nothing_mapped_is_nothing_to_save(tmp_path):
    with pytest.raises(ovimap.Error, match="no frame was mapped"):
        ovimap.Mapper().save(tmp_path / "a.ovimap")


def test_projecting_shows_the_surface_where_the_camera_saw_it(camera):
    mapper = ovimap.Mapper(settings={"map.voxel_size_m": 0.02})
    frames = [wall(camera, i) for i in range(4)]
    for frame in frames:
        mapper.process(frame)
    seen = mapper.project(frames[1])
    assert seen.depth.shape == seen.instances.shape == (48, 64)
    assert np.median(seen.depth) == pytest.approx(2, abs=0.02)
    assert [frame.index for frame in frames] == [0, 1, 2, 3]  # numbered as they came
    assert mapper.timings()["integrate"].count == 4


LIVE = """
import numpy as np, ovimap, threading
camera = ovimap.PinholeCamera(64, 48, 60, 60, 31.5, 23.5)
started = threading.Event()
def masks(frame, prompts):
    started.set()
    return np.zeros((48, 64), np.uint8)
mapper = ovimap.LiveMapper(masks, live={"masks.min_gap": 1})
for i in range(20):
    pose = np.eye(4); pose[0, 3] = i * 0.3
    mapper.push_and_wait(ovimap.Frame(np.zeros((48, 64, 3), np.uint8), np.full((48, 64), 2, np.float32), pose, camera))
assert started.wait(60)
print("ending")
"""


def test_the_interpreter_ends_while_threads_are_at_work():
    done = subprocess.run([sys.executable, "-c", LIVE], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "ending\n", "")


CYCLE = """
import ovimap
def leave():
    mapper = ovimap.Mapper(lambda frame, prompts: mapper)
    live = ovimap.LiveMapper(lambda frame, prompts: live)
leave()
print("ending")
"""


def test_mappers_that_their_own_callables_hold_end_with_the_interpreter():
    environment = os.environ | {"PYTHONMALLOC": "debug"}  # what is freed is overwritten
    done = subprocess.run([sys.executable, "-c", CYCLE], capture_output=True, text=True, timeout=120, env=environment)
    assert (done.returncode, done.stdout, done.stderr) == (0, "ending\n", "")
