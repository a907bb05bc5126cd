# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A furnished studio flat made in Blender: two rooms with an opening between them. Every thing is one Blender object with
a pass index, its id; parts are joined. Nothing here is shared with `ovimap synth`: shapes are Blender's primitives under
its modifiers, surfaces its procedural shaders."""
import math
import random

import bpy

THINGS = []  # (id, class name), in the order of their ids
HEIGHT = 2.6


def shader(name, color, rough=0.6, pattern=None, second=None, scale=8.0, emission=0.0):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = rough
    surface.inputs["Base Color"].default_value = (*color, 1)
    if pattern:
        texture = nodes.new({"wood": "ShaderNodeTexWave", "brick": "ShaderNodeTexBrick", "check": "ShaderNodeTexChecker",
                             "cells": "ShaderNodeTexVoronoi", "noise": "ShaderNodeTexNoise", "waves": "ShaderNodeTexMagic"}[pattern])
        texture.inputs["Scale"].default_value = scale
        place = nodes.new("ShaderNodeTexCoord")
        links.new(place.outputs["Object"], texture.inputs["Vector"])
        if pattern == "wood":
            texture.inputs["Distortion"].default_value = 6
        if pattern == "brick":
            for socket, tint in (("Color1", color), ("Color2", second), ("Mortar", [0.5 * c for c in color])):
                texture.inputs[socket].default_value = (*tint, 1)
            texture.inputs["Mortar Size"].default_value = 0.008
            links.new(texture.outputs["Color"], surface.inputs["Base Color"])
        else:
            ramp = nodes.new("ShaderNodeValToRGB")
            ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (*color, 1), (*second, 1)
            out = texture.outputs.get("Fac") or texture.outputs.get("Distance") or texture.outputs[0]
            links.new(out, ramp.inputs["Fac"])
            links.new(ramp.outputs["Color"], surface.inputs["Base Color"])
    if emission:
        source = surface.inputs["Base Color"].links
        if source:
            links.new(source[0].from_socket, surface.inputs["Emission Color"])
        else:
            surface.inputs["Emission Color"].default_value = (*color, 1)
        surface.inputs["Emission Strength"].default_value = emission
    return material


def tint(chance, low=0.05, high=0.9):
    return [chance.uniform(low, high) for _ in range(3)]


def part_box(low, high, material, bevel=0.0, turn=0.0):
    bpy.ops.mesh.primitive_cube_add(size=1, location=[(a + b) / 2 for a, b in zip(low, high)])
    made = bpy.context.object
    made.scale = [b - a for a, b in zip(low, high)]
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    made.rotation_euler[2] = turn
    if bevel:
        soft = made.modifiers.new("bevel", "BEVEL")
        soft.width, soft.segments = bevel, 4
    return finish(made, material, smooth=bevel > 0)


def part_round(center, radius, height, material, top=None, vertices=32):
    bpy.ops.mesh.primitive_cone_add(vertices=vertices, radius1=radius, radius2=radius if top is None else top, depth=height,
                                    location=(center[0], center[1], center[2] + height / 2))
    return finish(bpy.context.object, material, smooth=True)


def part_ball(center, radius, material, squash=1.0):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=14, radius=radius, location=center)
    bpy.context.object.scale[2] = squash
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    return finish(bpy.context.object, material, smooth=True)


def part_ring(center, radius, thick, material, turn=(0, 0, 0)):
    bpy.ops.mesh.primitive_torus_add(major_radius=radius, minor_radius=thick, location=center, rotation=turn)
    return finish(bpy.context.object, material, smooth=True)


def finish(made, material, smooth):
    made.data.materials.append(material)
    if smooth:
        for face in made.data.polygons:
            face.use_smooth = True
    for modifier in list(made.modifiers):
        bpy.ops.object.modifier_apply(modifier=modifier.name)
    return made


def thing(class_name, parts, at=(0, 0, 0), turn=0.0):
    """Parts, made about the origin, become one object with the next id."""
    bpy.ops.object.select_all(action="DESELECT")
    for part in parts:
        part.select_set(True)
    bpy.context.view_layer.objects.active = parts[0]
    if len(parts) > 1:
        bpy.ops.object.join()
    made = bpy.context.object
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    made.location, made.rotation_euler[2] = at, turn
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    THINGS.append((len(THINGS) + 1, class_name))
    made.pass_index = len(THINGS)
    made.name = f"{class_name} {made.pass_index}"
    return made


# ------------------------------------------------------------------------------------------------------ the shell

def walls(chance):
    plaster = [shader("wall", (0.82, 0.81, 0.78), 0.9, "noise", (0.78, 0.77, 0.74), 60) for _ in range(4)]
    floor = shader("boards", (0.45, 0.29, 0.17), 0.4, "brick", (0.36, 0.22, 0.12), 1.6)
    tile = shader("tile", (0.62, 0.62, 0.6), 0.3, "check", (0.5, 0.5, 0.5), 2.5)
    thing("floor", [part_box((0, 0, -0.1), (5.4, 5, 0), floor)])
    thing("floor", [part_box((5.5, 0, -0.1), (9, 5, 0), tile), part_box((5.4, 1.6, -0.1), (5.5, 2.8, 0), tile)])
    thing("ceiling", [part_box((0, 0, HEIGHT), (9, 5, HEIGHT + 0.1), plaster[0])])
    thing("wall", [part_box((-0.1, 0, 0), (0, 5, HEIGHT), plaster[0])])
    # Two windows in the south wall.
    thing("wall", [part_box(low, high, plaster[1]) for low, high in (
        ((0, -0.1, 0), (1.2, 0, HEIGHT)), ((1.2, -0.1, 0), (3, 0, 0.9)), ((1.2, -0.1, 2.2), (3, 0, HEIGHT)), ((3, -0.1, 0), (6.4, 0, HEIGHT)),
        ((6.4, -0.1, 0), (7.8, 0, 0.9)), ((6.4, -0.1, 2.2), (7.8, 0, HEIGHT)), ((7.8, -0.1, 0), (9, 0, HEIGHT)))])
    thing("wall", [part_box((9, 0, 0), (9.1, 5, HEIGHT), plaster[2])])
    thing("wall", [part_box((0, 5, 0), (9, 5.1, HEIGHT), plaster[3])])
    thing("wall", [part_box((5.4, 0, 0), (5.5, 1.6, HEIGHT), plaster[0]), part_box((5.4, 2.8, 0), (5.5, 5, HEIGHT), plaster[0]),
                   part_box((5.4, 1.6, 2.1), (5.5, 2.8, HEIGHT), plaster[0])])
    white = shader("frame", (0.85, 0.85, 0.83), 0.4)
    sky = shader("sky", (0.55, 0.72, 0.95), 1, "noise", (0.95, 0.97, 1), 1.5, emission=2.5)
    for left, right in ((1.2, 3.0), (6.4, 7.8)):
        bars = [part_box((left, -0.08, 0.9), (left + 0.06, -0.02, 2.2), white), part_box((right - 0.06, -0.08, 0.9), (right, -0.02, 2.2), white),
                part_box((left, -0.08, 0.9), (right, 0.04, 0.95), white), part_box((left, -0.08, 2.14), (right, -0.02, 2.2), white),
                part_box(((left + right) / 2 - 0.03, -0.08, 0.9), ((left + right) / 2 + 0.03, -0.02, 2.2), white),
                part_box((left, -0.1, 0.9), (right, -0.09, 2.2), sky)]
        thing("window", bars)
    oak = shader("door", (0.55, 0.38, 0.22), 0.5, "wood", (0.45, 0.3, 0.17), 3)
    thing("door", [part_box((0, -0.02, 0.01), (0.95, 0.02, 2.05), oak), part_box((0.85, -0.06, 1.0), (0.93, 0.06, 1.03), white)], (5.53, 2.78, 0), 0.35)


# ------------------------------------------------------------------------------------------------- large furniture

def sofa(chance, at, turn, width, color):
    cloth = shader("sofa", color, 0.95, "noise", [0.93 * c for c in color], 300)
    leg = shader("leg", (0.1, 0.07, 0.05))
    half = width / 2
    parts = [part_box((-half, -0.45, 0.12), (half, 0.45, 0.3), cloth, 0.04), part_box((-half, 0.2, 0.12), (half, 0.45, 0.75), cloth, 0.08)]
    parts += [part_box((side * half - 0.11, -0.45, 0.12), (side * half + 0.11, 0.45, 0.58), cloth, 0.09) for side in (-1, 1)]
    count = max(1, round(width / 0.75))
    for i in range(count):
        left = -half + 0.12 + (width - 0.24) * i / count
        right = -half + 0.12 + (width - 0.24) * (i + 1) / count
        parts.append(part_box((left + 0.01, -0.48, 0.29), (right - 0.01, 0.22, 0.46), cloth, 0.06))
        back = part_box((left + 0.02, 0.02, 0.45), (right - 0.02, 0.22, 0.88), cloth, 0.09)
        parts.append(back)
    parts += [part_round((x * (half - 0.1), y * 0.35, 0), 0.02, 0.13, leg) for x in (-1, 1) for y in (-1, 1)]
    thing("sofa" if width > 1.2 else "armchair", parts, at, turn)


def table(name, at, turn, width, depth, height, wood, round_legs):
    parts = [part_box((-width / 2, -depth / 2, height - 0.03), (width / 2, depth / 2, height), wood, 0.01)]
    for x in (-1, 1):
        for y in (-1, 1):
            place = (x * (width / 2 - 0.06), y * (depth / 2 - 0.06), 0)
            parts.append(part_round(place, 0.018, height - 0.03, wood, 0.03) if round_legs else
                         part_box((place[0] - 0.025, place[1] - 0.025, 0), (place[0] + 0.025, place[1] + 0.025, height - 0.03), wood))
    thing(name, parts, at, turn)


def chair(at, turn, wood, seat):
    parts = [part_box((-0.21, -0.21, 0.43), (0.21, 0.21, 0.47), seat, 0.02)]
    parts += [part_round((x * 0.18, y * 0.18, 0), 0.014, 0.44, wood, 0.02) for x in (-1, 1) for y in (-1, 1)]
    parts += [part_round((x * 0.19, 0.2, 0.45), 0.015, 0.45, wood) for x in (-1, -0.35, 0.35, 1)]
    parts.append(part_box((-0.22, 0.18, 0.82), (0.22, 0.22, 0.92), wood, 0.02))
    thing("chair", parts, at, turn)


def case(name, at, turn, width, depth, height, columns, rows, body, face, grip):
    parts = [part_box((-width / 2, -depth / 2, 0.06), (width / 2, depth / 2, height), body, 0.006)]
    for i in range(columns):
        for j in range(rows):
            left, low = -width / 2 + width * i / columns, 0.06 + (height - 0.08) * j / rows
            right, high = left + width / columns, low + (height - 0.08) / rows
            parts.append(part_box((left + 0.006, -depth / 2 - 0.018, low + 0.006), (right - 0.006, -depth / 2, high - 0.006), face, 0.004))
            parts.append(part_ball(((left + right) / 2, -depth / 2 - 0.03, (low + high) / 2), 0.014, grip))
    thing(name, parts, at, turn)


def shelf(at, turn, width, height, rows, wood, chance):
    boards = [part_box((-width / 2, -0.15, z), (width / 2, 0.15, z + 0.022), wood) for z in [0.05 + (height - 0.1) * i / rows for i in range(rows + 1)]]
    sides = [part_box((s * width / 2 - 0.011, -0.15, 0), (s * width / 2 + 0.011, 0.15, height), wood) for s in (-1, 1)]
    thing("bookshelf", boards + sides + [part_box((-width / 2, 0.14, 0), (width / 2, 0.15, height), wood)], at, turn)
    for i in range(rows):
        low, x = 0.072 + (height - 0.1) * i / rows, -width / 2 + 0.03
        while x < width / 2 - 0.12:
            if chance.random() < 0.12:
                x += chance.uniform(0.08, 0.25)
                continue
            thick, tall, deep = chance.uniform(0.018, 0.05), chance.uniform(0.17, 0.27), chance.uniform(0.13, 0.2)
            local = (x + thick / 2, 0.05 - chance.uniform(0, 0.04))
            place = (at[0] + local[0] * math.cos(turn) - local[1] * math.sin(turn), at[1] + local[0] * math.sin(turn) + local[1] * math.cos(turn), low + 0.001)
            cover = shader("spine", tint(chance), 0.5, "check" if chance.random() < 0.3 else None, tint(chance), chance.uniform(8, 30))
            thing("book", [part_box((-thick / 2, -deep / 2, 0), (thick / 2, deep / 2, tall), cover, 0.002)], place, turn)
            x += thick + 0.002


def bed(at, turn, chance):
    wood = shader("bedstead", (0.5, 0.36, 0.24), 0.5, "wood", (0.4, 0.28, 0.18), 4)
    linen, quilt = shader("linen", (0.85, 0.84, 0.82), 0.9), shader("quilt", (0.6, 0.63, 0.68), 0.95, "waves", (0.72, 0.74, 0.76), 3)
    parts = [part_box((-0.8, -1, 0.12), (0.8, 1, 0.3), wood, 0.01), part_box((-0.82, 1, 0), (0.82, 1.06, 1.05), wood, 0.03),
             part_box((-0.78, -0.98, 0.3), (0.78, 0.98, 0.5), linen, 0.06), part_box((-0.84, -1.03, 0.36), (0.84, 0.35, 0.56), quilt, 0.05)]
    parts += [part_box((s * 0.4 - 0.33, 0.5, 0.48), (s * 0.4 + 0.33, 0.93, 0.64), linen, 0.075) for s in (-1, 1)]
    thing("bed", parts, at, turn)


# --------------------------------------------------------------------------------------------------- small things

def lamp(at, height, chance):
    stand = shader("stand", (0.12, 0.12, 0.12), 0.3)
    glow = shader("shade", (1, 0.86, 0.65), 0.9, emission=3)
    thing("floor lamp" if height > 1 else "lamp", [part_round((0, 0, 0), 0.13 if height > 1 else 0.07, 0.025, stand), part_round((0, 0, 0.02), 0.012, height - 0.2, stand),
          part_round((0, 0, height - 0.25), 0.19 if height > 1 else 0.12, 0.25 if height > 1 else 0.16, glow, 0.12 if height > 1 else 0.07)], at)


def picture(at, turn, width, height, chance, lean=0.0):
    frame = shader("frame", tint(chance, 0.02, 0.3), 0.4)
    shown = shader("print", tint(chance), 0.7, chance.choice(["cells", "waves", "noise", "wood"]), tint(chance), chance.uniform(2, 9))
    made = [part_box((-width / 2, -0.015, 0), (width / 2, 0.015, height), frame, 0.004), part_box((-width / 2 + 0.025, -0.018, 0.025), (width / 2 - 0.025, -0.014, height - 0.025), shown)]
    for part in made:
        part.rotation_euler[0] = -lean
        x, y, z = part.location
        part.location = (x, z * math.sin(lean) + y * math.cos(lean), z * math.cos(lean) - y * math.sin(lean))
    thing("picture", made, at, turn)


def plant(at, height, chance):
    pot, leaf = shader("pot", tint(chance, 0.3, 0.7), 0.5), shader("leaf", (0.06, 0.22, 0.05), 0.5, "noise", (0.12, 0.35, 0.08), 20)
    parts = [part_round((0, 0, 0), 0.1 * height + 0.02, 0.2 * height + 0.06, pot, 0.13 * height + 0.03)]
    for i in range(14):
        angle, reach, z = i * 2.4, chance.uniform(0.08, 0.3) * height, chance.uniform(0.35, 1) * height
        parts.append(part_ball((reach * math.cos(angle), reach * math.sin(angle), z), 0.09 * height, leaf, 0.25))
    parts.append(part_round((0, 0, 0.15 * height), 0.008 + 0.01 * height, 0.7 * height, leaf))
    thing("plant" if height > 0.6 else "potted plant", parts, at, chance.uniform(0, 6))


def tabletop(kind, at, turn, chance):
    color = tint(chance)
    gloss = shader(kind, color, 0.25)
    if kind == "mug":
        thing(kind, [part_round((0, 0, 0), 0.038, 0.09, gloss), part_ring((0.045, 0, 0.045), 0.026, 0.006, gloss, (math.pi / 2, 0, 0))], at, turn)
    elif kind == "bowl":
        thing(kind, [part_round((0, 0, 0), 0.05, 0.06, gloss, 0.11)] + [part_ball((0.04 * math.cos(i * 2.1), 0.04 * math.sin(i * 2.1), 0.075), 0.035, shader("fruit", (0.8, chance.uniform(0.1, 0.7), 0.05), 0.4)) for i in range(3)], at, turn)
    elif kind == "bottle":
        thing(kind, [part_round((0, 0, 0), 0.036, 0.17, gloss), part_round((0, 0, 0.17), 0.036, 0.05, gloss, 0.014), part_round((0, 0, 0.22), 0.014, 0.06, gloss)], at, turn)
    elif kind == "plate":
        thing(kind, [part_round((0, 0, 0), 0.07, 0.015, shader("plate", (0.85, 0.85, 0.83), 0.2), 0.12)], at, turn)
    elif kind == "vase":
        thing(kind, [part_round((0, 0, 0), 0.04, 0.12, gloss, 0.07), part_round((0, 0, 0.12), 0.07, 0.1, gloss, 0.03)], at, turn)
    elif kind in ("book", "magazine", "paper", "notebook"):
        sides = {"book": (0.15, 0.22, chance.uniform(0.015, 0.04)), "magazine": (0.21, 0.28, 0.006), "paper": (0.21, 0.297, 0.002), "notebook": (0.15, 0.21, 0.012)}[kind]
        face = shader(kind, (0.85, 0.85, 0.82), 0.8, "brick", (0.75, 0.75, 0.73), 30) if kind == "paper" else shader(kind, color, 0.5, chance.choice(["waves", "cells", None]), tint(chance), 10)
        thing(kind, [part_box((-sides[0] / 2, -sides[1] / 2, 0), (sides[0] / 2, sides[1] / 2, sides[2]), face, 0.001)], at, turn)
    elif kind == "phone":
        thing("cell phone", [part_box((-0.036, -0.075, 0), (0.036, 0.075, 0.009), shader("phone", (0.02, 0.02, 0.025), 0.1), 0.004)], at, turn)
    elif kind == "remote control":
        thing(kind, [part_box((-0.023, -0.09, 0), (0.023, 0.09, 0.018), shader("remote", (0.03, 0.03, 0.03), 0.4), 0.006)] + [part_round((0.01 * (i % 3 - 1), -0.06 + 0.025 * (i // 3), 0.017), 0.004, 0.003, shader("key", (0.6, 0.6, 0.6))) for i in range(12)], at, turn)
    elif kind == "keyboard":
        dark, key = shader("board", (0.04, 0.04, 0.045), 0.5), shader("keys", (0.12, 0.12, 0.13), 0.5)
        thing(kind, [part_box((-0.21, -0.065, 0), (0.21, 0.065, 0.014), dark, 0.004)] + [part_box((-0.2 + 0.027 * i, -0.056 + 0.023 * j, 0.013), (-0.178 + 0.027 * i, -0.037 + 0.023 * j, 0.02), key) for i in range(15) for j in range(5)], at, turn)
    elif kind == "mouse":
        thing("computer mouse", [part_ball((0, 0, 0.0), 0.034, shader("mouse", (0.05, 0.05, 0.05), 0.4), 0.9)], at, turn)
    elif kind == "pen":
        made = part_round((0, 0, -0.07), 0.005, 0.14, gloss, vertices=10)
        made.rotation_euler[0] = math.pi / 2
        made.location = (0, 0, 0.005)
        thing(kind, [made], at, turn)
    elif kind == "box":
        size = chance.uniform(0.06, 0.14)
        thing(kind, [part_box((-size, -size * 0.7, 0), (size, size * 0.7, size), gloss, 0.003)], at, turn)
    elif kind == "pan":
        dark = shader("pan", (0.05, 0.05, 0.05), 0.4)
        thing("pot", [part_round((0, 0, 0), 0.11, 0.05, dark, 0.13), part_box((0.11, -0.012, 0.035), (0.3, 0.012, 0.05), dark, 0.005)], at, turn)
    else:
        raise ValueError(kind)


def strew(kinds, low, high, z, count, chance):
    """Things side by side on a level rectangle: no two nearer than their radii."""
    reach = {"paper": 0.17, "magazine": 0.16, "book": 0.12, "notebook": 0.12, "keyboard": 0.2, "pan": 0.2, "bowl": 0.11, "plate": 0.12, "pen": 0.06}
    placed = []
    for _ in range(count):
        kind = chance.choice(kinds)
        radius = reach.get(kind, 0.07)
        for _ in range(60):
            x, y = chance.uniform(low[0] + 0.8 * radius, high[0] - 0.8 * radius), chance.uniform(low[1] + 0.8 * radius, high[1] - 0.8 * radius)
            if all(math.hypot(x - a, y - b) > 0.95 * (radius + r) for a, b, r in placed):
                placed.append((x, y, radius))
                tabletop(kind, (x, y, z + 0.001), chance.uniform(0, 6.3), chance)
                break


# ---------------------------------------------------------------------------------------------------- the whole flat

def furnish(seed):
    chance = random.Random(seed)
    walls(chance)
    walnut = shader("walnut", (0.3, 0.18, 0.1), 0.4, "wood", (0.22, 0.13, 0.07), 3)
    birch = shader("birch", (0.68, 0.55, 0.4), 0.5, "wood", (0.6, 0.47, 0.33), 2)
    white, grip = shader("white", (0.82, 0.82, 0.8), 0.3), shader("grip", (0.25, 0.25, 0.26), 0.2)
    grey = shader("seat", (0.45, 0.46, 0.48), 0.9)
    sofa(chance, (2.1, 4.45, 0), 0, 2.2, (0.78, 0.76, 0.72))
    sofa(chance, (0.65, 2.6, 0), math.pi / 2, 0.95, (0.7, 0.71, 0.68))
    table("coffee table", (2.1, 3.1, 0), 0.05, 1.1, 0.6, 0.42, walnut, True)
    thing("rug", [part_box((0.8, 2.2, 0.0005), (3.5, 3.9, 0.012), shader("rug", (0.45, 0.16, 0.13), 1, "cells", (0.68, 0.56, 0.42), 4))])
    case("tv stand", (2.3, 0.26, 0), math.pi, 1.7, 0.42, 0.5, 3, 1, white, white, grip)
    screen = shader("screen", (0.1, 0.25, 0.5), 0.2, "waves", (0.8, 0.6, 0.3), 4, emission=0.8)
    dark = shader("bezel", (0.02, 0.02, 0.02), 0.3)
    thing("tv", [part_box((-0.6, -0.02, 0.06), (0.6, 0.02, 0.76), dark, 0.005), part_box((-0.585, -0.022, 0.075), (0.585, -0.019, 0.745), screen), part_box((-0.2, -0.1, 0), (0.2, 0.1, 0.015), dark), part_box((-0.03, -0.01, 0.01), (0.03, 0.01, 0.08), dark)], (2.3, 0.25, 0.501), math.pi)
    shelf((4.75, 4.82, 0), 0, 1.1, 1.9, 5, birch, chance)
    case("cabinet", (5.14, 0.8, 0), -math.pi / 2, 1.1, 0.42, 0.85, 2, 3, birch, birch, grip)
    lamp((3.75, 4.6, 0), 1.55, chance)
    lamp((5.15, 1.1, 0.851), 0.45, chance)
    plant((0.4, 0.5, 0), 1.25, chance)
    plant((5.1, 0.5, 0.851), 0.4, chance)
    for x, width, height in ((0.9, 0.5, 0.7), (1.7, 0.75, 0.5), (2.7, 0.4, 0.4)):
        picture((x, 4.97, 1.35), 0, width, height, chance)
    picture((0.02, 1.3, 1.3), math.pi / 2, 0.7, 0.9, chance)
    picture((5.36, 3.6, 0.01), -math.pi / 2, 0.5, 0.7, chance, 0.15)
    for i, x in enumerate((1.2, 1.7, 2.9)):
        pillow = shader("pillow", tint(chance, 0.3, 0.9), 0.95, chance.choice(["check", "waves", None]), tint(chance, 0.3, 0.9), 6)
        thing("pillow", [part_box((-0.22, -0.07, 0), (0.22, 0.07, 0.4), pillow, 0.06)], (x, 4.36, 0.47), chance.uniform(-0.3, 0.3))
    strew(["book", "magazine", "mug", "remote control", "bowl", "phone", "box"], (1.6, 2.82), (2.6, 3.38), 0.42, 9, chance)
    strew(["vase", "box", "book"], (1.5, 0.12), (1.66, 0.4), 0.5, 1, chance)
    strew(["remote control", "book", "phone"], (2.95, 0.1), (3.12, 0.42), 0.5, 2, chance)
    strew(["box", "vase", "mug", "book"], (4.98, 0.6), (5.3, 1.0), 0.85, 3, chance)
    # The second room: a bed, a desk, a kitchenette.
    bed((8.0, 3.9, 0), 0, chance)
    case("nightstand", (6.85, 4.72, 0), 0, 0.45, 0.4, 0.5, 1, 2, walnut, walnut, grip)
    strew(["book", "phone", "mug"], (6.66, 4.56), (7.04, 4.88), 0.5, 3, chance)
    table("desk", (8.6, 1.1, 0), -math.pi / 2, 1.4, 0.7, 0.74, birch, False)
    chair((8.0, 1.1, 0), math.pi / 2 + 0.2, walnut, grey)
    thing("monitor", [part_box((-0.3, -0.015, 0.12), (0.3, 0.015, 0.48), dark, 0.004), part_box((-0.288, -0.018, 0.132), (0.288, -0.014, 0.468), shader("desktop", (0.75, 0.78, 0.8), 0.3, "brick", (0.3, 0.45, 0.6), 14, emission=0.7)), part_round((0, 0.02, 0), 0.11, 0.012, dark), part_round((0, 0.02, 0.01), 0.018, 0.2, dark)], (8.82, 1.1, 0.741), -math.pi / 2)
    strew(["keyboard"], (8.3, 0.9), (8.6, 1.35), 0.74, 1, chance)
    strew(["paper", "notebook", "pen", "mouse", "mug", "book", "phone"], (8.3, 0.45), (8.9, 0.85), 0.74, 7, chance)
    strew(["paper", "pen", "book", "remote control"], (8.3, 1.4), (8.9, 1.75), 0.74, 4, chance)
    case("kitchen cabinet", (6.0, 4.66, 0), 0, 0.9, 0.6, 0.9, 2, 1, white, white, grip)
    strew(["bottle", "bowl", "pan", "plate", "mug"], (5.6, 4.42), (6.4, 4.92), 0.9, 5, chance)
    table("table", (6.6, 0.62, 0), 0, 1.2, 0.75, 0.75, walnut, True)
    chair((6.3, 1.3, 0), 0.1, walnut, grey)
    chair((7.0, 1.32, 0), -0.15, walnut, grey)
    strew(["plate", "bowl", "bottle", "mug", "magazine"], (6.05, 0.3), (7.15, 0.95), 0.75, 8, chance)
    steel, rubber = shader("steel", (0.5, 0.5, 0.52), 0.25), shader("rubber", (0.03, 0.03, 0.03), 0.8)
    discs = [part_ring((x, 0, 0.08), 0.055, 0.025, rubber, (0, math.pi / 2, 0)) for x in (-0.17, 0.17)]
    bar = part_round((0, 0, -0.17), 0.012, 0.34, steel)
    bar.rotation_euler[1], bar.location = math.pi / 2, (0, 0, 0.08)
    thing("barbell", discs + [bar], (7.0, 2.9, 0), 0.6)
    lamp((6.75, 4.75, 0.501), 0.4, chance)
    picture((8.98, 2.6, 1.4), -math.pi / 2, 0.6, 0.45, chance)
    picture((7.9, 4.97, 1.5), 0, 0.9, 0.5, chance)
    return THINGS


def light():
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.7, 0.8, 1, 1)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.4
    for place, size, power, color in (((2.4, 2.6, 2.55), 0.8, 45, (1, 0.93, 0.82)), ((7.3, 2.6, 2.55), 0.6, 40, (1, 0.93, 0.82)),
                                      ((2.1, 0.06, 1.6), 1.4, 50, (0.85, 0.93, 1)), ((7.1, 0.06, 1.6), 1.2, 35, (0.85, 0.93, 1))):
        bpy.ops.object.light_add(type="AREA", location=place)
        lamp_object = bpy.context.object
        lamp_object.data.size, lamp_object.data.energy, lamp_object.data.color = size, power, color
        if place[2] < 2:
            lamp_object.rotation_euler = (math.pi / 2, 0, 0)
            lamp_object.rotation_euler[0] = -math.pi / 2 if place[1] > 2 else math.pi / 2
