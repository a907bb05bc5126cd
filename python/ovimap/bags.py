# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""ROS 1 bags, ROS 2 bags and MCAP files, turned into a folder that ovimap reads (docs/sources.md)."""

from __future__ import annotations

import argparse
import bisect
import json
import os
import pathlib
import shutil
import sys
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ._ovimap import Error, encode_png
from .bag_messages import (
    CAMERA,
    IMAGES,
    JPEG,
    ODOMETRY,
    POSES,
    TRANSFORMS,
    Bag,
    add_transforms,
    camera_of,
    color_of,
    depth_of,
    is_depth,
    pose_of,
    stamp_ns,
)
from .command_line import DONE, run_command
from .transforms import Matrix, TransformTree, quaternion_of, rotation_vector_of

MILLIMETRES = 1000  # what 16-bit depth counts by ROS's convention (REP 118)
FLOAT_UNITS = 5000  # to which depth in metres is rounded: 0.2 mm, up to 13 m
MAX_TIME_GAP_S = 0.02  # colour and depth farther apart do not belong together
WAITING_IMAGES = 8  # of a topic, not yet written
MAX_CLOCK_JUMP_S = 5.0  # how much the clock of images may run away from the bag's within one message


@dataclass
class Topics:
    """What to read; what is None is found where there is only one."""

    color: str | None = None
    depth: str | None = None
    poses: str | None = None  # of odometry or poses, instead of tf
    world: str | None = None  # the frame poses are given in; None: the root of the transforms


@dataclass
class Stream:
    """The images of one topic, written as they come, on the threads of `pool`."""

    topic: str
    info_topic: str
    folder: pathlib.Path
    pool: ThreadPoolExecutor
    depth: bool
    frame: str = ""
    units: int = MILLIMETRES
    info: Any = None
    camera: dict[str, float] = field(default_factory=dict)
    times_ns: list[int] = field(default_factory=list)
    files: list[pathlib.Path] = field(default_factory=list)
    clock_offset_ns: int | None = None
    pending: deque[Future[pathlib.Path]] = field(default_factory=deque)

    def see_camera(self, info: Any) -> None:
        self.camera = camera_of(info, self.info_topic, self.topic)
        self.info = info

    def check_clock(self, time_ns: int, received_ns: int) -> None:
        if time_ns == 0:
            raise Error(f"the images of {self.topic} have no time stamps; record them with header.stamp set")
        last = self.times_ns[-1] if self.times_ns else time_ns
        offset = received_ns - time_ns
        run_away = abs(offset - (self.clock_offset_ns if self.clock_offset_ns is not None else offset))
        if time_ns < last or run_away > MAX_CLOCK_JUMP_S * 1e9:
            jump = (time_ns - last) / 1e9 if time_ns < last else run_away / 1e9
            raise Error(
                f"the clock of {self.topic} jumps by {jump:.3f} s after image {len(self.times_ns)}; cut the bag there "
                "and convert the parts one by one"
            )
        self.clock_offset_ns = offset

    def write(self, message: Any, received_ns: int) -> None:
        time_ns = stamp_ns(message.header)
        self.check_clock(time_ns, received_ns)
        if self.times_ns and time_ns == self.times_ns[-1]:
            return  # the same image twice
        self.frame = message.header.frame_id.lstrip("/")
        self.times_ns.append(time_ns)
        self.pending.append(self.pool.submit(self.write_file, message, f"{time_ns // 10**9}.{time_ns % 10**9:09d}"))
        self.finish(WAITING_IMAGES)

    def write_file(self, message: Any, stem: str) -> pathlib.Path:
        data, ending = self.encode(message)
        file = self.folder / (stem + ending)
        file.write_bytes(data)
        return file

    def finish(self, left: int = 0) -> None:
        """Waits until at most `left` images are not written; raises what writing one of the others raised."""
        while len(self.pending) > left:
            self.files.append(self.pending.popleft().result())

    def encode(self, message: Any) -> tuple[bytes, str]:
        picture = depth_of(message, self.topic) if self.depth else color_of(message, self.topic)
        if isinstance(picture, bytes):
            return picture, ".jpg" if picture.startswith(JPEG) else ".png"
        return self.encode_depth(picture) if self.depth else (encode_png(picture), ".png")

    def encode_depth(self, depth: Any) -> tuple[bytes, str]:
        if depth.dtype == np.uint16:
            return encode_png(depth), ".png"
        self.units = FLOAT_UNITS
        units = np.nan_to_num(depth * np.float32(FLOAT_UNITS), nan=0, posinf=0, neginf=0)
        return encode_png(np.where((units > 0) & (units < 65535), np.rint(units), 0).astype(np.uint16)), ".png"


