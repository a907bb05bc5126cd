#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Renders rooms of random things with Blender's Cycles for the entity finder to learn from (tools/models/train_finder.py): recordings
with truth, of views that are far apart. Sizes, parts, surfaces, lights and cameras are drawn anew for each room; of the reported
scene `studio` nothing is shared but Blender and the primitives of furnish.py.

Usage: random_rooms.py OUT [--seeds 1:46] [--frames 8] [--size 400x300] [--samples 8]
README.md beside this file says what to install. A broken-off run goes on with the rooms that are missing."""
import argparse
import math
import pathlib
import random
import tempfile

import bpy
import numpy
from mathutils import Matrix, Vector
from PIL import Image

import render
import truth
from furnish import part_ball, part_box, part_ring, part_round, shader, thing
import furnish

NEAREST = 0.4  # metres in the median: a frame that sees less far was taken inside of something
PATTERNS = [None, None, None, "wood", "brick", "check", "cells", "noise", "waves"]


def surface(chance, like=None):
    """A random surface; one `like` a colour is nearly of it, as white things before a white wall are."""
    color = [min(1, max(0, c * chance.uniform(0.85, 1.1))) for c in like] if like else [chance.uniform(0.02, 0.95) ** 1.7 for _ in range(3)]
    if not like and chance.random() < 0.5:  # much of what people own is grey, white or brown
        color = [min(1, chance.choice([0.05, 0.3, 0.7, 0.9]) * c) for c in chance.choice([(1, 1, 1), (1, 0.9, 0.8), (1, 0.7, 0.45)])]
    second = [min(1, c * chance.choice([0.8, 0.93, 1.1, 0.3])) for c in color] if chance.random() < 0.7 else [chance.uniform(0, 1) for _ in range(3)]
    return shader("any", color, chance.choice([0.1, 0.4, 0.6, 0.9]), chance.choice(PATTERNS), second, math.exp(chance.uniform(0, 5)))


class Room:
    """What stands where: a floor plan of circles that are taken, and the tops on which small things may stand."""

    def __init__(self, chance):
        self.chance = chance
        self.width, self.depth, self.height = chance.uniform(2.8, 7), chance.uniform(2.8, 7), chance.uniform(2.3, 3.1)
        self.color = [chance.uniform(0.5, 0.95)] * 3 if chance.random() < 0.6 else [chance.uniform(0.2, 0.9) for _ in range(3)]
        self.taken, self.tops, self.targets = [], [], []

    def shell(self):
        w, d, h = self.width, self.depth, self.height
        floor = surface(self.chance)
        thing("floor", [part_box((0, 0, -0.1), (w, d, 0), floor)])
        thing("ceiling", [part_box((0, 0, h), (w, d, h + 0.1), surface(self.chance, self.color))])
        for low, high in (((-0.1, 0, 0), (0, d, h)), ((w, 0, 0), (w + 0.1, d, h)), ((0, -0.1, 0), (w, 0, h)), ((0, d, 0), (w, d + 0.1, h))):
            thing("wall", [part_box(low, high, surface(self.chance, self.color))])
        self.tops += [(w / 2, d / 2, 0, w / 2 - 0.3, d / 2 - 0.3, 0.0)]

    def on_walls(self):
        """Pictures, panels, windows with light, doors, boards: flat things that depth hardly tells from the wall."""
        for _ in range(self.chance.randint(2, 10)):
            wall = self.chance.randrange(4)
            length = self.width if wall < 2 else self.depth
            wide, tall = math.exp(self.chance.uniform(-2, 0.4)), math.exp(self.chance.uniform(-2, 0.4))
            if self.chance.random() < 0.2:
                wide, tall, low = self.chance.uniform(0.7, 1), self.chance.uniform(1.9, 2.1), 0.0
            else:
                low = self.chance.uniform(0.3, max(0.31, self.height - tall - 0.2))
            if wide > length - 0.4 or low + tall > self.height:
                continue
            middle, thick = self.chance.uniform(wide / 2, length - wide / 2), self.chance.choice([0.004, 0.015, 0.03, 0.08])
            material = surface(self.chance, self.color if self.chance.random() < 0.3 else None)
            parts = [part_box((-wide / 2, -thick, 0), (wide / 2, 0, tall), material)]
            if self.chance.random() < 0.6:
                inner = surface(self.chance)
                if self.chance.random() < 0.3:
                    inner = shader("light", [self.chance.uniform(0.5, 1) for _ in range(3)], 1, "noise", (1, 1, 1), 3, emission=self.chance.uniform(0.5, 3))
                edge = min(wide, tall) * self.chance.uniform(0.03, 0.2)
                parts.append(part_box((-wide / 2 + edge, -thick - 0.003, edge), (wide / 2 - edge, -thick + 0.001, tall - edge), inner))
            at, turn = {0: ((middle, self.depth, low), 0), 1: ((middle, 0, low), math.pi), 2: ((0, middle, low), math.pi / 2),
                        3: ((self.width, middle, low), -math.pi / 2)}[wall]
            thing("flat", parts, at, turn)
            self.targets.append((*at[:2], low + tall / 2))

    def place_for(self, radius):
        for _ in range(40):
            # Along the walls more often than in the middle.
            x, y = (self.chance.uniform(radius, side - radius) if side > 2 * radius else side / 2 for side in (self.width, self.depth))
            if self.chance.random() < 0.7:
                if self.chance.random() < 0.5:
                    x = self.chance.choice([radius, self.width - radius])
                else:
                    y = self.chance.choice([radius, self.depth - radius])
            if all(math.hypot(x - a, y - b) > radius + r for a, b, r in self.taken):
                self.taken.append((x, y, radius))
                return x, y
        return None

    def furniture(self):
        for _ in range(self.chance.randint(4, 14)):
            wide, deep, tall = self.chance.uniform(0.3, 1.8), self.chance.uniform(0.3, 0.9), self.chance.choice([0.4, 0.75, 0.9, 1.4, 2.0]) * self.chance.uniform(0.8, 1.2)
            place = self.place_for(0.5 * max(wide, deep))
            if place is None:
                continue
            turn = self.chance.choice([0, math.pi / 2, math.pi, -math.pi / 2]) + self.chance.gauss(0, 0.15)
            body = surface(self.chance, self.color if self.chance.random() < 0.3 else None)
            make = self.chance.choice([padded, fronts, legged, boards, stacked])
            parts, tops = make(self.chance, wide, deep, tall, body)
            thing("piece", parts, (*place, 0), turn)
            self.targets.append((*place, tall * 0.6))
            self.tops += [(*place, z, wide / 2 - 0.03, deep / 2 - 0.03, turn) for z in tops]

    def small_things(self):
        for _ in range(self.chance.randint(50, 130)):
            x, y, z, half_x, half_y, turn = self.tops[0] if self.chance.random() < 0.2 else self.chance.choice(self.tops)
            u, v = self.chance.uniform(-half_x, half_x), self.chance.uniform(-half_y, half_y)
            at = (x + u * math.cos(turn) - v * math.sin(turn), y + u * math.sin(turn) + v * math.cos(turn), z)
            size = math.exp(self.chance.uniform(math.log(0.04), math.log(0.3)))
            if z == 0 and self.chance.random() < 0.3:
                size *= 5  # rugs, bags, boxes
            for _ in range(self.chance.choice([1, 1, 1, 2, 4])):  # heaps and stacks
                parts, tall = trinket(self.chance, size)
                thing("small", parts, at, self.chance.uniform(-math.pi, math.pi) if self.chance.random() < 0.5 else turn)
                at = (at[0] + self.chance.gauss(0, 0.1 * size), at[1] + self.chance.gauss(0, 0.1 * size), at[2] + tall)
                size *= self.chance.uniform(0.6, 1)
            self.targets.append(at)

    def light(self):
        for _ in range(self.chance.randint(1, 4)):
            at = [self.chance.uniform(0.2, 0.8) * self.width, self.chance.uniform(0.2, 0.8) * self.depth, self.height * self.chance.uniform(0.7, 0.98)]
            bpy.ops.object.light_add(type=self.chance.choice(["AREA", "AREA", "POINT"]), location=at)
            lamp = bpy.context.object.data
            lamp.energy = self.chance.uniform(15, 120)
            lamp.color = self.chance.choice([(1, 1, 1), (1, 0.8, 0.55), (0.75, 0.87, 1)])
            if lamp.type == "AREA":
                lamp.size = self.chance.uniform(0.2, 2)
        world = bpy.data.worlds.new("world")
        world.use_nodes = True
        world.node_tree.nodes["Background"].inputs["Strength"].default_value = self.chance.uniform(0.1, 0.6)
        bpy.context.scene.world = world

    def camera(self):
        """world_from_camera that looks at something from where nothing stands; of a few that one which has the most things before it."""
        return max((self.any_camera() for _ in range(5)), key=self.in_view)

    def in_view(self, pose):
        camera_from_world = pose.inverted()
        seen = [camera_from_world @ Vector(target) for target in self.targets]
        return sum(max(abs(p.x), abs(p.y)) < 0.5 * p.z and 0.4 < p.z < 3 for p in seen)

    def any_camera(self):
        for _ in range(200):
            target = Vector(self.chance.choice(self.targets))
            away, around = math.exp(self.chance.uniform(math.log(0.6), math.log(4))), self.chance.uniform(-math.pi, math.pi)
            eye = Vector((target.x + away * math.cos(around), target.y + away * math.sin(around), self.chance.uniform(0.9, 1.8)))
            inside = 0.2 < eye.x < self.width - 0.2 and 0.2 < eye.y < self.depth - 0.2
            if inside and all(math.hypot(eye.x - a, eye.y - b) > r for a, b, r in self.taken):
                break
        forward = (target + Vector([self.chance.gauss(0, 0.2) for _ in range(3)]) - eye).normalized()
        right = Matrix.Rotation(self.chance.gauss(0, 0.08), 3, forward) @ forward.cross(Vector((0, 0, 1))).normalized()
        pose = Matrix.Identity(4)
        for row, values in enumerate(zip(right, forward.cross(right), forward, eye)):
            pose[row][:] = values
        return pose


# Each makes parts about the origin, standing on the ground, and says how high the tops lie on which something may stand.

def padded(chance, wide, deep, tall, body):
    """Cushions in rows and layers, all of one thing."""
    tall = min(tall, 1.0)
    parts, seat = [part_box((-wide / 2, -deep / 2, 0.08), (wide / 2, deep / 2, tall * 0.4), body, 0.03)], tall * 0.55
    across = chance.randint(1, 4)
    other = surface(chance) if chance.random() < 0.2 else body
    for i in range(across):
        low, high = -wide / 2 + wide * i / across, -wide / 2 + wide * (i + 1) / across
        parts.append(part_box((low + 0.01, -deep / 2, tall * 0.38), (high - 0.01, deep * 0.25, seat), other, 0.05))
        if chance.random() < 0.8:
            parts.append(part_box((low + 0.01, deep * 0.2, tall * 0.5), (high - 0.01, deep / 2, tall), other, 0.06))
    if chance.random() < 0.6:
        parts += [part_box((s * wide / 2 - 0.08, -deep / 2, 0.08), (s * wide / 2 + 0.08, deep / 2, tall * 0.7), body, 0.06) for s in (-1, 1)]
    return parts, [seat]


def fronts(chance, wide, deep, tall, body):
    """A case with doors or drawers and what one grips them by."""
    parts = [part_box((-wide / 2, -deep / 2, 0), (wide / 2, deep / 2, tall), body, 0.005)]
    face, grip = (body if chance.random() < 0.5 else surface(chance)), surface(chance)
    columns, rows, gap = chance.randint(1, 4), chance.randint(1, 5), chance.uniform(0.003, 0.02)
    for i in range(columns):
        for j in range(rows):
            left, low = -wide / 2 + wide * i / columns, tall * j / rows
            right, high = left + wide / columns, low + tall / rows
            parts.append(part_box((left + gap, -deep / 2 - 0.015, low + gap), (right - gap, -deep / 2, high - gap), face))
            if chance.random() < 0.8:
                parts.append(part_box(((left + right) / 2 - 0.04, -deep / 2 - 0.04, high - 0.06), ((left + right) / 2 + 0.04, -deep / 2 - 0.015, high - 0.045), grip))
    return parts, [tall]


def legged(chance, wide, deep, tall, body):
    """A top on legs or on one foot, at times with a back."""
    tall, legs = min(tall, 1.1), (body if chance.random() < 0.5 else surface(chance))
    round_top = chance.random() < 0.25
    parts = [part_round((0, 0, tall - 0.03), min(wide, deep) / 2, 0.03, body)] if round_top else [part_box((-wide / 2, -deep / 2, tall - 0.04), (wide / 2, deep / 2, tall), body, 0.008)]
    if round_top or chance.random() < 0.2:
        parts += [part_round((0, 0, 0), 0.03, tall - 0.02, legs), part_round((0, 0, 0), min(wide, deep) * 0.3, 0.02, legs)]
    else:
        parts += [part_round((x * (wide / 2 - 0.04), y * (deep / 2 - 0.04), 0), 0.02, tall - 0.02, legs, 0.03) for x in (-1, 1) for y in (-1, 1)]
    if wide < 0.7 and chance.random() < 0.6:
        parts += [part_box((x - 0.015, deep / 2 - 0.04, tall), (x + 0.015, deep / 2 - 0.01, tall + 0.45), legs) for x in numpy.linspace(-wide / 2 + 0.03, wide / 2 - 0.03, chance.randint(2, 6))]
        parts.append(part_box((-wide / 2, deep / 2 - 0.045, tall + 0.4), (wide / 2, deep / 2 - 0.005, tall + 0.5), body))
    return parts, [tall]


def boards(chance, wide, deep, tall, body):
    count = chance.randint(2, 6)
    levels = [0.04 + (tall - 0.06) * i / count for i in range(count + 1)]
    parts = [part_box((-wide / 2, -deep / 2, z), (wide / 2, deep / 2, z + 0.02), body) for z in levels]
    parts += [part_box((s * wide / 2 - 0.01, -deep / 2, 0), (s * wide / 2 + 0.01, deep / 2, tall), body) for s in (-1, 1)]
    if chance.random() < 0.6:
        parts.append(part_box((-wide / 2, deep / 2 - 0.01, 0), (wide / 2, deep / 2, tall), body))
    return parts, [z + 0.02 for z in levels]


def stacked(chance, wide, deep, tall, body):
    """Turned bodies on one another: lamps, vases, plants, bins."""
    parts, z, radius = [], 0.0, min(wide, deep) / 2
    for _ in range(chance.randint(1, 4)):
        high, thin = tall * chance.uniform(0.1, 0.6), radius * chance.choice([0.1, 0.5, 1])
        material = body if chance.random() < 0.6 else surface(chance)
        if chance.random() < 0.3:
            parts.append(part_ball((0, 0, z + high / 2), thin, material, min(2.5, high / 2 / thin)))
        else:
            parts.append(part_round((0, 0, z), thin, high, material, thin * chance.uniform(0.3, 1.3)))
        z += high * 0.97
    return parts, []


def trinket(chance, size):
    """A small thing and its height: flat, boxed, round or of several parts."""
    body, kind = surface(chance), chance.random()
    if kind < 0.4:
        thick, side = chance.choice([0.001, 0.003, 0.008, 0.02]), size * chance.uniform(0.3, 1)
        parts = [part_box((-size / 2, -side / 2, 0), (size / 2, side / 2, thick), body, 0.3 * thick)]
        if chance.random() < 0.5:
            edge, on_top = min(size, side) * chance.uniform(0.05, 0.25), surface(chance)
            rows, columns = chance.choice([(1, 1), (1, 2), (4, 10), (3, 3)])
            for i in range(columns):
                for j in range(rows):
                    x, y = -size / 2 + edge + (size - 2 * edge) * i / columns, -side / 2 + edge + (side - 2 * edge) * j / rows
                    parts.append(part_box((x, y, thick), (x + 0.85 * (size - 2 * edge) / columns, y + 0.85 * (side - 2 * edge) / rows, thick + 0.0015), on_top))
        return parts, thick + 0.002
    if kind < 0.65:
        tall = size * chance.uniform(0.2, 2)
        return [part_box((-size / 2, -size / 2 * chance.uniform(0.3, 1), 0), (size / 2, size / 2 * chance.uniform(0.3, 1), tall), body, chance.choice([0, 0, 0.1 * size]))], tall
    if kind < 0.85:
        tall = size * chance.uniform(0.4, 2.5)
        parts = [part_round((0, 0, 0), size / 3, tall, body, size / 3 * chance.uniform(0.4, 1.3))]
        if chance.random() < 0.5:
            parts.append(part_ring((size / 3, 0, tall / 2), size / 6, size / 30, body, (math.pi / 2, 0, 0)))
        return parts, tall
    parts = [part_ball((chance.gauss(0, size / 3), chance.gauss(0, size / 3), size / 3), size / 3, body, chance.uniform(0.4, 1.2)) for _ in range(chance.randint(1, 3))]
    return parts, size / 2


def make_room(seed):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    furnish.THINGS.clear()
    room = Room(random.Random(seed))
    for step in (room.shell, room.on_walls, room.furniture, room.small_things, room.light):
        step()
    return room


def write_room(seed, folder, arguments):
    room = make_room(seed)
    width, height = (int(side) for side in arguments.size.split("x"))
    scene, camera = render.set_up(width, height)
    focal = width * room.chance.uniform(0.65, 1.0)
    camera.data.lens = focal / width * camera.data.sensor_width
    scene.view_settings.exposure = room.chance.uniform(-1.5, 0.6)
    poses = [room.camera() for _ in range(arguments.frames)]
    for i, pose in enumerate(poses):
        render.set_camera(camera, pose, 10 * i + 1)
    results, noise, frames = folder / "room" / "results", numpy.random.default_rng(seed), []
    results.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        # What stays the same from frame to frame is kept, so first all of the truth, then all pictures.
        for i, pose in enumerate(poses):
            scene.frame_set(10 * i + 1)
            depth, ids = render.render_truth(scene, scratch / "truth.exr")
            if numpy.median(depth) > NEAREST:
                numpy.savez(scratch / f"{i}.npz", depth=depth, ids=ids)
                frames.append((10 * i + 1, numpy.array(pose), scratch / f"{i}.npz"))
        for i, (moment, _, exact) in enumerate(frames):
            with numpy.load(exact) as kept:
                depth, ids = truth.noisy_depth(kept["depth"], focal, noise), kept["ids"]
            Image.fromarray(numpy.rint(depth * render.UNITS).clip(0, 65535).astype(numpy.uint16)).save(results / f"depth{i:06d}.png")
            Image.fromarray(ids).save(results / f"instance{i:06d}.png")
            if not (results / f"frame{i:06d}.jpg").exists():
                scene.frame_set(moment)
                color = render.render_color(scene, scratch / "color.png", arguments.samples)
                Image.fromarray(color).save(results / f"frame{i:06d}.jpg", quality=92)
        middle = (width - 1) / 2, (height - 1) / 2
        truth.write(folder, "room", furnish.THINGS, [(pose, exact) for _, pose, exact in frames], (focal, *middle))
    render.write_way(folder / "room", [pose for _, pose, _ in frames])
    render.write_camera(folder, width, height, focal)
    (folder / "done").touch()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--seeds", default="1:46", help="FIRST:END")
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--size", default="400x300", help="WIDTHxHEIGHT of the frames")
    parser.add_argument("--samples", type=int, default=8)
    arguments = parser.parse_args()
    first, end = (int(number) for number in arguments.seeds.split(":"))
    for seed in range(first, end):
        folder = arguments.out / f"random-{seed}"
        if not (folder / "done").exists():
            write_room(seed, folder, arguments)
            print(f"room {seed}", flush=True)


if __name__ == "__main__":
    main()
