# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What users' own code does wrong, from whatever thread: it is told, nothing mapped is lost, nothing crashes."""
import os
import subprocess
import sys
import threading

import numpy as np
import ovimap
import pytest
from conftest import wall


class FailingEncoder:
    """Fails on every batch while `fails` holds."""

    name, dimension = "failing", 3

    def __init__(self, returned=None):
        self.returned, self.fails = returned, True

    def encode_images(self, images):
        if not self.fails:
            return np.ones((len(images), 3), np.float32)
        if self.returned is None:
            raise RuntimeError("out of memory")
        return self.returned


@pytest.fixture(scope="module")
def frames(room):
    return list(ovimap.open_source(room).frames("::4"))


def process_all(mapper, frames, error):
    """Every frame is in the map in the end, however often the encoder fails; returns how often."""
    failures = 0
    for frame in frames:
        while True:
            try:
                mapper.process(frame)
                break
            except error:
                failures += 1
                assert failures < 1000
    return failures


@pytest.mark.parametrize("returned, error", [(None, RuntimeError), (np.zeros((1, 7)), ValueError)])
def test_an_encoder_that_always_fails_costs_embeddings_alone(frames, tmp_path, returned, error):
    mapper = ovimap.Mapper(encoder=FailingEncoder(returned))
    failures = process_all(mapper, frames, error)
    assert mapper.frames == len(frames)
    path = tmp_path / "a.ovimap"
    try:
        mapper.save(path)
    except error:
        failures += 1
        mapper.save(path)
    made = ovimap.Map.open(path)
    assert failures > 1 and made.frames == len(frames) and len(made) > 0
    assert not made.embeddings.any()


def test_an_encoder_that_recovers_embeds_what_comes_then(frames, tmp_path):
    encoder = FailingEncoder()
    mapper = ovimap.Mapper(encoder=encoder)
    assert process_all(mapper, frames[:5], RuntimeError) > 0
    encoder.fails = False
    process_all(mapper, frames[5:], RuntimeError)
    mapper.save(tmp_path / "a.ovimap")
    assert ovimap.Map.open(tmp_path / "a.ovimap").embeddings.any()


def test_what_masks_raise_comes_out_of_every_call_until_it_is_cancelled(camera, tmp_path):
    def broken(frame, prompts):
        raise KeyError("no such model")

    mapper = ovimap.LiveMapper(broken)
    with pytest.raises(KeyError):
        for index in range(100):
            mapper.push_and_wait(wall(camera, index))
        mapper.drain()
    for call in (lambda: mapper.push(wall(camera, 0)), mapper.drain, lambda: mapper.save(tmp_path / "a.ovimap")):
        with pytest.raises(KeyError, match="no such model") as raised:
            call()
        assert raised.traceback[-1].name == "broken"
    mapper.cancel()
    mapper.save(tmp_path / "a.ovimap")
    assert ovimap.Map.open(tmp_path / "a.ovimap").frames == mapper.statistics().frames_fused > 0


@pytest.mark.parametrize("returned, fault", [(None, "RuntimeError: out of memory"), (np.zeros((1, 7)), "what encode_images returned must be")])
def test_a_live_map_outlives_its_encoder(frames, tmp_path, returned, fault):
    mapper = ovimap.LiveMapper(encoder=FailingEncoder(returned), live={"view_interval": 1})
    for frame in frames:
        mapper.push_and_wait(frame)
    with pytest.warns(RuntimeWarning, match="the encoder failed on [0-9]+ view"):
        mapper.drain()
    done = mapper.statistics()
    assert done.views_failed > 0 and fault in done.encoder_fault and done.frames_fused == len(frames)
    with pytest.raises(ovimap.Error, match="missing"):
        mapper.save(tmp_path / "missing/a.ovimap")
    for name in ("a.ovimap", "b.ovimap"):
        mapper.save(tmp_path / name)
        made = ovimap.Map.open(tmp_path / name)
        assert made.frames == len(frames) and len(made) > 0 and not made.embeddings.any()


def test_a_live_map_that_is_cancelled_counts_what_its_encoder_raised(frames, tmp_path):
    mapper = ovimap.LiveMapper(encoder=FailingEncoder(), live={"view_interval": 1})
    for frame in frames:
        mapper.push_and_wait(frame)
    while mapper.statistics().frames_fused < len(frames):
        pass
    mapper.cancel()
    with pytest.warns(RuntimeWarning, match="out of memory"):
        mapper.save(tmp_path / "a.ovimap")
    assert mapper.statistics().views_failed > 0


def test_messages_name_arguments_not_the_programs_options(room, tmp_path):
    still = [ovimap.Frame(frame.color, frame.depth, np.eye(4), frame.camera) for frame in list(ovimap.open_source(room).frames(":3"))]
    mapper = ovimap.Mapper()
    for frame in still:
        mapper.process(frame)
    with pytest.raises(ovimap.Error, match="settings={'allow_still_camera': True}") as told:
        mapper.save(tmp_path / "a.ovimap")
    assert "--" not in str(told.value)
    with pytest.raises(ovimap.Error, match="and model_dirs or OVIMAP_MODELS name other folders") as told:
        ovimap.make_encoder("nothing-such")
    assert "--" not in str(told.value)


def test_true_masks_of_a_frame_that_the_recording_has_not(room, camera):
    source = ovimap.open_source(room)
    masks, frame = ovimap.make_mask_source("gt", source), wall(camera, 0)
    for index in (None, len(source), 1_000_000):
        with pytest.raises(ovimap.FrameError, match="masks 'gt' know frames 0 to"):
            masks(ovimap.Frame(frame.color, frame.depth, np.eye(4), camera, index=index))