def convert(bag: str | os.PathLike[str], out: str | os.PathLike[str], *, topics: Topics | None = None) -> dict[str, Any]:
    """Writes a bag's frames as a folder that ovimap.open_source reads: colour, depth, poses.txt, camera.yaml.

    bag: a .bag file, a ROS 2 bag's folder, or an .mcap file. Poses come from tf, odometry or stamped poses; images
    stay as they were compressed. Returns {"source", "frames", "left_out", "color", "depth", "world"}.
    Raises Error for a bag that is cut off, whose clock jumps, or that lacks images, camera_info with a calibration or
    poses, and where `topics` must choose; OSError for a folder that cannot be written.
    """
    chosen, folder = topics or Topics(), pathlib.Path(out)
    if folder.exists() and any(folder.iterdir()):
        raise Error(f"'{folder}' is not empty; name a new folder")
    try:
        # Threads, not processes: encode_png lets the others run.
        with Bag(pathlib.Path(bag)) as opened, ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
            color_topic, depth_topic = _image_topics(opened, chosen)
            color = Stream(color_topic, _info_topic(opened, color_topic), folder / "color", pool, depth=False)
            depth = Stream(depth_topic, _info_topic(opened, depth_topic), folder / "depth", pool, depth=True)
            for stream in (color, depth):
                stream.folder.mkdir(parents=True, exist_ok=True)
            tree = _read(opened, color, depth, chosen)
            for stream in (color, depth):
                stream.finish()
        return _write_folder(folder, color, depth, tree, chosen)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)  # it was empty or not there: nothing half done is left
        raise


def _image_topics(bag: Bag, chosen: Topics) -> tuple[str, str]:
    images = bag.topics(*IMAGES)
    for name in (chosen.color, chosen.depth):
        if name is not None and name not in images:
            raise Error(f"the bag has no images '{name}'; it has {', '.join(images) or 'none at all'}")
    found: dict[bool, list[str]] = {False: [], True: []}
    seen: set[str] = set()
    for topic, _, message in bag.messages(set(images)):
        if topic not in seen:
            seen.add(topic)
            found[is_depth(message)].append(topic)
        if len(seen) == len(images):
            break
    result = []
    for name, which, option in ((chosen.color, False, "color"), (chosen.depth, True, "depth")):
        if name is None and len(found[which]) != 1:
            raise Error(
                f"the bag has {len(found[which])} topics of {option} images ({', '.join(sorted(found[which])) or 'none'}); "
                + (f"name one with --{option}" if found[which] else f"ovimap needs {option} images")
            )
        result.append(name if name is not None else found[which][0])
    return result[0], result[1]


def _info_topic(bag: Bag, image_topic: str) -> str:
    """camera_info beside the images or in the folders above (image_raw/compressed), else the only one."""
    infos = bag.topics(CAMERA)
    folder = image_topic
    while "/" in folder.strip("/"):
        folder = folder.rsplit("/", 1)[0]
        if f"{folder}/camera_info" in infos:
            return f"{folder}/camera_info"
    if len(infos) == 1:
        return infos[0]
    raise Error(f"the bag has no camera_info beside {image_topic} (it has {', '.join(infos) or 'none'}); record that topic too")


