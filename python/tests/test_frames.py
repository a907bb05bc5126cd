# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Frames from arrays: what is taken, what is refused and in which words, and views without copies."""
import gc

import numpy as np
import ovimap
import pytest
from conftest import wall


class Tensor:
    """What speaks DLPack and nothing else, as tensors of other libraries do."""

    def __init__(self, array, device=(1, 0)):
        self.array, self.device = array, device

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.device


@pytest.fixture
def images(camera):
    random = np.random.default_rng(1)
    color = random.integers(0, 256, (camera.height, camera.width, 3), np.uint8)
    return color, random.uniform(0.5, 4, (camera.height, camera.width)).astype(np.float32)


def test_arrays_come_back_as_they_went_in(camera, images):
    pose = np.eye(4)
    pose[:3, 3] = 1, 2, 3
    frame = ovimap.Frame(*images, pose, camera, index=7, name="seven", timestamp_s=0.5)
    np.testing.assert_array_equal(frame.color, images[0])
    np.testing.assert_array_equal(frame.depth, images[1])
    np.testing.assert_allclose(frame.world_from_camera, pose)
    assert (frame.index, frame.name, frame.timestamp_s, frame.camera) == (7, "seven", 0.5, camera)
    assert frame.registered and frame.color_camera == camera


def test_views_share_the_frames_memory_and_keep_it_alive(camera, images):
    frame = ovimap.Frame(*images, np.eye(4), camera)
    depth = frame.depth
    assert np.shares_memory(depth, frame.depth) and not depth.flags.writeable
    assert np.shares_memory(frame.color, frame.color) and not frame.color.flags.writeable
    del frame
    gc.collect()
    np.testing.assert_array_equal(depth, images[1])


def test_arrays_of_any_layout_are_taken(camera, images):
    color, depth = images
    wide = np.repeat(color, 2, axis=1)
    frame = ovimap.Frame(wide[:, ::2], np.asfortranarray(depth), np.eye(4).T, camera)
    np.testing.assert_array_equal(frame.color, color)
    np.testing.assert_array_equal(frame.depth, depth)
    mirrored = ovimap.Frame(color[::-1, ::-1, ::-1], depth[::-1], np.eye(4, dtype=np.float32), camera)
    np.testing.assert_array_equal(mirrored.color, color[::-1, ::-1, ::-1])
    np.testing.assert_array_equal(mirrored.depth, depth[::-1])


def test_tensors_are_taken_through_dlpack(camera, images):
    frame = ovimap.Frame(Tensor(images[0]), Tensor(images[1].astype(np.float64)), np.eye(4), camera)
    np.testing.assert_array_equal(frame.color, images[0])
    np.testing.assert_array_equal(frame.depth, images[1])


def test_a_tensor_on_a_gpu_is_refused_with_the_remedy(camera, images):
    with pytest.raises(TypeError, match=r"color must be uint8 .* came a Tensor on another device; call .cpu\(\)"):
        ovimap.Frame(Tensor(images[0], (2, 0)), images[1], np.eye(4), camera)


def test_numbers_of_another_byte_order_are_refused_with_the_remedy(camera, images):
    with pytest.raises(TypeError, match="came a ndarray of >f4 that cannot be read as an array; .* in this machine's byte order"):
        ovimap.Frame(images[0], images[1].astype(">f4"), np.eye(4), camera)


def test_depth_in_units_is_divided_by_its_scale_and_limited(camera, images):
    units = np.full((camera.height, camera.width), 1500, np.uint16)
    units[0, :3] = 0, 50, 65535
    frame = ovimap.Frame(images[0], units, np.eye(4), camera, depth_scale=1000)
    assert frame.depth[1, 1] == np.float32(1.5)
    np.testing.assert_array_equal(frame.depth[0, :3], 0)  # none, too near, too far


def test_depth_that_is_not_finite_is_none(camera, images):
    depth = images[1].copy()
    depth[0, :3] = np.nan, np.inf, -1
    np.testing.assert_array_equal(ovimap.Frame(images[0], depth, np.eye(4), camera).depth[0, :3], 0)


@pytest.mark.parametrize(
    "change, error, words",
    [
        ({"color": np.zeros((48, 64, 3))}, TypeError, r"color must be uint8 \[height, width, 3\].* came float64 \[48, 64, 3\]"),
        ({"color": np.zeros((48, 64), np.uint8)}, ValueError, r"color must be .* came uint8 \[48, 64\]"),
        ({"color": np.zeros((48, 64, 4), np.uint8)}, ValueError, r"came uint8 \[48, 64, 4\]"),
        ({"color": np.zeros((24, 32, 3), np.uint8)}, ValueError, "color must be of the size of camera, 64 wide and 48 high; came 32"),
        ({"color": None}, TypeError, "color must be .* came None"),
        ({"color": "a picture"}, TypeError, "color must be .* came a str that cannot be read as an array"),
        ({"depth": np.zeros((48, 64), np.uint16)}, TypeError, r"depth must be float32 .* came uint16 \[48, 64\] without depth_scale"),
        ({"depth": np.zeros((48, 64), complex)}, TypeError, "came complex128"),
        ({"depth": np.zeros((48, 64, 1), np.float32)}, ValueError, r"came float32 \[48, 64, 1\]"),
        ({"depth": np.ones((48, 64), np.uint16), "depth_scale": 0}, ValueError, "depth_scale must be above 0"),
        ({"min_depth_m": 2, "max_depth_m": 1}, ValueError, "below max_depth_m; came 2 with max_depth_m 1"),
        ({"world_from_camera": np.eye(3)}, ValueError, r"world_from_camera must be .*\[4, 4\].* came float64 \[3, 3\]"),
        ({"world_from_camera": np.diag([1, 1, -1, 1.0])}, ValueError, "reflection"),
        ({"world_from_camera": np.full((4, 4), np.nan)}, ValueError, "not finite"),
        ({"camera": ovimap.PinholeCamera(64, 48, 0, 60, 32, 24)}, ValueError, "camera must have a size and focal lengths above 0"),
    ],
)
def test_what_does_not_fit_is_refused_with_what_was_expected(camera, images, change, error, words):
    arguments = {"color": images[0], "depth": images[1], "world_from_camera": np.eye(4), "camera": camera} | change
    with pytest.raises(error, match=words):
        ovimap.Frame(**arguments)


def test_color_may_have_a_camera_of_its_own(camera, images):
    color_camera = ovimap.PinholeCamera(32, 24, 30, 30, 16, 12)
    offset = np.eye(4)
    offset[0, 3] = 0.02
    frame = ovimap.Frame(
        np.zeros((24, 32, 3), np.uint8), images[1], np.eye(4), camera, color_camera=color_camera, color_from_depth=offset
    )
    assert not frame.registered and frame.color_camera == color_camera
    np.testing.assert_allclose(frame.color_from_depth, offset)


def test_error_is_a_runtime_error_and_frame_error_an_error():
    assert issubclass(ovimap.Error, RuntimeError) and issubclass(ovimap.FrameError, ovimap.Error)


def test_a_frame_says_what_it_is(camera):
    assert "64x48" in repr(wall(camera, 0)) and "fx=60" in repr(camera)
