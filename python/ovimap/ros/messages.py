# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Objects, surface and grid of a map as ROS 2 messages. All lengths are metres in the frame that the header names."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ..transforms import quaternion_of
from .grid import Grid
from .served import Cloud
from .types import make

CLOUD = "sensor_msgs/msg/PointCloud2"
DETECTIONS = "vision_msgs/msg/Detection3DArray"
MARKERS = "visualization_msgs/msg/MarkerArray"
GRID = "nav_msgs/msg/OccupancyGrid"
POSES = "geometry_msgs/msg/PoseArray"
WAY = "nav_msgs/msg/Path"
TRANSFORM = "tf2_msgs/msg/TFMessage"
TEXT_LINE = "std_msgs/msg/String"
FLOAT32, UINT32 = 7, 6  # of sensor_msgs/PointField
CUBE, TEXT, ADD, DELETE_ALL = 1, 9, 0, 3  # of visualization_msgs/Marker
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4"), ("instance", "<u4")])
TEXT_HEIGHT_M = 0.12
NOBODY = "object"  # the name of what is not known


def stamp_of(time_ns: int) -> Any:
    return make("builtin_interfaces/msg/Time", sec=time_ns // 1_000_000_000, nanosec=time_ns % 1_000_000_000)


def header_of(frame: str, time_ns: int) -> Any:
    return make("std_msgs/msg/Header", stamp=stamp_of(time_ns), frame_id=frame)


def cloud_message(cloud: Cloud, header: Any) -> Any:
    """Fields x, y, z, rgb (packed in a float, as PCL and RViz read it) and instance, the object's id."""
    points = np.empty(len(cloud.points), POINT)
    points["x"], points["y"], points["z"] = cloud.points.T
    red, green, blue = cloud.colors.astype(np.uint32).T
    points["rgb"] = red << 16 | green << 8 | blue
    points["instance"] = cloud.ids
    kinds = {"instance": UINT32}
    fields = [make("sensor_msgs/msg/PointField", name=name, offset=place[1], datatype=kinds.get(name, FLOAT32), count=1)
              for name, place in (POINT.fields or {}).items()]
    size = POINT.itemsize
    return make(CLOUD, header=header, height=1, width=len(points), fields=fields, is_bigendian=False, point_step=size,
                row_step=size * len(points), data=points.view(np.uint8).ravel(), is_dense=True)


def name_of(thing: dict[str, Any]) -> str:
    """What people called it, else what it clearly is."""
    label = thing["label"] or {}
    return str(thing["name"] or label.get("name") or NOBODY)


def certainty_of(thing: dict[str, Any]) -> float:
    """1 where people said what it is, else the label's share."""
    return 1.0 if thing["name"] else float((thing["label"] or {}).get("share") or 0)


def detections_message(things: list[dict[str, Any]], header: Any, scores: dict[int, float] | None = None) -> Any:
    """One a thing: id, name with its certainty or the given score, and the box, which is parallel to the world's axes."""
    found = []
    for thing in things:
        score = certainty_of(thing) if scores is None else scores[thing["id"]]
        pose = _pose(thing["centroid"])
        hypothesis = make("vision_msgs/msg/ObjectHypothesis", class_id=name_of(thing), score=score)
        with_covariance = make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=np.zeros(36))
        result = make("vision_msgs/msg/ObjectHypothesisWithPose", hypothesis=hypothesis, pose=with_covariance)
        center, size = _box(thing)
        box = make("vision_msgs/msg/BoundingBox3D", center=_pose(center), size=_vector(size))
        found.append(make("vision_msgs/msg/Detection3D", header=header, results=[result], bbox=box, id=str(thing["id"])))
    return make(DETECTIONS, header=header, detections=found)


def markers_message(things: list[dict[str, Any]], header: Any) -> Any:
    """A box and a name for each thing, after a marker that deletes those of before."""
    markers = [_marker(header, "", 0, CUBE, [0, 0, 0], [1, 1, 1], [0, 0, 0], 0.0, action=DELETE_ALL)]
    for thing in things:
        center, size = _box(thing)
        color = [value / 255 for value in thing["color"]]
        markers.append(_marker(header, "boxes", thing["id"], CUBE, center, np.maximum(size, 0.001), color, 0.35))
        above = [center[0], center[1], thing["box"]["max"][2] + TEXT_HEIGHT_M]
        text = f"{name_of(thing)} {thing['id']}"
        markers.append(_marker(header, "names", thing["id"], TEXT, above, [0, 0, TEXT_HEIGHT_M], [1, 1, 1], 1.0, text=text))
    return make(MARKERS, markers=markers)