def _pose_topics(bag: Bag, chosen: Topics) -> list[str]:
    if chosen.poses is None:
        return bag.topics(ODOMETRY)
    known = bag.topics(ODOMETRY, *POSES)
    if chosen.poses not in known:
        raise Error(f"the bag has no odometry or stamped poses '{chosen.poses}'; it has {', '.join(known) or 'none at all'}")
    return [chosen.poses]


def _read(bag: Bag, color: Stream, depth: Stream, chosen: Topics) -> TransformTree:
    streams = {color.topic: color, depth.topic: depth}
    odometry = _pose_topics(bag, chosen)
    transforms = bag.topics(*TRANSFORMS)
    tree, given = TransformTree(), {topic: TransformTree() for topic in odometry}
    for topic, received_ns, message in bag.messages({*streams, color.info_topic, depth.info_topic, *transforms, *odometry}):
        if topic in streams:
            streams[topic].write(message, received_ns)
        elif topic in transforms:
            add_transforms(tree, message, static=topic.endswith("static"))
        elif topic in odometry:
            _add_pose(given[topic], bag.types[topic], message)
        for stream in streams.values():
            if topic == stream.info_topic:
                stream.see_camera(message)
    _add_links(tree, given, depth.frame, chosen)
    return tree


def _add_links(tree: TransformTree, given: dict[str, TransformTree], camera: str, chosen: Topics) -> None:
    """Odometry says where a frame is of which tf says nothing, and a chosen topic says it instead of tf."""
    links = [(child or camera, topic, link) for topic, odometry in given.items() for child, link in odometry.links.items()]
    giver: dict[str, str] = {}
    for child, topic, link in links:
        if child in giver:
            raise Error(f"{giver[child]} and {topic} both give the poses of the frame '{child}'; name one of them as the topic of poses")
        if chosen.poses or child not in tree.links:
            giver[child], tree.links[child] = topic, link


def _add_pose(tree: TransformTree, kind: str, message: Any) -> None:
    child = message.child_frame_id if kind == ODOMETRY else ""  # a pose names no child: the camera's
    tree.add(message.header.frame_id, child, stamp_ns(message.header), pose_of(message))


def _write_folder(folder: pathlib.Path, color: Stream, depth: Stream, tree: TransformTree, chosen: Topics) -> dict[str, Any]:
    for stream in (color, depth):
        if not stream.times_ns:
            raise Error(f"the bag holds no image of {stream.topic}")
        if stream.info is None:
            raise Error(f"the bag holds no message of {stream.info_topic}, so the camera of {stream.topic} is unknown; record it too")
    world = _world(tree, depth.frame, chosen.world)
    pairs, lines = _pairs(color, depth), []
    used: set[pathlib.Path] = set()
    for i, j in pairs:
        pose = tree.target_from(world, depth.frame, depth.times_ns[j])
        if pose is None:
            continue
        used |= {color.files[i], depth.files[j]}
        lines.append(_pose_line(color.files[i].stem, pose))
        depth.files[j].rename(depth.files[j].with_name(color.files[i].stem + ".png"))
    left_out = len(color.files) - len(lines)
    for file in {*color.files, *depth.files} - used:
        file.unlink()
    if not lines:
        raise Error(
            f"no frame has colour, depth and a pose ({len(pairs)} pairs of images within {MAX_TIME_GAP_S} s); check that images "
            "and poses share one clock"
        )
    (folder / "poses.txt").write_text("".join(lines))
    offset = _color_from_depth(tree, color, depth)
    (folder / "camera.yaml").write_text(_camera_text(color, depth, offset))
    return {
        "source": str(folder),
        "frames": len(lines),
        "left_out": left_out,
        "color": color.topic,
        "depth": depth.topic,
        "world": world,
    }


