# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What is true of a scene made in Blender, and what a depth camera would have seen of it. Figures of the sensor and of
what is scored are those of `ovimap synth` (src/ovimap/synth/camera/sensor_noise.h, recordings/little_seen.h)."""
import json

import bpy
import numpy

LONGEST_EDGE, MERGE_CELL, LEAVE_SURFACE = 0.025, 0.01, 0.003
LEAST_SIDE, LEAST_AREA, LEAST_PIXELS, LEAST_FRAMES = 0.03, 0.002, 100, 5


def noisy_depth(depth, focal, chance):
    height, width = depth.shape
    rows, columns = numpy.mgrid[0:height, 0:width]
    jitter = numpy.rint(chance.normal(0, 0.5, (2, height, width))).astype(int)
    seen = depth[numpy.clip(rows + jitter[0], 0, height - 1), numpy.clip(columns + jitter[1], 0, width - 1)]
    sigma = 0.0012 + 0.0019 * (seen - 0.4) ** 2
    seen = seen + chance.normal(0, 1, seen.shape) * sigma
    with numpy.errstate(divide="ignore", invalid="ignore"):
        disparity = numpy.rint(43.5 / seen / 0.125) * 0.125
        seen = numpy.where(disparity > 0, 43.5 / disparity, 0)
        # Unit rays times depth give points; the normal of neighbours tells the incidence.
        rays = numpy.dstack([(columns - (width - 1) / 2) / focal, (rows - (height - 1) / 2) / focal, numpy.ones_like(depth)])
        points = rays * depth[..., None]
        normals = numpy.cross(numpy.gradient(points, axis=1), numpy.gradient(points, axis=0))
        cosine = numpy.abs((normals * rays).sum(2)) / (numpy.linalg.norm(normals, axis=2) * numpy.linalg.norm(rays, axis=2))
    edge = numpy.zeros(depth.shape, bool)
    for axis in (0, 1):
        step = numpy.abs(numpy.diff(depth, axis=axis)) > 0.03 * numpy.minimum(numpy.delete(depth, -1, axis), numpy.delete(depth, 0, axis))
        low, high = [slice(None)] * 2, [slice(None)] * 2
        low[axis], high[axis] = slice(0, -1), slice(1, None)
        edge[tuple(low)] |= step
        edge[tuple(high)] |= step
    # Edges have gradients of their own: they are lost as edges, not as slanted surfaces.
    loss = numpy.where(edge, 0.6, numpy.clip((0.3 - cosine) / (0.3 - 0.08), 0.001, 1))
    lost = (chance.uniform(size=depth.shape) < numpy.nan_to_num(loss, nan=1)) | (depth < 0.3) | (depth > 6)
    return numpy.where(lost, 0, seen).astype(numpy.float32)


def refined(points, triangles):
    """Halves edges until none is longer than LONGEST_EDGE."""
    corners = points[triangles]
    done = []
    while len(corners):
        edges = numpy.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
        long = edges.max(1) > LONGEST_EDGE
        done.append(corners[~long])
        corners, edges = corners[long], edges[long]
        turn = (edges.argmax(1)[:, None] + numpy.arange(3)) % 3
        corners = numpy.take_along_axis(corners, turn[:, :, None], 1)
        middle = (corners[:, 0] + corners[:, 1]) / 2
        corners = numpy.concatenate([numpy.stack([corners[:, 0], middle, corners[:, 2]], 1), numpy.stack([middle, corners[:, 1], corners[:, 2]], 1)])
    return numpy.concatenate(done)


def surface(thing):
    """Vertices of one object, those of a cell made one, and its triangles."""
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    mesh.calc_loop_triangles()
    points = numpy.array([thing.matrix_world @ vertex.co for vertex in mesh.vertices])
    corners = refined(points, numpy.array([triangle.vertices for triangle in mesh.loop_triangles])).reshape(-1, 3)
    _, first, index = numpy.unique(numpy.floor(corners / MERGE_CELL).astype(int), axis=0, return_index=True, return_inverse=True)
    triangles = index.reshape(-1, 3)
    proper = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2]) & (triangles[:, 2] != triangles[:, 0])
    return corners[first], triangles[proper]


def see(points, labels, frames, lens):
    """Which vertices a frame sees: where they fall, it has their id at their depth."""
    focal, cx, cy = lens
    seen = numpy.zeros(len(points), bool)
    counts = {}
    for pose, path in frames:
        with numpy.load(path) as kept:
            depth, ids = kept["depth"], kept["ids"]
        for thing, pixels in zip(*numpy.unique(ids, return_counts=True)):
            counts[int(thing)] = counts.get(int(thing), 0) + int(pixels * 640 * 480 >= LEAST_PIXELS * ids.size)
        local = (points - pose[:3, 3]) @ pose[:3, :3]
        z = local[:, 2]
        with numpy.errstate(divide="ignore", invalid="ignore"):
            u, v = numpy.rint(focal * local[:, 0] / z + cx), numpy.rint(focal * local[:, 1] / z + cy)
            inside = (z > 0.05) & (u >= 0) & (v >= 0) & (u < depth.shape[1]) & (v < depth.shape[0])
        at = numpy.flatnonzero(inside)
        column, row = u[at].astype(int), v[at].astype(int)
        # Half a pixel aside a slanted surface differs by more than what merging moved the vertex.
        slack = LEAVE_SURFACE + MERGE_CELL + 1.5 * z[at] / focal
        seen[at] |= (ids[row, column] == labels[at]) & (numpy.abs(depth[row, column] - z[at]) < slack)
    return seen, counts


def write_ply(path, points, triangles):
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
                    f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        file.write(points.astype("<f4").tobytes())
        faces = numpy.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
        faces["count"], faces["corners"] = 3, triangles
        file.write(faces.tobytes())


def write(out, scene, things, frames, lens):
    objects = {thing.pass_index: thing for thing in bpy.data.objects if thing.type == "MESH"}
    points, labels, triangles, start = [], [], [], 0
    for number, _ in things:
        own, faces = surface(objects[number])
        points.append(own)
        labels.append(numpy.full(len(own), number))
        triangles.append(faces + start)
        start += len(own)
    points, labels, triangles = numpy.concatenate(points), numpy.concatenate(labels), numpy.concatenate(triangles)
    seen, counts = see(points, labels, frames, lens)
    triangles = triangles[seen[triangles].all(1)]
    corners = points[triangles]
    area = 0.5 * numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    areas = numpy.bincount(labels[triangles[:, 0]], area, len(things) + 1)
    unscored = [number for number, _ in things if max(objects[number].dimensions) < LEAST_SIDE or areas[number] < LEAST_AREA or counts.get(number, 0) < LEAST_FRAMES]
    index = numpy.cumsum(seen) - 1
    write_ply(out / f"{scene}_mesh.ply", points[seen], index[triangles])
    classes = sorted({name for _, name in things})
    class_of = numpy.array([0] + [classes.index(name) + 1 for _, name in things])
    numpy.savetxt(out / f"instance_labels_{scene}.txt", labels[seen], "%d")
    numpy.savetxt(out / f"semantic_labels_{scene}.txt", class_of[labels[seen]], "%d")
    names = {"instances": {str(number): name for number, name in things}, "classes": {str(i + 1): name for i, name in enumerate(classes)}, "unscored": unscored}
    (out / scene / "labels.json").write_text(json.dumps(names, indent=1) + "\n")
