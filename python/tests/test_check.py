# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Good recordings pass; each way of spoiling one is named."""
import os
import pathlib
import shutil

import numpy as np
import ovimap
import pytest
from PIL import Image

OPENGL = np.diag([1.0, -1, -1, 1])
ROS = np.array([[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])


class Recording:
    """A plain folder that tests may spoil."""

    def __init__(self, folder):
        self.folder = folder
        self.colors = sorted((folder / "color").iterdir())
        self.depths = sorted((folder / "depth").iterdir())

    @property
    def poses(self):
        return np.loadtxt(self.folder / "poses.txt").reshape(-1, 4, 4)

    @poses.setter
    def poses(self, poses):
        np.savetxt(self.folder / "poses.txt", np.reshape(poses, (-1, 16)), fmt="%.9g")

    def camera(self, **changes):
        figures = self.figures | changes
        text = ", ".join(f"{name}: {value}" for name, value in figures.items())
        (self.folder / "camera.yaml").write_text(f"camera: {{{text}}}\n")



@pytest.fixture(scope="module")
def good(room, tmp_path_factory):
    """The room as a plain folder."""
    folder = tmp_path_factory.mktemp("good")
    frames = list(ovimap.open_source(room).frames("0:60"))
    for kind in ("color", "depth"):
        (folder / kind).mkdir()
    for i, frame in enumerate(frames):
        Image.fromarray(np.array(frame.color)).save(folder / f"color/{i:06d}.png", compress_level=1)
        Image.fromarray(np.rint(frame.depth * 1000).astype(np.uint16)).save(folder / f"depth/{i:06d}.png", compress_level=1)
    recording = Recording(folder)
    recording.poses = [frame.world_from_camera for frame in frames]
    c = frames[0].camera
    Recording.figures = dict(width=c.width, height=c.height, fx=c.fx, fy=c.fy, cx=c.cx, cy=c.cy, depth_scale=1000)
    recording.camera()
    return folder


@pytest.fixture
def recording(good, tmp_path):
    shutil.copytree(good, tmp_path / "copy", copy_function=os.link)
    for name in ("poses.txt", "camera.yaml"):  # these are written anew, the images are not
        (tmp_path / "copy" / name).unlink()
        shutil.copy(good / name, tmp_path / "copy")
    return Recording(tmp_path / "copy")


def faults(path):
    return [finding for finding in ovimap.check(path).findings if finding.severity == "fault"]


def scale_positions(poses):
    poses = poses.copy()
    poses[:, :3, 3] *= 1000
    return poses


def shifted(array, pixels):
    return np.concatenate([array[:, -pixels:], array[:, :-pixels]], axis=1)


def shift_colors(r, pixels):
    for file in r.colors:
        image = shifted(np.asarray(Image.open(file)), pixels)
        file.unlink()
        Image.fromarray(image).save(file, compress_level=1)


def replace(files, content):
    for file in files:
        file.unlink()
        file.write_bytes(content)


def resize(files):
    for file in files:
        image = Image.open(file).resize((160, 120))
        file.unlink()
        image.save(file)


def spoil_poses(change):
    def spoil(r):
        r.poses = change(r.poses)

    return spoil




CORRUPTIONS = {
    "depth of 5 units a millimetre": (lambda r: r.camera(depth_scale=5000), "depth_scale", "divide depth_scale by 5"),
    "depth in centimetres": (lambda r: r.camera(depth_scale=100), "depth_scale", "multiply depth_scale by 10"),
    "depth scale left out": (lambda r: r.camera(depth_scale=1), "depth_scale", "multiply depth_scale by 1000"),
    "poses from world to camera": (spoil_poses(np.linalg.inv), "pose_convention", "direction: camera_from_world"),
    "poses in OpenGL axes": (spoil_poses(lambda p: p @ OPENGL), "pose_convention", "axes: opengl"),
    "poses in ROS axes": (spoil_poses(lambda p: p @ ROS), "pose_convention", "axes: ros"),
    "poses from world to camera, in OpenGL axes": (spoil_poses(lambda p: np.linalg.inv(p @ OPENGL)), "pose_convention", "camera_from_world, axes: opengl"),
    "poses in millimetres": (spoil_poses(scale_positions), "pose_unit", "in metres"),
    "the same pose for all": (spoil_poses(lambda p: np.repeat(p[:1], len(p), 0)), "still_poses", "pose for each frame"),
    "poses 4 frames late": (spoil_poses(lambda p: np.roll(p, 4, 0)), "time_offset", "4 frame(s) after"),
    "poses 3 frames early": (spoil_poses(lambda p: np.roll(p, -3, 0)), "time_offset", "3 frame(s) before"),
    "poses in reverse order": (spoil_poses(lambda p: p[::-1]), "agreement", "order of the poses"),
    "focal length too long": (lambda r: r.camera(fx=1.3 * r.figures["fx"], fy=1.3 * r.figures["fy"]), "intrinsics", "divide fx and fy"),
    "focal length too short": (lambda r: r.camera(fx=0.7 * r.figures["fx"], fy=0.7 * r.figures["fy"]), "intrinsics", "multiply fx and fy"),
    "colour that lies beside depth": (lambda r: shift_colors(r, 20), "registration", "calibration.yaml"),
    "depth images missing": (lambda r: [file.unlink() for file in r.depths[5:]], "frames", "bad_frames"),
    "depth images of another size": (lambda r: resize(r.depths[5:]), "frames", "bad_frames"),
    "colour images that are none": (lambda r: replace(r.colors[5:], b"\x89PNG"), "frames", "bad_frames"),
    "poses that are not finite": (spoil_poses(lambda p: np.where(np.arange(len(p))[:, None, None] > 5, np.nan, p)), "frames", "bad_frames"),
    "poses that mirror": (spoil_poses(lambda p: p @ np.diag([1.0, 1, -1, 1])), "frames", "bad_frames"),
}


def test_the_good_recording_and_the_room_pass(good, room):
    for path in (good, room):
        report = ovimap.check(path)
        assert report.ok and all(finding.severity == "ok" for finding in report.findings), report.findings
        assert repr(report) == f"CheckReport({report.kind}, {report.usable} of {report.checked} frames usable, ok)"


@pytest.mark.parametrize("name", CORRUPTIONS)
def test_each_corruption_is_named_with_its_remedy(recording, name):
    spoil, expected, remedy = CORRUPTIONS[name]
    spoil(recording)
    found = faults(recording.folder)
    assert found and found[0].name == expected, found
    assert remedy in found[0].remedy
    assert {finding.name for finding in found} - {"bad_frames"} == {expected}, found


def test_the_table_of_docs_lists_each_corruption():
    page = (pathlib.Path(__file__).parents[2] / "docs" / "sources.md").read_text()
    table = page.split("| what is wrong | named as | the remedy says |\n")[1].split("\n\n")[0].splitlines()[1:]
    rows = [row.strip("| ").split(" | ") for row in table]
    assert [(name, finding.strip("`")) for name, finding, _ in rows] == [(name, CORRUPTIONS[name][1]) for name in CORRUPTIONS]


def test_few_frames_do_not_make_shifted_colour_a_fault(recording):
    shift_colors(recording, 20)
    report = ovimap.check(recording.folder, frames=":8")
    (found,) = [finding for finding in report.findings if finding.name == "registration"]
    assert report.ok and found.severity == "warning" and "8 frames do not tell" in found.remedy


def copy_of_the_kitchen(kitchen, folder):
    for file in kitchen.iterdir():
        (folder / file.name).symlink_to(file)
    return folder


def test_the_kitchen_passes_with_its_calibration_alone(kitchen, tmp_path):
    assert ovimap.check(kitchen).ok
    copy_of_the_kitchen(kitchen, tmp_path)
    (tmp_path / "calibration.yaml").unlink()
    assert [finding.name for finding in faults(tmp_path)] == ["registration"]


@pytest.mark.parametrize("offset", [-2, 1, 5])
def test_poses_of_other_frames_are_found_in_the_kitchen(kitchen, tmp_path, offset):
    copy_of_the_kitchen(kitchen, tmp_path)
    poses = sorted(kitchen.glob("*.pose.txt"))
    for i, file in enumerate(poses):
        (tmp_path / file.name).unlink()
        (tmp_path / file.name).symlink_to(poses[(i - offset) % len(poses)])
    (found,) = faults(tmp_path)
    assert found.name == "time_offset" and f"{abs(offset)} frame(s) {'after' if offset > 0 else 'before'}" in found.remedy


@pytest.mark.parametrize("factor", [0.85, 1.2])
def test_a_wrong_focal_length_is_found_in_the_kitchen(kitchen, tmp_path, factor):
    copy_of_the_kitchen(kitchen, tmp_path)
    text = (kitchen / "calibration.yaml").read_text()
    (tmp_path / "calibration.yaml").unlink()
    (tmp_path / "calibration.yaml").write_text(text.replace("585.0", str(585 * factor)))
    assert "intrinsics" in [finding.name for finding in faults(tmp_path)]


def test_calibrate_says_what_is_right_and_what_does_not_tell(kitchen, good):
    result = ovimap.calibrate(kitchen, frames="::5", settings={"fit.starts": 2})
    assert result.verdict == "aligned" and result.frames == 40
    assert result.found_px < 1.05 * result.given_px and result.spread_px < 3 and result.sharpness > 0.1
    assert abs(result.color_camera.fx - 531) < 8 and np.allclose(result.color_from_depth[:3, :3], np.eye(3), atol=0.03)
    assert "color_from_depth:" in result.yaml
    refused = ovimap.calibrate(good, frames="0:4")
    assert refused.verdict == "refused" and "frames" in refused.message
