# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Bags give the map that the folder gives, and say what they lack."""
import dataclasses
import json
import subprocess
import sys
import types

import numpy as np
import ovimap
import pytest
import yaml
from bag_fixture import START_NS, STEP_NS, Options, Shot, record
from ovimap.bag_messages import lens_of
from ovimap.bags import Stream, Topics, convert, main
from ovimap.transforms import between, matrix_of, quaternion_of
from PIL import Image


@pytest.fixture(scope="module")
def shots(room):
    frames = list(ovimap.open_source(room).frames("0:60:6"))
    depth = [np.rint(frame.depth * 1000).astype(np.uint16) for frame in frames]
    return [Shot(np.array(f.color), d, np.array(f.world_from_camera)) for f, d in zip(frames, depth)]


@pytest.fixture(scope="module")
def camera(room):
    return ovimap.open_source(room)[0].camera


@pytest.fixture(scope="module")
def expected(shots, camera, tmp_path_factory):
    """The hash of the map of the same frames."""
    mapper = ovimap.Mapper()
    for shot in shots:
        mapper.process(ovimap.Frame(shot.color, shot.depth, shot.pose, camera, depth_scale=1000))
    path = tmp_path_factory.mktemp("expected") / "a.ovimap"
    mapper.save(path)
    return ovimap.Map.open(path).content_hash


def hash_of(recording, folder):
    return ovimap.run(recording, folder / "bag.ovimap").content_hash


@pytest.mark.parametrize("kind", ["mcap", "sqlite3", "ros1"])
def test_a_bag_maps_to_what_its_frames_map_to(kind, shots, camera, expected, tmp_path):
    bag = record(tmp_path / ("a.bag" if kind == "ros1" else "a"), shots, camera, Options(kind=kind))
    done = convert(bag, tmp_path / "out")
    assert (done["frames"], done["left_out"], done["world"]) == (len(shots), 0, "map")
    assert hash_of(done["source"], tmp_path) == expected


def test_a_file_of_mcap_without_its_folder_is_read(shots, camera, expected, tmp_path):
    record(tmp_path / "a", shots, camera)
    (file,) = (tmp_path / "a").glob("*.mcap")
    assert hash_of(convert(file, tmp_path / "out")["source"], tmp_path) == expected


def test_odometry_on_a_robot_gives_the_cameras_poses(shots, camera, tmp_path):
    done = convert(record(tmp_path / "a", shots, camera, Options(poses="odometry")), tmp_path / "out")
    source = ovimap.open_source(done["source"])
    assert done["world"] == "odom" and len(source) == len(shots)
    for frame, shot in zip(source, shots):
        np.testing.assert_allclose(frame.world_from_camera, shot.pose, atol=1e-9)
        assert frame.timestamp_s == pytest.approx((START_NS + frame.index * STEP_NS) / 1e9 + 0.001, abs=1e-6)


def test_of_two_odometries_of_one_frame_one_must_be_chosen(shots, camera, tmp_path):
    both = Options(poses="none", more_odometry=("/filtered", "/wheels"))
    bag = record(tmp_path / "a", shots[:3], camera, both)
    said = refusal(bag, tmp_path / "out")
    assert said == "/filtered and /wheels both give the poses of the frame 'depth_optical'; name one of them as the topic of poses"
    done = convert(bag, tmp_path / "out", topics=Topics(poses="/wheels"))
    poses = [frame.world_from_camera for frame in ovimap.open_source(done["source"])]
    np.testing.assert_allclose([pose[1, 3] for pose in poses], [shot.pose[1, 3] + 1 for shot in shots[:3]])


def test_stamped_poses_are_the_cameras(shots, camera, tmp_path):
    bag = record(tmp_path / "a", shots[:3], camera, Options(poses="stamped"))
    done = convert(bag, tmp_path / "out", topics=Topics(poses="/pose"))
    assert done["world"] == "world" and done["frames"] == 3
    poses = [frame.world_from_camera for frame in ovimap.open_source(done["source"])]
    np.testing.assert_allclose(poses, [shot.pose for shot in shots[:3]], atol=1e-9)


