#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Renders the reported scene `studio` with Blender's Cycles and writes it as a Replica pack with truth (docs/sources.md).

Usage: render.py OUT [--frames 60] [--size 320x240] [--exact] [--samples 8] [--seed 1]
README.md beside this file says what to install. A broken-off run goes on with the frames that are missing."""
import argparse
import json
import math
import pathlib
import tempfile

import bpy
import numpy
import OpenEXR
from mathutils import Matrix, Vector
from PIL import Image

import furnish
import truth

FOCAL = 0.75  # of the width
SHUTTER = 1 / 30  # of the time between two frames, half a second
UNITS = 6553.5  # of depth, a metre
SCENE = "studio"
# Where the camera goes and what it looks at: (eye x, y; target x, y, z), through both rooms and back.
WAY = [(1.2, 1.2, 2.3, 4.4, 0.5), (2.4, 1.5, 2.1, 3.1, 0.4), (3.6, 2.0, 0.7, 2.6, 0.5), (3.9, 3.0, 2.0, 0.2, 0.6), (3.2, 3.9, 2.3, 0.2, 0.5),
       (3.5, 3.0, 0.4, 0.6, 0.7), (3.7, 2.6, 4.8, 4.8, 0.9), (4.2, 3.4, 4.9, 4.8, 1.0), (4.3, 2.4, 5.2, 0.8, 0.8), (4.6, 1.9, 5.3, 0.7, 0.8),
       (5.1, 2.2, 7.0, 2.9, 0.4), (6.0, 2.3, 6.6, 0.6, 0.7), (6.6, 2.2, 6.6, 0.6, 0.7), (7.2, 2.2, 8.6, 1.1, 0.7), (7.6, 1.9, 8.7, 0.9, 0.7),
       (7.5, 1.6, 8.7, 1.5, 0.7), (7.1, 2.3, 8.0, 3.9, 0.5), (6.4, 2.6, 7.8, 4.2, 0.5), (6.3, 3.2, 6.9, 4.7, 0.5), (6.4, 3.4, 6.0, 4.7, 0.9),
       (6.1, 2.8, 5.5, 2.7, 1.0), (5.2, 2.2, 2.1, 4.4, 0.6), (4.3, 2.3, 2.2, 3.1, 0.4), (3.2, 2.2, 1.9, 3.1, 0.4), (2.9, 3.9, 1.2, 4.5, 0.6)]


def curve(points, at):
    """Catmull and Rom's curve through the points, at 0 to len - 1."""
    i = min(int(at), len(points) - 2)
    t = at - i
    a, b, c, d = (numpy.array(points[max(0, min(len(points) - 1, k))]) for k in (i - 1, i, i + 1, i + 2))
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def camera_pose(part):
    """world_from_camera of OpenCV's axes at 0 to 1 of the way, with the sway of hands."""
    eye_x, eye_y, x, y, z = curve(WAY, part * (len(WAY) - 1))
    eye = Vector((eye_x, eye_y, 1.42 + 0.04 * math.sin(37 * part)))
    forward = (Vector((x, y, z)) - eye).normalized()
    right = forward.cross(Vector((0, 0, 1))).normalized()
    roll = 0.03 * math.sin(51 * part)
    right = Matrix.Rotation(roll, 3, forward) @ right
    down = forward.cross(right)
    pose = Matrix.Identity(4)
    for row in range(3):
        pose[row][0], pose[row][1], pose[row][2], pose[row][3] = right[row], down[row], forward[row], eye[row]
    return pose


def set_camera(camera, pose, frame):
    blender_from_opencv = Matrix.Diagonal((1, -1, -1, 1))
    camera.matrix_world = pose @ blender_from_opencv
    for path in ("location", "rotation_euler"):
        camera.keyframe_insert(path, frame=frame)


def set_up(width, height):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.max_bounces, scene.cycles.use_denoising = "CPU", 4, True
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.use_persistent_data = True
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.exposure = 0.1
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_object_index = True
    bpy.ops.object.camera_add()
    camera = bpy.context.object
    camera.rotation_mode = "XYZ"
    camera.data.sensor_width = 36
    camera.data.lens = FOCAL * camera.data.sensor_width
    scene.camera = camera
    return scene, camera


def image_format(scene, name):
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE" if name == "OPEN_EXR_MULTILAYER" else "IMAGE"
    settings.file_format = name


