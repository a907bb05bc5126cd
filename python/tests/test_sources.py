# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings: opened, iterated, checked; bad frames are left out and told."""
import shutil

import numpy as np
import ovimap
import pytest


@pytest.fixture(scope="module")
def damaged(room, tmp_path_factory):
    """A copy of the room with its second frame broken."""
    root = tmp_path_factory.mktemp("damaged")
    shutil.copytree(room, root / "room")
    shutil.copy(f"{room}/../cam_params.json", root)
    depths = sorted((root / "room/results").glob("depth*.png"))
    depths[1].write_bytes(b"no picture")
    return root / "room"


def test_iterating_gives_the_frames_in_order(room):
    source = ovimap.open_source(room)
    assert source.kind == "replica" and source.path == str(room) and len(source) > 20
    frames = list(source.frames("::10"))
    assert [frame.index for frame in frames] == list(range(0, len(source), 10))
    np.testing.assert_array_equal(frames[1].depth, source[10].depth)
    np.testing.assert_array_equal(frames[1].color, source[10].color)
    assert len(source.frames("3:7")) == 4 and source[-1].index == len(source) - 1


def test_iteration_is_over_for_good(room):
    frames = ovimap.open_source(room).frames("0:2")
    assert len(list(frames)) == 2 and list(frames) == []


def test_positions_outside_are_an_index_error(room):
    source = ovimap.open_source(room)
    with pytest.raises(IndexError, match=f"frame {len(source)} of {len(source)}"):
        source[len(source)]
    with pytest.raises(ovimap.Error, match="A:B:STEP|FIRST|frames"):
        source.frames("a to b")


def test_bad_frames_are_left_out_and_told(damaged):
    source = ovimap.open_source(damaged)
    frames = source.frames("0:3")
    assert [frame.index for frame in frames] == [0, 2]
    assert frames.skipped[0][0] == 1 and "depth" in frames.skipped[0][1]
    with pytest.raises(ovimap.FrameError, match="depth"):
        source[1]


def test_a_range_without_a_usable_frame_is_an_error(damaged):
    with pytest.raises(ovimap.Error, match="none of the 1 frames is usable: .*depth"):
        list(ovimap.open_source(damaged).frames("1:2"))


def test_a_path_that_is_not_there_is_an_error(tmp_path):
    with pytest.raises(ovimap.Error, match="nowhere"):
        ovimap.open_source(tmp_path / "nowhere")
    with pytest.raises(TypeError, match="path must be a path"):
        ovimap.open_source(3)


def test_settings_reach_the_reader(room):
    near = ovimap.open_source(room, settings={"max_depth_m": 1.0})
    usable = [frame for frame in near.frames("::20")] if len(near) else []
    assert all(frame.depth.max() <= 1 for frame in usable)
    with pytest.raises(ovimap.Error, match="max_depth_m"):
        ovimap.open_source(room, settings={"max_depth": 1})
    with pytest.raises(ovimap.Error, match="max_depth_m"):
        ovimap.open_source(room, settings={"max_depth_m": "far"})


def test_settings_are_listed_with_meaning():
    by_name = {setting.name: setting for setting in ovimap.settings()}
    assert float(by_name["map.voxel_size_m"].value) > 0 and by_name["map.voxel_size_m"].help
    assert len(ovimap.settings("query")) > 10
    with pytest.raises(ovimap.Error, match="accepted are mapper, live"):
        ovimap.settings("weather")


def test_true_ids_are_images_of_the_color_cameras_size(room):
    source = ovimap.open_source(room)
    ids = source.truth_ids(0)
    assert ids.dtype == np.uint16 and ids.shape == source[0].color.shape[:2] and len(np.unique(ids)) > 2


def test_a_source_says_what_it_is(room):
    source = ovimap.open_source(room)
    assert repr(source) == f"FrameSource(replica '{source.path}': {len(source)} frames)"


def test_a_check_may_look_at_some_frames(room):
    assert ovimap.check(room, frames="0:20:2").frames == 10
    with pytest.raises(ovimap.Error, match="the chosen range holds none"):
        ovimap.check(room, frames="100000:")


def test_check_passes_the_room_and_names_a_fault(room, tmp_path):
    report = ovimap.check(room)
    assert report.ok and report.usable == report.checked and report.depth_agreement > 0.8
    shutil.copytree(room, tmp_path / "room")
    shutil.copy(f"{room}/../cam_params.json", tmp_path)
    (tmp_path / "room/calibration.yaml").write_text("depth_camera: {depth_scale: 655.35}\n")
    report = ovimap.check(tmp_path / "room")
    faults = [finding.name for finding in report.findings if finding.severity == "fault"]
    assert not report.ok and faults == ["depth_scale"]
    assert "multiply depth_scale by 10" in [f.remedy for f in report.findings if f.severity == "fault"][0]