def test_where_tf_says_it_odometry_is_not_asked(shots, camera, tmp_path):
    bag = record(tmp_path / "a", shots[:3], camera, Options(more_odometry=("/filtered", "/wheels")))
    poses = [frame.world_from_camera for frame in ovimap.open_source(convert(bag, tmp_path / "out")["source"])]
    np.testing.assert_allclose(poses, [shot.pose for shot in shots[:3]], atol=1e-9)


def test_poses_between_the_images_are_interpolated(shots, camera, tmp_path):
    done = convert(record(tmp_path / "a", shots, camera, Options(between=True)), tmp_path / "out")
    poses = [frame.world_from_camera for frame in ovimap.open_source(done["source"])]
    np.testing.assert_allclose(poses, [shot.pose for shot in shots], atol=1e-9)


def test_compressed_images_are_kept_as_they_are(shots, camera, expected, tmp_path):
    compressed = [dataclasses.replace(shot, color=jpeg_of(shot.color, tmp_path)) for shot in shots]
    done = convert(record(tmp_path / "a", compressed, camera, Options(compressed_depth=True)), tmp_path / "out")
    kept = sorted((tmp_path / "out/color").glob("*.jpg"))
    assert [file.read_bytes() for file in kept] == [shot.color for shot in compressed]
    for frame, shot in zip(ovimap.open_source(done["source"]), shots):
        np.testing.assert_array_equal(frame.depth, (shot.depth / 1000).astype(np.float32))


def jpeg_of(pixels, folder):
    Image.fromarray(pixels).save(folder / "a.jpg", quality=90)
    return (folder / "a.jpg").read_bytes()


def test_depth_in_metres_is_kept_to_a_fifth_of_a_millimetre(shots, camera, tmp_path):
    metres = [dataclasses.replace(shot, depth=(shot.depth / 1000).astype(np.float32)) for shot in shots]
    metres[0].depth[0, :2] = np.nan, np.inf
    done = convert(record(tmp_path / "a", metres, camera), tmp_path / "out")
    frames = list(ovimap.open_source(done["source"]))
    np.testing.assert_array_equal(frames[0].depth[0, :2], 0)
    np.testing.assert_allclose(frames[1].depth, metres[1].depth, atol=1.1e-4)


def test_compressed_depth_in_metres_is_kept_as_well_as_it_was_stored(shots, camera, tmp_path):
    metres = [dataclasses.replace(shot, depth=(shot.depth / 1000).astype(np.float32)) for shot in shots[:2]]
    metres[0].depth[0, :2] = 0
    done = convert(record(tmp_path / "a", metres, camera, Options(compressed_depth=True)), tmp_path / "out")
    frames = list(ovimap.open_source(done["source"]))
    np.testing.assert_array_equal(frames[0].depth[0, :2], 0)
    for frame, shot in zip(frames, metres):
        step = shot.depth**2 / (100 * 101)  # of the stored inverse
        assert np.all(np.abs(frame.depth - shot.depth) < 0.51 * step + 1.1e-4)


def test_color_with_a_camera_of_its_own_keeps_its_offset(shots, camera, tmp_path):
    offset = matrix_of((-0.024, 0.0034, 0.012), (-0.003, 0.001, 0.004, 1))
    small = ovimap.PinholeCamera(camera.width, camera.height, 531.1, 531.1, 318.9, 232.8)
    done = convert(record(tmp_path / "a", shots, camera, Options(color_camera=small, color_from_depth=offset)), tmp_path / "out")
    frame = ovimap.open_source(done["source"])[0]
    np.testing.assert_allclose(frame.color_from_depth, offset, atol=1e-9)
    assert frame.color_camera == small and frame.camera == camera


def test_a_bag_of_the_kitchen_maps_to_what_the_kitchen_maps_to(kitchen, tmp_path):
    source = ovimap.open_source(kitchen)
    frames = list(source.frames("::20"))
    shots = []
    for frame in frames:
        stem = kitchen / frame.name.removesuffix(".color")
        depth = np.asarray(Image.open(f"{stem}.depth.png")).astype(np.uint16)
        shots.append(Shot((kitchen / f"{stem}.color.jpg").read_bytes(), depth, np.array(frame.world_from_camera)))
    options = Options(compressed_depth=True, color_camera=frames[0].color_camera, color_from_depth=frames[0].color_from_depth)
    done = convert(record(tmp_path / "a", shots, frames[0].camera, options), tmp_path / "out")
    direct = ovimap.run(kitchen, tmp_path / "folder.ovimap", frames="::20")
    assert hash_of(done["source"], tmp_path) == direct.content_hash


