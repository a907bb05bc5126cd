# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""LiveMapper: frames through threads, callables called from them."""
import threading

import numpy as np
import ovimap
import pytest
from conftest import wall


def test_everything_pushed_is_in_the_map(room, tmp_path):
    mapper = ovimap.LiveMapper()
    frames = list(ovimap.open_source(room).frames("::15"))
    for frame in frames:
        mapper.push_and_wait(frame)
    mapper.drain()
    done = mapper.statistics()
    assert (done.frames_pushed, done.frames_fused, done.frames_dropped) == (len(frames), len(frames), 0)
    assert done.geometry_lag.count == len(frames)
    mapper.save(tmp_path / "a.ovimap", source="camera:front")
    made = ovimap.Map.open(tmp_path / "a.ovimap")
    assert made.frames == len(frames) and made.source == "camera:front"
    assert mapper.statistics().frames_fused == len(frames)
    with pytest.raises(ovimap.Error, match="was saved, which ends it"):
        mapper.push(frames[0])


def test_what_masks_raise_in_their_thread_comes_out_of_the_next_call(camera, tmp_path):
    threads = []

    def broken(frame, prompts):
        threads.append(threading.get_ident())
        raise KeyError("no such model")

    mapper = ovimap.LiveMapper(broken, live={"wait_for_masks": True})
    with pytest.raises(KeyError, match="no such model"):
        for index in range(50):
            mapper.push_and_wait(wall(camera, index))
        mapper.drain()
    assert threads and threading.get_ident() not in threads
    mapper.cancel()


def test_masks_that_raise_frame_error_are_counted(camera):
    def blurred(frame, prompts):
        raise ovimap.FrameError("blurred")

    mapper = ovimap.LiveMapper(blurred, live={"wait_for_masks": True})
    mapper.push_and_wait(wall(camera, 0))
    mapper.drain()
    done = mapper.statistics()
    assert done.masks_failed == 1 and done.mask_fault == "blurred" and done.frames_fused == 1


def test_frames_that_masks_do_not_know_are_counted(camera):
    mapper = ovimap.LiveMapper(lambda frame, prompts: None, live={"wait_for_masks": True})
    for index in range(3):
        mapper.push_and_wait(wall(camera, index))
    mapper.drain()
    done = mapper.statistics()
    assert (done.masks_absent, done.masks_failed, done.mask_frames, done.frames_fused) == (3, 0, 0, 3)


def test_a_mapper_may_be_dropped_while_its_masks_are_at_work(camera):
    inside, go_on = threading.Event(), threading.Event()

    def slow(frame, prompts):
        inside.set()
        go_on.wait(60)
        return np.zeros(frame.color.shape[:2], np.uint8)

    mapper = ovimap.LiveMapper(slow)
    mapper.push_and_wait(wall(camera, 0))
    assert inside.wait(60)
    threading.Timer(0.05, go_on.set).start()
    del mapper  # waits for the callable, which needs the GIL to end


def test_statistics_can_be_asked_for_by_any_thread(camera):
    mapper = ovimap.LiveMapper()
    seen = []
    watcher = threading.Thread(target=lambda: seen.extend(mapper.statistics().frames_pushed for _ in range(200)))
    watcher.start()
    for index in range(5):
        mapper.push_and_wait(wall(camera, index))
    watcher.join()
    mapper.drain()
    assert sorted(seen) == seen and mapper.statistics().frames_pushed == 5


def test_cancelling_keeps_what_was_fused(camera, tmp_path):
    mapper = ovimap.LiveMapper()
    for index in range(5):
        mapper.push_and_wait(wall(camera, index))
    while mapper.statistics().frames_fused < 3:
        pass
    mapper.cancel()
    mapper.save(tmp_path / "a.ovimap")
    assert 3 <= ovimap.Map.open(tmp_path / "a.ovimap").frames <= 5
