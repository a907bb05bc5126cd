# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A real ROS 2 (rclpy over Fast DDS) sends frames and reads what ovimap-ros publishes. $OVIMAP_ROS2_PYTHON: a Python that has it."""
import json
import os
import pathlib
import subprocess

import numpy as np
import ovimap
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; tools/setup.sh --tests installs it")
pytest.importorskip("rosbags")
from ovimap.ros import types
from ovimap.ros.messages import POINT
from ovimap.transforms import quaternion_of
from test_ros import DOMAIN, FRAMES, LOOPBACK, PROGRAM, live_server, ovimap_ros

ROS2 = os.environ.get("OVIMAP_ROS2_PYTHON")
PEER = pathlib.Path(__file__).parent / "ros2/peer.py"
pytestmark = pytest.mark.skipif(not ROS2 or not PROGRAM, reason="no ROS 2: set OVIMAP_ROS2_PYTHON to a Python with python/tests/ros2/requirements.txt")


@pytest.fixture(scope="module", autouse=True)
def loopback():
    os.environ.setdefault("CYCLONEDDS_URI", LOOPBACK)


def peer(frames, name, *wanted):
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | {"ROS_DOMAIN_ID": str(DOMAIN)}
    done = subprocess.run([ROS2, PEER, frames, name, *wanted], env=environment, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_frames_of_rclpy_are_mapped_and_rclpy_reads_the_objects(room, tmp_path):
    recorded = list(ovimap.open_source(room).frames(f":{FRAMES}"))
    camera = recorded[0].camera
    np.savez(tmp_path / "frames.npz", color=[np.array(frame.color) for frame in recorded], k=[camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1],
             depth=[np.rint(np.array(frame.depth) * 1000).astype(np.uint16) for frame in recorded],
             position=[frame.world_from_camera[:3, 3] for frame in recorded], turn=[quaternion_of(np.array(frame.world_from_camera)) for frame in recorded])
    with live_server(tmp_path / "ros2.ovimap") as server:
        with ovimap_ros(server.address, "--color", "/rcl/color/image", "--depth", "/rcl/depth/image", "--poses", "/rcl/pose", "--reliable",
                        "--name", "/rcl") as bridge:
            told = peer(tmp_path / "frames.npz", "rcl", "objects", "markers")
        saved = json.loads(server.process.stdout.readline())["saved"]
    assert told["rmw"] == "rmw_fastrtps_cpp" and told["sent"] > 0
    assert {"/ovimap_frames", "/ovimap_map"} <= set(told["nodes"])
    assert 0 < saved["frames"] <= told["sent"], bridge.lines
    objects = told["got"]["objects"]
    assert objects["width"] > 1000 and objects["bytes"] == objects["width"] * POINT.itemsize and objects["frame"] == "map"
    assert objects["fields"] == ["x", "y", "z", "rgb", "instance"] and objects["hash"].endswith(types.type_hash("sensor_msgs/msg/PointCloud2"))
    assert told["got"]["markers"]["texts"]


def test_rclpy_reads_a_maps_grid_although_it_comes_late(saved_map, tmp_path):
    np.savez(tmp_path / "none.npz")
    with ovimap_ros(saved_map, "--name", "/kept2"):
        told = peer(tmp_path / "none.npz", "kept2", "grid", "objects", "markers")["got"]
    assert told["grid"]["cells"] == told["grid"]["size"] > 0 and told["grid"]["values"] == [-1, 0, 100]
    assert told["grid"]["hash"].endswith(types.type_hash("nav_msgs/msg/OccupancyGrid"))