def refusal(path, out, **topics):
    with pytest.raises(ovimap.Error) as raised:
        convert(path, out, topics=Topics(**topics))
    assert "\n" not in str(raised.value)
    return str(raised.value)


def test_what_a_bag_lacks_is_named(shots, camera, tmp_path):
    few, out = shots[:3], tmp_path / "out"
    assert "no camera_info beside /color/image" in refusal(record(tmp_path / "a", few, camera, Options(info=False)), out)
    bag = record(tmp_path / "b", few, camera, Options(poses="none"))
    assert "nothing in the bag moves the camera's frame 'depth_optical'" in refusal(bag, out)
    good = record(tmp_path / "c", few, camera)
    assert "the bag has no images '/front'; it has /color/image, /depth/image" in refusal(good, out, color="/front")
    assert refusal(good, out, poses="/tf") == "the bag has no odometry or stamped poses '/tf'; it has none at all"
    odometry = record(tmp_path / "d", few, camera, Options(poses="odometry"))
    assert "no odometry or stamped poses '/nothing'; it has /odom" in refusal(odometry, out, poses="/nothing")
    assert "is no ancestor" in refusal(good, out, world="moon")
    assert "there is no bag" in refusal(tmp_path / "nowhere.bag", out)
    (tmp_path / "folder").mkdir()
    (tmp_path / "notes.txt").write_text("no bag")
    for name in ("folder", "notes.txt"):
        assert refusal(tmp_path / name, out) == f"'{tmp_path / name}' is no bag; name a .bag file, a ROS 2 bag's folder or an .mcap file"
    (tmp_path / "full").mkdir()
    (tmp_path / "full/a").touch()
    assert "is not empty" in refusal(good, tmp_path / "full")


def test_a_camera_without_calibration_is_refused_before_its_images_are_read(shots, camera, tmp_path, monkeypatch):
    unknown = ovimap.PinholeCamera(camera.width, camera.height, 0, 0, 0, 0)
    bag = record(tmp_path / "a", shots[:3], camera, Options(color_camera=unknown))
    monkeypatch.setattr(Stream, "write", lambda *_: pytest.fail("an image was read"))
    said = refusal(bag, tmp_path / "out")
    assert f"/color/camera_info holds no calibration ({camera.width}x{camera.height}, fx 0, fy 0); calibrate the camera" in said
    assert not (tmp_path / "out").exists()


def test_a_clock_that_jumps_is_an_error(shots, camera, tmp_path):
    said = refusal(record(tmp_path / "a", shots, camera, Options(jump_after=6)), tmp_path / "out")
    assert "jumps by -0.1" in said and "after image 6" in said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("kind", ["mcap", "sqlite3", "ros1"])
@pytest.mark.parametrize("share", [0.0, 0.02, 0.5, 0.99])
def test_a_bag_that_is_cut_off_is_an_error(kind, share, shots, camera, tmp_path):
    bag = record(tmp_path / ("a.bag" if kind == "ros1" else "a"), shots[:4], camera, Options(kind=kind))
    file = bag if kind == "ros1" else next(f for f in bag.iterdir() if f.suffix in (".mcap", ".db3"))
    data = file.read_bytes()
    file.write_bytes(data[: int(share * len(data))])
    assert "cut off" in refusal(bag, tmp_path / "out")