def _world(tree: TransformTree, frame: str, wanted: str | None) -> str:
    chain = tree.chain(frame)
    if wanted is not None and wanted.lstrip("/") not in chain:
        raise Error(f"the frame '{wanted}' is no ancestor of the camera's '{frame}', whose are {', '.join(chain[1:]) or 'none'}")
    end = chain.index(wanted.lstrip("/")) if wanted is not None else len(chain) - 1
    if all(tree.links[name].static for name in chain[:end]):
        raise Error(
            f"nothing in the bag moves the camera's frame '{frame}' (known: {' -> '.join(chain)}); record /tf and /tf_static, "
            "or odometry, or name a topic of poses"
        )
    return chain[end]


def _pairs(color: Stream, depth: Stream) -> list[tuple[int, int]]:
    """Each colour image with the depth image nearest in time, each of which is used once."""
    best: dict[int, tuple[int, int]] = {}
    for i, time_ns in enumerate(color.times_ns):
        after = bisect.bisect_left(depth.times_ns, time_ns)
        near = [k for k in (after - 1, after) if 0 <= k < len(depth.times_ns)]
        j = min(near, key=lambda k: abs(depth.times_ns[k] - time_ns))
        gap = abs(depth.times_ns[j] - time_ns)
        if gap <= MAX_TIME_GAP_S * 1e9 and gap < best.get(j, (gap + 1, 0))[0]:
            best[j] = (gap, i)
    return sorted((i, j) for j, (_, i) in best.items())


def _pose_line(time: str, pose: Matrix) -> str:
    return " ".join([time, *(repr(float(value)) for value in (*pose[:3, 3], *quaternion_of(pose)))]) + "\n"


def _color_from_depth(tree: TransformTree, color: Stream, depth: Stream) -> Matrix:
    if color.frame == depth.frame:
        return np.eye(4)
    offset = tree.target_from(color.frame, depth.frame, depth.times_ns[0])
    if offset is None:
        raise Error(f"no transform from '{depth.frame}' to '{color.frame}' when the first depth image was taken; record /tf_static")
    return offset


def _camera_text(color: Stream, depth: Stream, offset: Matrix) -> str:
    def camera(stream: Stream, more: str = "") -> str:
        return "{" + ", ".join(f"{name}: {json.dumps(value)}" for name, value in stream.camera.items()) + more + "}"

    turn = ", ".join(repr(float(value)) for value in rotation_vector_of(offset))
    shift = ", ".join(repr(float(value)) for value in offset[:3, 3])
    return (
        f"depth_camera: {camera(depth, f', depth_scale: {depth.units}, invalid: [0, 65535]')}\n"
        f"color_camera: {camera(color)}\n"
        f"color_from_depth: {{rotation_vector: [{turn}], translation: [{shift}]}}\n"
    )


def main(arguments: list[str] | None = None) -> int:
    """The command ovimap-bag."""
    return run_command("ovimap-bag", _parser().parse_args(arguments), extra="bags", packages=("rosbags",))


def _command(options: argparse.Namespace) -> int:
    topics = Topics(options.color, options.depth, options.poses, options.world)
    done = convert(options.bag, options.out, topics=topics)
    print(json.dumps(done) if options.json else f"{done['source']}: {done['frames']} frames, {done['left_out']} left out")
    return DONE


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-bag", description="turns a ROS bag or MCAP file into a folder that ovimap reads")
    parser.add_argument("bag", help="a .bag file, a ROS 2 bag's folder or an .mcap file")
    parser.add_argument("out", help="folder to write")
    parser.add_argument("--color", help="topic of colour images, where there are several")
    parser.add_argument("--depth", help="topic of depth images, where there are several")
    parser.add_argument("--poses", help="topic of odometry or stamped poses of the camera, instead of tf")
    parser.add_argument("--world", help="frame to give poses in; default: the root of the transforms")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(command=_command)
    return parser


if __name__ == "__main__":
    sys.exit(main())