def render_color(scene, path, samples):
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.filter_width = samples, True, 1.5
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, SHUTTER
    image_format(scene, "PNG")
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return numpy.array(Image.open(path).convert("RGB"))


def render_truth(scene, path):
    """Depth along the optical axis and ids of the ray through each pixel's middle."""
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.filter_width = 1, False, 0.01
    scene.render.use_motion_blur = False
    image_format(scene, "OPEN_EXR_MULTILAYER")
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    channels = {name: channel for part in OpenEXR.File(str(path), separate_channels=True).parts for name, channel in part.channels.items()}
    depth, ids = (next(channel.pixels for name, channel in channels.items() if name.endswith(end)) for end in ("Depth.Z", "Object Index.X"))
    return numpy.where(depth < 100, depth, 0).astype(numpy.float32), numpy.rint(ids).astype(numpy.uint16)


def write_frame(results, kept, i, color, focal, arguments):
    with numpy.load(kept / f"{i:06d}.npz") as exact:
        depth, ids = exact["depth"], exact["ids"]
    if not arguments.exact:
        chance = numpy.random.default_rng((arguments.seed, i))
        depth = truth.noisy_depth(depth, focal, chance)
        color = numpy.clip(color * chance.uniform(0.85, 1.15) + chance.normal(0, 2, color.shape), 0, 255).astype(numpy.uint8)
    Image.fromarray(numpy.rint(depth * UNITS).clip(0, 65535).astype(numpy.uint16)).save(results / f"depth{i:06d}.png")
    Image.fromarray(ids).save(results / f"instance{i:06d}.png")
    Image.fromarray(color).save(results / f"frame{i:06d}.jpg", quality=92)


def write_way(folder, poses):
    lines = (" ".join(f"{v:.9g}" for v in numpy.array(pose).reshape(-1)) + "\n" for pose in poses)
    (folder / "traj.txt").write_text("".join(lines))
    (folder / "timestamps.txt").write_text("".join(f"{0.5 * i:.6f}\n" for i in range(len(poses))))


def write_camera(folder, width, height, focal):
    lens = {"w": width, "h": height, "fx": focal, "fy": focal, "cx": (width - 1) / 2, "cy": (height - 1) / 2, "scale": UNITS}
    (folder / "cam_params.json").write_text(json.dumps({"camera": lens}, indent=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--size", default="320x240", help="WIDTHxHEIGHT of the frames")
    parser.add_argument("--samples", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--exact", action="store_true", help="exact depth and sharp colour without noise")
    arguments = parser.parse_args()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    things = furnish.furnish(arguments.seed)
    furnish.light()
    width, height = (int(side) for side in arguments.size.split("x"))
    focal = FOCAL * width
    scene, camera = set_up(width, height)
    results, kept = arguments.out / SCENE / "results", arguments.out / SCENE / "exact"
    results.mkdir(parents=True, exist_ok=True)
    kept.mkdir(exist_ok=True)
    poses = [camera_pose(i / (arguments.frames - 1)) for i in range(arguments.frames)]
    for i, pose in enumerate(poses):
        set_camera(camera, pose, i + 1)
    # What stays the same from frame to frame is kept, so first all of the truth, then all pictures.
    with tempfile.TemporaryDirectory() as scratch:
        for i in range(arguments.frames):
            if not (kept / f"{i:06d}.npz").exists():
                scene.frame_set(i + 1)
                depth, ids = render_truth(scene, pathlib.Path(scratch) / "truth.exr")
                numpy.savez_compressed(kept / f"{i:06d}.npz", depth=depth, ids=ids)
        for i in range(arguments.frames):
            if not (results / f"frame{i:06d}.jpg").exists():
                scene.frame_set(i + 1)
                color = render_color(scene, pathlib.Path(scratch) / "color.png", arguments.samples)
                write_frame(results, kept, i, color, focal, arguments)
                print(f"frame {i + 1} of {arguments.frames}", flush=True)
    write_way(arguments.out / SCENE, poses)
    write_camera(arguments.out, width, height, focal)
    frames = [(matrix, kept / f"{i:06d}.npz") for i, matrix in enumerate(map(numpy.array, poses))]
    truth.write(arguments.out, SCENE, things, frames, (focal, (width - 1) / 2, (height - 1) / 2))


if __name__ == "__main__":
    main()
