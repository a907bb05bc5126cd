# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the entity finder learns from: rendered frames of the tuned halves of the benchmarks (docs/evaluation.md), of seeds that no
benchmark uses, and of random rooms made in Blender (tools/blender_scene/random_rooms.py), changed anew each time they are looked
at, and where the things in them are."""

import json
import pathlib
import subprocess

import cv2
import numpy as np
from depth_geometry import geometry

INPUT_PX, EMBEDDED_PX, CELL_PX, GRID_PX = 1024, 16, 8, 4  # the network's input; one place of its embedding, of the finder's maps, of masks
LEAST_PX = 40  # fewer pixels of a thing, at half the input's resolution, teach nothing
STRAY_PERCENT = 0.5  # of a thing's pixels at each side its box leaves out
SHORTEST_CELLS = 0.25  # a box's side is no nearer to a cell's middle than this, so that it has a logarithm
ASPECTS = [(1024, 768), (1024, 768), (1024, 768), (1024, 576), (1024, 1024), (768, 1024)]  # of cameras, the usual one thrice
ASKED = 2  # cells of a thing that are asked for its mask
JPEG_QUALITY = 80
NO_DEPTH = 0.1  # share of samples without depth
PER_M = 512  # steps of inverse depth, in frames as they are packed

# Kinds of scenes, seeds, and options that make few frames, far apart. Seeds 109 and 110 are kept back, to choose methods by.
DESKS, ROOMS, PLANS = ["writing-desk", "breakfast-table", "book-shelf"], ["living-room", "bedroom", "kitchen"], ["flat"]
WALK = ["--fps", "1", "--seconds"]
SCENES = [
    (DESKS, [*range(101, 109), *range(111, 141)], [*WALK, "5"]),
    (ROOMS, [*range(101, 109), *range(111, 141)], ["--frames", "5", "--noise", "--size", "640x480"]),
    (["courtyard"], [*range(101, 109), *range(111, 127)], [*WALK, "12"]),
    (PLANS, [*range(101, 109), *range(111, 127)], [*WALK, "12"]),
]


def scene_list():
    """(kind, seed, options), seed by seed, so that a rendering that is broken off holds every kind."""
    every = [(kind, seed, options) for kinds, seeds, options in SCENES for kind in kinds for seed in seeds]
    return sorted(every, key=lambda scene: scene[1])


def render(program: pathlib.Path, folder: pathlib.Path):
    """The recordings of SCENES, unless they are there."""
    for kind, seed, options in scene_list():
        scene = folder / f"{kind}-{seed}"
        if not (scene / "done").exists():
            which = "--plan" if kind in PLANS else "--room"
            subprocess.run([program, "synth", scene, which, kind, "--seed", str(seed), *options], check=True, stdout=subprocess.DEVNULL)
            (scene / "done").touch()


def mean_inverse_depth(depth_m, size):
    """1/m on pixels of `size` = (width, height), each the mean of the valid ones that it covers; 0 where fewer than half are."""
    valid = (depth_m > 0).astype(np.float32)
    inverse = np.divide(1, depth_m, out=np.zeros(depth_m.shape, np.float32), where=depth_m > 0)
    inverse, valid = (cv2.resize(image, size, interpolation=cv2.INTER_AREA) for image in (inverse, valid))
    return np.where(valid >= 0.5, inverse / np.maximum(valid, 0.5), 0)


def packed_frame(frame, camera):
    """JPEG bytes of the picture, PNG bytes of ids and of inverse depth as wide as the grid of masks is."""
    rgb = cv2.imread(str(frame))
    ids, depth = (cv2.imread(str(frame.with_name(frame.stem.replace("frame", name) + ".png")), cv2.IMREAD_UNCHANGED)
                  for name in ("instance", "depth"))  # fmt: skip
    _, numbers = np.unique(np.append(0, ids), return_inverse=True)  # 0, of nothing, stays the first
    width = INPUT_PX // GRID_PX
    inverse = mean_inverse_depth((depth / camera["scale"]).astype(np.float32), (width, width * ids.shape[0] // ids.shape[1]))
    images = (".jpg", rgb), (".png", numbers[1:].reshape(ids.shape).astype(np.uint16)), (".png", np.rint(inverse * PER_M).clip(0, 65535).astype(np.uint16))
    options = {".jpg": [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY], ".png": [cv2.IMWRITE_PNG_COMPRESSION, 9]}
    return [cv2.imencode(extension, image, options[extension])[1] for extension, image in images]


def pack(scenes, file: pathlib.Path):
    """One file of all frames of these recordings, and of each its focal length as a share of its width."""
    parts, focals = [], []
    for scene in scenes:
        camera = json.loads((scene / "cam_params.json").read_text())["camera"]
        for frame in sorted(scene.glob("*/results/frame*.jpg")):
            parts += packed_frame(frame, camera)
            focals.append(camera["fx"] / camera["w"])
    np.savez(file, ends=np.cumsum([len(data) for data in parts]), data=np.concatenate(parts), focals=np.array(focals, np.float32))


def unpack(file):
    """(rgb bytes, ids bytes, inverse depth bytes, focal length) of every frame."""
    with np.load(file) as packed:
        parts = np.split(packed["data"], packed["ends"][:-1])
        return list(zip(parts[0::3], parts[1::3], parts[2::3], packed["focals"]))


def decoded(frame):
    rgb = cv2.cvtColor(cv2.imdecode(frame[0], cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB)
    ids, inverse = (cv2.imdecode(data, cv2.IMREAD_UNCHANGED) for data in frame[1:3])
    return rgb, ids.astype(np.int32), inverse.astype(np.float32) / PER_M


def recoloured(rgb, ids, rng):
    """Some things in another colour: what a thing is made of must not tell where it ends."""
    chosen = rng.random(ids.max() + 1) < 0.4
    gains = np.where(chosen[:, None], np.exp(rng.normal(0, 0.4, (len(chosen), 3)) + rng.normal(0, 0.3, (len(chosen), 1))), 1)
    return np.clip(rgb * gains.astype(np.float32)[ids], 0, 255)


def printed(rgb, ids, print_rgb, rng):
    """Some things with a picture of something else on them, as wallpaper, covers and screens have it."""
    shares = np.where(rng.random(ids.max() + 1) < 0.25, rng.uniform(0.2, 0.9, ids.max() + 1), 0).astype(np.float32)
    zoom = rng.uniform(0.15, 1)
    height, width = (max(8, int(size * zoom)) for size in print_rgb.shape[:2])
    tile = cv2.resize(print_rgb, (width, height), interpolation=cv2.INTER_AREA)
    repeated = np.tile(tile, (-(-ids.shape[0] // height), -(-ids.shape[1] // width), 1))[: ids.shape[0], : ids.shape[1]]
    shading = 0.4 + 0.6 * rgb.mean(2, keepdims=True) / 128
    share = shares[ids][..., None]
    return np.clip(rgb * (1 - share) + repeated * shading * share, 0, 255)


def strewn(rgb, ids, inverse, other_rgb, other_ids, rng):
    """With a few small things of another frame somewhere on top, flat as paper or a little nearer than what is under them."""
    rgb, ids, inverse = rgb.copy(), ids.copy(), inverse.copy()
    numbers, counts = np.unique(other_ids[other_ids > 0], return_counts=True)
    fitting = numbers[(counts > 200) & (counts < 0.08 * ids.size)]
    for number in rng.permutation(fitting)[: rng.integers(1, 6)]:
        ys, xs = np.nonzero(other_ids == number)
        part = np.s_[ys.min() : ys.max() + 1, xs.min() : xs.max() + 1]
        mask, patch = (other_ids[part] == number).astype(np.uint8), other_rgb[part]
        zoom = rng.uniform(0.6, 1.4)
        size = max(4, round(mask.shape[1] * zoom)), max(4, round(mask.shape[0] * zoom))
        if size[0] >= ids.shape[1] or size[1] >= ids.shape[0]:
            continue
        mask, patch = cv2.resize(mask, size, interpolation=cv2.INTER_NEAREST), cv2.resize(patch, size, interpolation=cv2.INTER_LINEAR)
        x, y = rng.integers(0, ids.shape[1] - size[0]), rng.integers(0, ids.shape[0] - size[1])
        place = np.s_[y : y + size[1], x : x + size[0]]
        rgb[place][mask > 0] = patch[mask > 0]
        ids[place][mask > 0] = ids.max() + 1
        if rng.random() < 0.5:
            nearer = cv2.resize((ids == ids.max()).astype(np.uint8), inverse.shape[::-1], interpolation=cv2.INTER_NEAREST)
            inverse[nearer > 0] *= rng.uniform(1.005, 1.1)
    return rgb, ids, inverse


def relit(rgb, rng):
    """Another light, camera and sharpness."""
    image = rgb.astype(np.float32) / 255
    if rng.random() < 0.15:
        image = np.repeat(image.mean(2, keepdims=True), 3, 2)
    image = np.clip(image * rng.uniform(0.85, 1.15, 3).astype(np.float32), 0, 1) ** np.float32(rng.uniform(0.6, 1.6))
    mean = image.mean()
    image = (image - mean) * np.float32(rng.uniform(0.6, 1.3)) + mean + np.float32(rng.uniform(-0.1, 0.1))
    if rng.random() < 0.3:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.5, 1.8))
    if rng.random() < 0.2:
        length = int(rng.integers(3, 12))
        line = cv2.warpAffine(np.eye(1, length, length // 2, dtype=np.float32).repeat(length, 0),
                              cv2.getRotationMatrix2D((length // 2, length // 2), rng.uniform(0, 180), 1), (length, length))  # fmt: skip
        image = cv2.filter2D(image, -1, line / line.sum())
    image = image + rng.standard_normal(image.shape, np.float32) * np.float32(rng.uniform(0, 0.03))
    return (np.clip(image, 0, 1) * 255).astype(np.uint8)


def measured(inverse, ids, rng):
    """Inverse depth as another sensor gives it: shifted against the picture, smooth, noisy, with holes. `ids` are of its size."""
    inverse = inverse.copy()
    if rng.random() < 0.3:
        shift = np.column_stack([np.eye(2), rng.normal(0, 1, 2)])
        inverse = cv2.warpAffine(inverse, shift, inverse.shape[::-1], flags=cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE)
    if rng.random() < 0.3:
        sigma, valid = rng.uniform(0.7, 3), (inverse > 0).astype(np.float32)
        smooth = cv2.GaussianBlur(inverse, (0, 0), sigma) / np.maximum(cv2.GaussianBlur(valid, (0, 0), sigma), 1e-3)
        inverse = np.where((inverse > 0) | (rng.random() < 0.5), smooth, 0)
    if rng.random() < 0.5:
        noise = rng.standard_normal(inverse.shape, np.float32)
        if rng.random() < 0.5:
            noise = cv2.GaussianBlur(noise, (0, 0), 1.5) * 4
        inverse = inverse * (1 + noise * np.float32(rng.uniform(0, 0.01)))
    lost = rng.random(ids.max() + 1) < (0.15 if rng.random() < 0.3 else 0)  # what shines or is black
    lost[ids.max() if rng.random() < 0.5 else 0] = False
    holes = lost[ids]
    if rng.random() < 0.4:
        blobs = cv2.GaussianBlur(rng.standard_normal(inverse.shape, np.float32), (0, 0), rng.uniform(2, 12))
        holes |= blobs > np.quantile(blobs[::4, ::4], rng.uniform(0.7, 1))
    if rng.random() < 0.2:
        holes |= inverse < 1 / rng.uniform(1.5, 4)  # beyond the range
    return np.where(holes, 0, np.maximum(inverse, 0)) * np.float32(np.exp(rng.normal(0, 0.15)))


def view(rng, width, height, size):
    """source_from_network of a view of size = (width, height) of the network's input: a part of the image, turned, mirrored."""
    share = rng.uniform(0.4, 1) if rng.random() < 0.65 else 1.0
    zoom = share * min(width / size[0], height / size[1])
    angle = rng.normal(0, 0.1) if rng.random() < 0.4 else 0.0
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) * zoom
    if rng.random() < 0.5:
        turned[:, 0] *= -1
    room = np.array([width - size[0] * zoom, height - size[1] * zoom]) / 2
    centre = np.array([width, height]) / 2 + rng.uniform(-1, 1, 2) * room
    return np.column_stack([turned, centre - turned @ (np.array(size) / 2)]).astype(np.float64)


