# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a map as docs/map-format.md describes it, with the packages numpy, zstandard and xxhash alone: nothing of ovimap."""
import sqlite3
import struct

import numpy as np
import xxhash
import zstandard

APPLICATION_ID = 0x4F56494D


def unsigned(value):
    return value & 0xFFFFFFFFFFFFFFFF


# ------------------------------------------------------------------------------------------------- tables

COLUMNS = {
    "meta": "key, value",
    "instances": "id, min_x, min_y, min_z, max_x, max_y, max_z, centroid_x, centroid_y, centroid_z, points, views",
    "instance_super_points": "instance, label",
    "instance_names": "id, name",
    "instance_confidences": "id, confidence",
    "frames": "position, source_index, timestamp_s, name, world_from_camera, labelled",
    "embeddings": "instance, embedding",
    "surfaces": "instance, points",
    "object_shapes": "instance, bottom, top, centroid_x, centroid_y, centroid_z, footprint, height, length, depth, above_floor, top_share, "
                     "covered_share",
    "kept_frames": "position, depth, color, segments, labels",
    "super_point_looks": "label, seen_min_x, seen_min_y, seen_min_z, seen_max_x, seen_max_y, seen_max_z, offered, queries",
    "super_point_views": "label, frame, visible_px, center_x, center_y, center_z, bins, embedding, crop_jpeg, crop_mask_png, "
                         "min_x, min_y, max_x, max_y",
    "label_forest": "epoch, roots",
    "super_points": "label, frames_seen",
    "votes": "label, instance, votes",
    "label_pairs": "lower, higher, joined, apart",
    "entity_sightings": "label, frame, entity",
    "entity_ratings": "frame, entity, rating",
    "super_point_frames": "label, first_frame, last_frame, runs",
    "instance_aliases": "id, target",
    "blocks": "tile, present, hash, data",
    "visits": "visit, source, first_frame, first_index",
    "visit_times": "visit, recorded_s",
    "object_events": "id, instance, kind, visit, frame, before, after, may_be",
    "past_objects": "event, centroid_x, centroid_y, centroid_z, points, views, super_points, surface, colors",
    "seen_free": "region, cells",
    "movers": "id, size_x, size_y, size_z, path",
    "edits": "id, time_s, action, arguments, undone_by",
    "corrected_flags": "id, hidden, locked",
}
for found in ("instances", "surfaces", "embeddings"):
    COLUMNS[f"corrected_{found}"] = COLUMNS[found]
COLUMNS["corrected_shapes"] = COLUMNS["object_shapes"]
COLUMNS["corrected_super_points"] = COLUMNS["instance_super_points"]
COLUMNS["corrected_names"] = COLUMNS["instance_names"]
COLUMNS["corrected_confidences"] = COLUMNS["instance_confidences"]


def row_hash(row):
    data = b""
    for value in row:
        if value is None:
            data += b"n" + bytes(8)
        elif isinstance(value, int):
            data += b"i" + struct.pack("<q", value)
        elif isinstance(value, float):
            data += b"r" + struct.pack("<d", 0.0 if value == 0 else value)
        else:
            raw = value.encode() if isinstance(value, str) else bytes(value)
            data += (b"t" if isinstance(value, str) else b"b") + struct.pack("<q", len(raw)) + raw
    return xxhash.xxh64_intdigest(data, seed=0)


class Map:
    def __init__(self, path):
        self.database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
        self.meta = dict(self.rows("meta"))

    def pragma(self, name):
        return self.database.execute(f"PRAGMA {name}").fetchone()[0]

    def tables(self):
        return [name for (name,) in self.database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]

    def rows(self, table):
        return self.database.execute(f"SELECT {COLUMNS[table]} FROM {table}").fetchall()

    def objects(self):
        """By id: (min, max, centroid, points, views), as people corrected them; hidden ones left out."""
        corrected = "corrected_flags" in self.tables()
        prefix = "corrected_" if corrected else ""
        hidden = {id for id, is_hidden, _ in self.rows("corrected_flags") if is_hidden} if corrected else set()
        result = {row[0]: (row[1:4], row[4:7], row[7:10], row[10], row[11]) for row in self.rows(f"{prefix}instances")}
        return {id: entry for id, entry in result.items() if id not in hidden}

    def names(self):
        table = "corrected_names" if "corrected_names" in self.tables() else "instance_names"
        return dict(self.rows(table))


# ------------------------------------------------------------------------------------------------- voxels

def surface_points(blob):
    """[points, 3] of a row of `surfaces`."""
    low, high = np.frombuffer(blob[:24], "<f4").reshape(2, 3)
    return low + np.frombuffer(blob[24:], "<u2").reshape(-1, 3) / 65535 * (high - low)


def unpack_tile(key):
    return [((key >> shift) & 0x1FFFFF) - (1 << 20) for shift in (0, 21, 42)]


PATH = []  # place i: offset x + 8 (y + 8 z)
for place in range(512):
    z, row, column = place // 64, place // 8 % 8, place % 8
    y = row if z % 2 == 0 else 7 - row
    x = column if row % 2 == 0 else 7 - column
    PATH.append(x + 8 * (y + 8 * z))