def test_threads_may_share_an_iterator(room):
    source = ovimap.open_source(room)
    shared, found = source.frames(":20"), []
    threads = [threading.Thread(target=lambda: found.extend(frame.index for frame in shared)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(found) == list(range(20))


DAEMON = """
import threading, numpy as np, ovimap
camera = ovimap.PinholeCamera(320, 240, 300, 300, 159.5, 119.5)
begun = threading.Event()
def process():
    mapper = ovimap.Mapper()
    for i in range(100000):
        pose = np.eye(4); pose[0, 3] = i * 0.05
        mapper.process(ovimap.Frame(np.zeros((240, 320, 3), np.uint8), np.full((240, 320), 2, np.float32), pose, camera))
        begun.set()
def push():
    mapper = ovimap.LiveMapper()
    for i in range(100000):
        pose = np.eye(4); pose[0, 3] = i * 0.05
        mapper.push_and_wait(ovimap.Frame(np.zeros((240, 320, 3), np.uint8), np.full((240, 320), 2, np.float32), pose, camera))
threads = [threading.Thread(target=work, daemon=True) for work in (process, push)]
for thread in threads:
    thread.start()
assert begun.wait(60)
print("ending", flush=True)
"""


def test_the_interpreter_ends_under_threads_that_map():
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", DAEMON], capture_output=True, text=True, timeout=120)
        assert (done.returncode, done.stdout) == (0, "ending\n"), done.stderr


def test_a_run_learns_of_a_bad_target_before_it_maps(room, tmp_path):
    with pytest.raises(ovimap.Error, match="missing"):
        ovimap.run(room, tmp_path / "missing/a.ovimap", progress=lambda done, total: pytest.fail("it mapped"))


def test_a_run_that_is_broken_off_saves_what_it_has(room, tmp_path):
    def interrupt(done, total):
        if done == 4:
            raise KeyboardInterrupt

    path = tmp_path / "a.ovimap"
    with pytest.raises(KeyboardInterrupt):
        ovimap.run(room, path, progress=interrupt)
    assert ovimap.Map.open(path).frames == 4
    before = path.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        ovimap.run(room, path, frames="10:30", progress=interrupt)
    assert path.read_bytes() == before, "a map that was there is not replaced by a part of another"


def test_a_run_whose_encoder_fails_saves_what_it_has(room, tmp_path):
    with pytest.raises(RuntimeError, match="out of memory"):
        ovimap.run(room, tmp_path / "a.ovimap", encoder=FailingEncoder(), frames="::4")
    assert ovimap.Map.open(tmp_path / "a.ovimap").frames > 0


MAPPERS = [(ovimap.Mapper, "process"), (ovimap.LiveMapper, "push_and_wait")]


@pytest.mark.parametrize("made, add", MAPPERS)
def test_frames_of_another_camera_are_refused(camera, made, add):
    other = ovimap.PinholeCamera(width=160, height=120, fx=150, fy=150, cx=79.5, cy=59.5)
    zoomed = ovimap.PinholeCamera(width=64, height=48, fx=62, fy=62, cx=31.5, cy=23.5)
    give = getattr(made(), add)
    give(wall(camera, 0))
    give(wall(zoomed, 1))  # as phones have it
    with pytest.raises(ovimap.Error, match="another depth camera"):
        give(wall(other, 2))


@pytest.mark.parametrize("made, add", MAPPERS)
def test_a_camera_that_never_moves_is_told(camera, tmp_path, made, add):
    mapper = made()
    for _ in range(3):
        getattr(mapper, add)(wall(camera, 0))
    with pytest.raises(ovimap.Error, match="same pose"):
        mapper.save(tmp_path / "a.ovimap")


def test_frames_without_depth_are_told(camera):
    frame = wall(camera, 0)
    for depth, options in ((frame.depth * 1000, {}), (np.full((48, 64), 2, np.uint16), {"depth_scale": 1000})):
        empty = ovimap.Frame(frame.color, depth, np.eye(4), camera, **options)
        for add in (ovimap.Mapper().process, ovimap.LiveMapper().push):
            with pytest.raises(ovimap.FrameError, match="no depth that counts: floats are metres"):
                add(empty)


def test_a_file_that_is_no_map_is_not_replaced(room, tmp_path):
    notes = tmp_path / "notes.txt"
    notes.write_text("precious")
    with pytest.raises(ovimap.Error, match="it holds no map; give a file name"):
        ovimap.run(room, notes)
    assert notes.read_text() == "precious"


def test_ids_may_be_numpys(saved_map):
    opened = ovimap.Map.open(saved_map)
    first = opened.instances.ids[0]
    assert opened.query_like(first).matches[0].id == opened.query_like(int(first)).matches[0].id
    for wrong in (-1, 10**12):
        with pytest.raises(ovimap.Error, match=f"no object {wrong};"):
            opened.query_like(wrong)


def test_paths_are_what_the_system_takes_for_paths(room, saved_map, tmp_path):
    entry = next(entry for entry in os.scandir(os.path.dirname(room)) if entry.path == os.fspath(room))
    assert len(ovimap.open_source(entry)) == len(ovimap.open_source(room))
    odd = os.fsencode(tmp_path) + b"/map-\xff.ovimap"
    with open(saved_map, "rb") as file:
        content = file.read()
    with open(odd, "wb") as file:
        file.write(content)
    assert len(ovimap.Map.open(os.fsdecode(odd))) == len(ovimap.Map.open(saved_map))


def test_settings_take_what_numpy_calls_a_truth():
    name = next(setting.name for setting in ovimap.settings("live") if setting.accepts.startswith("false or true"))
    ovimap.LiveMapper(live={name: np.bool_(True)})