def grid_message(grid: Grid, header: Any) -> Any:
    """The grid lies on the floor; its origin turns it where the map's z does not point up."""
    corner = grid.world_from_grid @ [*grid.origin, grid.floor_m]
    turn = np.eye(4)
    turn[:3, :3] = grid.world_from_grid
    rows, columns = grid.cells.shape
    info = make("nav_msgs/msg/MapMetaData", map_load_time=header.stamp, resolution=grid.cell_m, width=columns, height=rows,
                origin=_pose(corner, quaternion_of(turn)))
    return make(GRID, header=header, info=info, data=grid.cells.ravel())


def poses_message(poses: list[dict[str, Any]], header: Any) -> Any:
    """Where to stand, best first: on the floor, x ahead to what is to be seen, z up."""
    return make(POSES, header=header, poses=[_standing(pose["position"], pose["direction"]) for pose in poses])


def way_message(poses: list[dict[str, Any]], header: Any) -> Any:
    """The way to the best of them: at each corner the robot looks to the next, at the end to what is to be seen. Empty where it has none."""
    corners = poses[0]["way_in_world"] if poses else []
    ahead = [np.subtract(after, before) for before, after in zip(corners, corners[1:])] + [poses[0]["direction"]] if corners else []
    return make(WAY, header=header, poses=[make("geometry_msgs/msg/PoseStamped", header=header, pose=_standing(corner, way))
                                           for corner, way in zip(corners, ahead)])  # fmt: skip


def _standing(position: Any, ahead: Any) -> Any:
    yaw = float(np.arctan2(ahead[1], ahead[0]))
    return _pose(position, (0, 0, np.sin(yaw / 2), np.cos(yaw / 2)))


def frames_message(things: list[dict[str, Any]], header: Any) -> Any:
    """A frame at the middle of each thing that people named, called object/NAME_ID."""
    return make(TRANSFORM, transforms=[
        make("geometry_msgs/msg/TransformStamped", header=header, child_frame_id=frame_name(thing),
             transform=make("geometry_msgs/msg/Transform", translation=_vector(_box(thing)[0]), rotation=_quaternion([0, 0, 0, 1])))
        for thing in things if thing["name"]])  # fmt: skip


def frame_name(thing: dict[str, Any]) -> str:
    """Letters and digits of any script, in lower case; what lies between is an underscore."""
    return f"object/{re.sub(r'[^0-9a-z]+', '_', thing['name'].lower(), flags=re.ASCII).strip('_') or NOBODY}_{thing['id']}"


def _box(thing: dict[str, Any]) -> tuple[Any, Any]:
    least, most = np.array(thing["box"]["min"], np.float64), np.array(thing["box"]["max"], np.float64)
    return (least + most) / 2, most - least


def _vector(xyz: Any, kind: str = "geometry_msgs/msg/Vector3") -> Any:
    return make(kind, **dict(zip("xyz", map(float, xyz))))


def _quaternion(xyzw: Any) -> Any:
    return make("geometry_msgs/msg/Quaternion", **dict(zip("xyzw", map(float, xyzw))))


def _pose(position: Any, turn: Any = (0, 0, 0, 1)) -> Any:
    return make("geometry_msgs/msg/Pose", position=_vector(position, "geometry_msgs/msg/Point"), orientation=_quaternion(turn))


def _marker(header: Any, group: str, number: int, kind: int, place: Any, size: Any, color: Any, alpha: float, *, text: str = "",
            action: int = ADD) -> Any:
    """A Marker has a field for everything; what is left out is empty."""
    uv = make("visualization_msgs/msg/MeshFile", filename="", data=np.zeros(0, np.uint8))
    none = make("sensor_msgs/msg/CompressedImage", header=header, format="", data=np.zeros(0, np.uint8))
    rgba = make("std_msgs/msg/ColorRGBA", r=float(color[0]), g=float(color[1]), b=float(color[2]), a=alpha)
    return make("visualization_msgs/msg/Marker", header=header, ns=group, id=number, type=kind, action=action, pose=_pose(place),
                scale=_vector(size), color=rgba, lifetime=make("builtin_interfaces/msg/Duration", sec=0, nanosec=0), frame_locked=False,
                points=[], colors=[], texture_resource="", texture=none, uv_coordinates=[], text=text, mesh_resource="", mesh_file=uv,
                mesh_use_embedded_materials=False)