PATH = np.array(PATH)


def undo_differences(planes, bits):
    """Numbers from their byte planes, lowest first."""
    codes = sum(plane.astype(np.uint64) << (8 * i) for i, plane in enumerate(planes))
    values = np.where(codes & 1, ~(codes >> 1), codes >> 1)
    with np.errstate(over="ignore"):
        return np.cumsum(values, dtype=np.uint64) & np.uint64((1 << bits) - 1)


class Cursor:
    def __init__(self, body):
        self.body, self.at = body, 0

    def take(self, count, kind=np.uint8):
        size = count * np.dtype(kind).itemsize
        part = np.frombuffer(self.body, dtype=np.dtype(kind).newbyteorder("<"), count=count, offset=self.at)
        self.at += size
        return part


def read_tile(present, data, schema=7):
    """The blocks of a tile: (place in the tile, palette, distance, weight, rgb, slots, supports, doubts)."""
    bits = [bit for bit in range(64) if unsigned(present) >> bit & 1]
    count = len(bits)
    cursor = Cursor(zstandard.ZstdDecompressor().decompress(data))
    cursor.take(count, np.uint32)  # epochs
    sizes = cursor.take(count, np.uint16)
    palettes = [cursor.take(int(size), np.uint32) for size in sizes]
    masks = np.unpackbits(cursor.take(64 * count), bitorder="little").reshape(count, 512).astype(bool)
    voxels = int(masks.sum())
    labels = [cursor.take(voxels) for _ in range(4)]
    supports = int(sum((slot != 0).sum() for slot in labels))
    support = undo_differences([cursor.take(supports), cursor.take(supports)], 16)
    distance_high, weight_high = cursor.take(voxels), cursor.take(voxels)
    color_high = [cursor.take(voxels) for _ in range(3)]
    distance = undo_differences([cursor.take(voxels), distance_high], 16)
    weight = undo_differences([cursor.take(voxels), cursor.take(voxels), cursor.take(voxels), weight_high], 32).astype(np.uint32)
    if schema >= 7:
        weight = (weight / 1024).astype(np.float32).view(np.uint32)
    green, red, blue = (undo_differences([cursor.take(voxels), high], 16) for high in color_high)
    doubts = cursor.take(voxels) if cursor.at < len(cursor.body) else np.zeros(voxels, np.uint8)
    assert cursor.at == len(cursor.body)

    slots = np.zeros((4, voxels), np.uint16)
    first = 0
    for slot in range(4):
        held = labels[slot] != 0
        slots[slot][held] = support[first:first + int(held.sum())]
        first += int(held.sum())

    def spread(values, kind):
        """Stored voxels of one block to their offsets."""
        block = np.zeros(512, kind)
        block[PATH[masks[index]]] = values[begin:end]
        return block

    blocks = []
    begin = 0
    for index, bit in enumerate(bits):
        end = begin + int(masks[index].sum())
        blocks.append(((bit % 4, bit // 4 % 4, bit // 16), palettes[index], spread(distance, np.uint16),
                       spread(weight, np.uint32),
                       [spread(channel & 0xFFFF, np.uint16) for channel in (red + green, green, blue + green)],
                       [spread(slot, np.uint8) for slot in labels], [spread(slot, np.uint16) for slot in slots], spread(doubts, np.uint8)))
        begin = end
    return blocks


def voxel_labels(roots, palette, slots, supports):
    """For each voxel four pairs of root and support, strongest first."""
    result = np.zeros((512, 4, 2), np.uint32)
    for voxel in range(512):
        pairs = {}
        for slot in range(4):
            position = int(slots[slot][voxel])
            if position != 0:
                root = int(roots[palette[position]])
                pairs[root] = pairs.get(root, 0) + int(supports[slot][voxel])
        ordered = sorted(pairs.items(), key=lambda pair: -pair[1])  # stable: of equal ones the first
        for place, pair in enumerate(ordered):
            result[voxel][place] = pair
    return result


def content_hash(map_file):
    roots = np.frombuffer(map_file.rows("label_forest")[0][1], dtype="<u4")
    hashes = []
    for key, present, stored, data in map_file.rows("blocks"):
        assert xxhash.xxh64_intdigest(data, seed=0) == unsigned(stored)
        tile = unpack_tile(key)
        for place, palette, distance, weight, colors, slots, supports, doubts in read_tile(present, data, map_file.pragma("user_version")):
            index = [4 * tile[axis] + place[axis] for axis in range(3)]
            parts = [struct.pack("<3i", *index), distance.tobytes(), weight.tobytes(),
                     b"".join(channel.tobytes() for channel in colors),
                     voxel_labels(roots, palette, slots, supports).tobytes()]
            if doubts.any():
                parts.append(doubts.tobytes())
            value = 0
            for part in parts:
                value = xxhash.xxh64_intdigest(part, seed=value)
            hashes.append((index[::-1], value))
    hashes.sort()
    return xxhash.xxh64_intdigest(b"".join(struct.pack("<Q", value) for _, value in hashes), seed=0), len(hashes)