def test_the_command_prints_what_it_did(shots, camera, tmp_path, capsys):
    bag = record(tmp_path / "a", shots[:3], camera)
    assert main([str(bag), str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["frames"] == 3
    assert main([str(tmp_path / "none"), str(tmp_path / "o2")]) == 2
    assert capsys.readouterr().err.startswith("ovimap-bag: there is no bag")
    done = subprocess.run([sys.executable, "-m", "ovimap.bags", bag, tmp_path / "o3"], capture_output=True, text=True)
    assert done.returncode == 0 and "3 frames, 0 left out" in done.stdout


def test_an_output_that_cannot_be_written_is_one_line(shots, camera, tmp_path, capsys):
    bag = str(record(tmp_path / "a", shots[:3], camera))
    (tmp_path / "file").write_text("a file")
    for out in (tmp_path / "file", tmp_path / "file/out", "/proc/out"):
        assert main([bag, str(out)]) == 2
        said = capsys.readouterr().err
        assert said.startswith("ovimap-bag: ") and "give a folder that can be written" in said and said.count("\n") == 1
    assert (tmp_path / "file").read_text() == "a file"
    limited = f"ulimit -f 8; exec {sys.executable} -m ovimap.bags {bag} {tmp_path}/full"  # no file beyond a few KiB
    done = subprocess.run(["bash", "-c", limited], capture_output=True, text=True)
    assert done.returncode == 2 and "File too large" in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "full").exists()


def test_the_lens_of_camera_info_is_taken_along(shots, camera, tmp_path):
    read = {}
    for distortion in (0.0, 0.1):
        bag, out = record(tmp_path / f"a{distortion}", shots[:3], camera, Options(distortion=distortion)), tmp_path / f"out{distortion}"
        convert(bag, out)
        given = yaml.safe_load((out / "camera.yaml").read_text())
        lenses = [given[name].get("distortion") for name in ("color_camera", "depth_camera")]
        assert lenses == 2 * [{"model": "brown_conrady", "coefficients": 5 * [0.1]} if distortion else None]
        read[distortion] = list(ovimap.open_source(out).frames())
    assert len(read[0.1]) == 3 and not np.array_equal(read[0.0][0].depth, read[0.1][0].depth)


@pytest.mark.parametrize("topic, model, d, expected", [
    ("/a/image_raw", "plumb_bob", [0.1, 0, 0, 0.2], ("brown_conrady", [0.1, 0, 0, 0.2, 0])),
    ("/a/image_raw", "rational_polynomial", [1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0], ("brown_conrady", [1, 2, 3, 4, 5, 6, 7, 8])),
    ("/a/image_raw", "equidistant", [0, 0, 0, 0], ("kannala_brandt", [0, 0, 0, 0])),
    ("/a/image_rect", "plumb_bob", [0.1, 0, 0, 0.2, 0], None),
    ("/a/image_raw", "plumb_bob", [0, 0, 0, 0, 0], None),
    ("/a/image_raw", "", [], None),
])  # fmt: skip
def test_lenses_by_ross_names(topic, model, d, expected):
    info = types.SimpleNamespace(distortion_model=model, d=np.array(d, np.float64))
    found = lens_of(topic, info).get("distortion")
    assert found == (expected and {"model": expected[0], "coefficients": expected[1]})


@pytest.mark.parametrize("model, d", [("scaramuzza", [1, 2]), ("rational_polynomial", 8 * [0] + 4 * [0.1])])
def test_lenses_that_are_not_read_are_told(model, d):
    with pytest.raises(ovimap.Error, match=f"the lens of /a has the model '{model}' with {len(d)} coefficients, which is not read"):
        lens_of("/a", types.SimpleNamespace(distortion_model=model, D=np.array(d, np.float64)))


def test_rotations_survive_as_quaternions():
    random = np.random.default_rng(3)
    for q in [*random.normal(size=(50, 4)), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)]:
        matrix = matrix_of((1, 2, 3), tuple(q))
        np.testing.assert_allclose(matrix_of((1, 2, 3), tuple(quaternion_of(matrix))), matrix, atol=1e-15)
        np.testing.assert_allclose(np.linalg.det(matrix[:3, :3]), 1)


def test_halfway_between_two_turns_is_half_the_turn():
    quarter = matrix_of((2, 0, 0), (0, 0, np.sin(np.pi / 4), np.cos(np.pi / 4)))
    eighth = matrix_of((1, 0, 0), (0, 0, np.sin(np.pi / 8), np.cos(np.pi / 8)))
    np.testing.assert_allclose(between(np.eye(4), quarter, 0.5), eighth, atol=1e-12)