def warped(image, source_from_network, size, px, interpolation):
    """The image seen so, in pixels of the network's input px wide; their corners, not their middles, are whole numbers."""
    scaled = source_from_network.copy()
    scaled[:, :2] *= px
    scaled[:, 2] += scaled[:, :2] @ (0.5, 0.5) - 0.5
    return cv2.warpAffine(image, scaled, (size[0] // px, size[1] // px), flags=interpolation | cv2.WARP_INVERSE_MAP)


def things_in(ids):
    """A row for each thing: id, box (x0, y0, x1, y1), pixels; and of each pixel how deep in its thing it lies, from 0 at the border to 1."""
    rows, depth = [], np.zeros(ids.shape, np.float32)
    for number in np.unique(ids[ids > 0]):
        ys, xs = np.nonzero(ids == number)
        if len(xs) < LEAST_PX:
            continue
        ends = STRAY_PERCENT, 100 - STRAY_PERCENT
        (x0, x1), (y0, y1) = np.percentile(xs, ends), np.percentile(ys, ends)
        part = np.s_[ys.min() : ys.max() + 1, xs.min() : xs.max() + 1]
        inside = cv2.distanceTransform(np.pad((ids[part] == number).astype(np.uint8), 1), cv2.DIST_L2, 3)[1:-1, 1:-1]
        np.maximum(depth[part], inside / inside.max(), out=depth[part])
        rows.append((number, x0, y0, x1, y1, len(xs)))
    return np.array(rows, np.float32).reshape(-1, 6), depth


def targets(ids, things, depth, rows, columns):
    """What the finder shall say of rows x columns cells (FinderMaps of thing_cells.h, as values instead of logits), and how much a
    cell counts: all cells of a thing together the root of their number, so that small things are heard. `ids` are at half the
    input's resolution."""
    cell = CELL_PX // 2
    x, y = (np.arange(columns) + 0.5) * cell - 0.5, (np.arange(rows) + 0.5) * cell - 0.5
    column, row = x.astype(int), y.astype(int)
    deepest = cv2.dilate(depth, np.ones((cell, cell), np.uint8))  # near the middle: small things keep their peak
    number, wanted, weight = ids[row][:, column], np.zeros((6, rows, columns), np.float32), np.zeros((rows, columns), np.float32)
    wanted[0] = deepest[row][:, column]
    weight[:] = 0.02  # of no thing
    for thing, x0, y0, x1, y1, pixels in things:
        v, u = np.nonzero(number == thing)
        if not len(v):
            continue
        weight[v, u] = 1 / np.sqrt(len(v))
        for side, distance in enumerate((x[u] - x0, y[v] - y0, x1 - x[u], y1 - y[v]), 1):
            wanted[side][v, u] = np.log(np.maximum(distance / cell, SHORTEST_CELLS))
        wanted[5][v, u] = min(1, pixels / ((x1 - x0 + 1) * (y1 - y0 + 1)))
    return wanted, weight, number


def asked_cells(things, depth_of_cells, number, rng):
    """Rows of (y, x, thing): cells to ask for the mask of their thing, deep ones more often."""
    chosen = []
    for thing in things[:, 0]:
        v, u = np.nonzero(number == thing)
        deep = depth_of_cells[v, u] ** 2
        if not deep.sum():
            continue
        for place in rng.choice(len(v), ASKED, p=deep / deep.sum()):
            chosen.append((v[place], u[place], thing))
    return np.array(chosen, np.int64).reshape(-1, 3)


def sample(frames, size, rng):
    """A changed view of a random frame: rgb of `size`, geometry, targets, weights, cells that are asked, and the things' ids on the
    grid of masks."""
    chosen, other = (frames[i] for i in rng.integers(0, len(frames), 2))
    (rgb, ids, inverse), (other_rgb, other_ids, _) = decoded(chosen), decoded(other)
    if rng.random() < 0.35:
        rgb, ids, inverse = strewn(rgb, ids, inverse, other_rgb, other_ids, rng)
    if rng.random() < 0.4:
        rgb = recoloured(rgb, ids, rng)
    if rng.random() < 0.35:
        rgb = printed(rgb, ids, other_rgb, rng)
    rgb = relit(rgb, rng)
    source_from_network = view(rng, ids.shape[1], ids.shape[0], size)
    flat = ids.astype(np.float32)  # OpenCV warps no 32-bit integers
    half, grid = (warped(flat, source_from_network, size, px, cv2.INTER_NEAREST).astype(np.int32) for px in (2, GRID_PX))
    things, depth = things_in(half)
    wanted, weight, number = targets(half, things, depth, size[1] // CELL_PX, size[0] // CELL_PX)
    image = warped(rgb, source_from_network, size, 1, cv2.INTER_LINEAR)
    shown = geometry(seen_inverse(inverse, ids.shape, source_from_network, size, grid, rng),
                     chosen[3] * ids.shape[1] / np.linalg.norm(source_from_network[:, 0]) / GRID_PX)  # fmt: skip
    return image, shown, wanted, weight, asked_cells(things, wanted[0], number, rng), grid


def seen_inverse(inverse, shape, source_from_network, size, ids, rng):
    """Inverse depth on the grid of masks; at times there is none."""
    if rng.random() < NO_DEPTH:
        return np.zeros(ids.shape, np.float32)
    depth_from_network = source_from_network * (inverse.shape[1] / shape[1])
    known = warped((inverse > 0).astype(np.float32), depth_from_network, size, GRID_PX, cv2.INTER_LINEAR)
    mean = warped(inverse, depth_from_network, size, GRID_PX, cv2.INTER_LINEAR) / np.maximum(known, 0.5)
    return measured(np.where(known >= 0.5, mean, 0), ids, rng)


def batch(groups, size, rng):
    """Samples of one size, stacked, of each group of (frames, count) so many; the asked cells with the number of their sample in front."""
    images, shown, wanted, weights, asked, grids = zip(*(sample(frames, size, rng) for frames, count in groups for _ in range(count)))
    numbered = [np.column_stack([np.full(len(cells), place), cells]) for place, cells in enumerate(asked)]
    return (np.stack(images), np.stack(shown).astype(np.float16), np.stack(wanted).astype(np.float16), np.stack(weights).astype(np.float16),
            np.concatenate(numbered), np.stack(grids).astype(np.int16))  # fmt: skip
