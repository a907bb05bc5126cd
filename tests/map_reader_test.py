#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Compares what a reader written from docs/map-format.md finds in a map with what the program says.
Usage: map_reader_test.py PROGRAM"""
import csv
import json
import sys
import unittest

try:
    import numpy as np
    from map_reader import APPLICATION_ID, COLUMNS, Map, content_hash, row_hash, surface_points, unsigned
except ImportError as missing:  # set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what this test needs")
    sys.exit(77)
from tiny_room import TinyRoom, ovimap


class Reader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.room = TinyRoom(frames=10, voxel_size_m=0.03)
        cls.folder, cls.path, cls.info = cls.room.folder, cls.room.map, cls.room.info
        cls.map = Map(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.map.database.close()
        cls.room.close()

    def test_it_is_a_map(self):
        self.assertEqual(self.map.pragma("application_id"), APPLICATION_ID)
        self.assertEqual(self.map.pragma("user_version"), self.info["schema"])
        self.assertEqual(int(self.map.meta["frames"]), self.info["frames"])
        self.assertEqual(self.map.meta["content_hash"], self.info["content_hash"])
        self.assertEqual(self.map.meta["config"], self.info["config"])

    def assert_tables_are_documented(self, map_file):
        self.assertEqual(set(map_file.tables()) - {"checks"}, set(map_file.tables()) & set(COLUMNS))
        checks = {name: (rows, hash) for name, rows, hash in
                  map_file.database.execute("SELECT name, rows, hash FROM checks")}
        self.assertEqual(set(checks), set(map_file.tables()) - {"checks"})
        for name, (count, hash) in checks.items():
            rows = map_file.rows(name)
            self.assertEqual(len(rows), count, name)
            self.assertEqual(sum(map(row_hash, rows)) & 0xFFFFFFFFFFFFFFFF, unsigned(hash), name)

    def test_every_table_is_as_documented(self):
        self.assert_tables_are_documented(self.map)

    def test_objects_are_those_of_the_program(self):
        objects = self.map.objects()
        self.assertEqual(list(objects), [entry["id"] for entry in self.info["instances"]])
        for entry in self.info["instances"]:
            low, high, centroid, points, views = objects[entry["id"]]
            for ours, theirs in ((low, entry["box"]["min"]), (high, entry["box"]["max"]), (centroid, entry["centroid"])):
                self.assertTrue(np.allclose(ours, theirs, atol=1e-6))
            self.assertEqual((points, views), (entry["points"], entry["views"]))

    def test_voxels_are_those_of_the_program(self):
        value, blocks = content_hash(self.map)
        self.assertEqual(f"{value:016x}", self.info["content_hash"])
        self.assertEqual(blocks, self.info["blocks"])

    def test_most_of_a_surface_lies_in_its_box(self):
        objects = self.map.objects()
        for id, blob in self.map.rows("surfaces"):
            points = surface_points(blob)
            self.assertGreater(len(points), 3)
            inside = (points >= np.array(objects[id][0]) - 0.01) & (points <= np.array(objects[id][1]) + 0.01)
            self.assertGreater(inside.all(axis=1).mean(), 0.8, "the rest are specks")

    def test_shapes_are_what_surfaces_measure(self):
        up = np.array([float(self.map.meta[f"up.{axis}"]) for axis in "xyz"])
        x = np.cross(np.eye(3)[np.abs(up).argmin()], up)
        x /= np.linalg.norm(x)
        ground = np.array([x, np.cross(up, x), up])
        surfaces = {id: surface_points(blob) @ ground.T for id, blob in self.map.rows("surfaces")}
        heights = np.sort(np.concatenate([points[:, 2] for points in surfaces.values()]))
        floor = heights[int(0.02 * (len(heights) - 1))]
        shapes = self.map.rows("object_shapes")
        self.assertEqual([row[0] for row in shapes], sorted(self.map.objects()))
        for id, bottom, top, *centroid, footprint, height, length, depth, above_floor, top_share, covered_share in shapes:
            if id not in surfaces:
                self.assertEqual((top_share, covered_share), (-1, -1))
                continue
            points = surfaces[id]
            corners = np.frombuffer(footprint, "<f4").reshape(-1, 2)
            self.assertTrue((points[:, :2] >= corners.min(0) - 0.5).all() and (points[:, :2] <= corners.max(0) + 0.5).all())
            sides, after = corners, np.roll(corners, -1, axis=0)
            self.assertGreater((sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]).sum(), 0, "counter-clockwise")
            kept = points[(points[:, 2] > bottom + 0.00499) & (points[:, 2] < top - 0.00499)]
            self.assertTrue(np.allclose(kept.mean(0), centroid, atol=1e-3))
            self.assertGreaterEqual(len(kept), 0.985 * len(points))
            z = np.sort(kept[:, 2])
            low, high = (z[int(share * (len(z) - 1))] for share in (0.05, 0.95))
            self.assertAlmostEqual(height, high - low, delta=2e-3)
            self.assertAlmostEqual(above_floor, low - floor, delta=2e-3)
            self.assertGreaterEqual(length, depth)
            self.assertAlmostEqual(top_share, (kept[:, 2] > high - 0.05).mean(), delta=0.02)
            self.assertTrue(0 <= covered_share < 1)

    def test_poses_are_rigid(self):
        for row in self.map.rows("frames"):
            pose = np.frombuffer(row[4], "<f8").reshape(3, 4)
            self.assertTrue(np.allclose(pose[:, :3] @ pose[:, :3].T, np.eye(3), atol=1e-9))

    def test_corrections_are_as_documented(self):
        path = self.folder / "edited.ovimap"
        path.write_bytes(self.path.read_bytes())
        first, second, third = (str(entry["id"]) for entry in self.info["instances"][:3])
        ovimap("edit", path, "rename", first, "tea pot, \"old\"")
        ovimap("edit", path, "merge", first, second)
        ovimap("edit", path, "hide", third)
        edited = Map(path)
        self.assert_tables_are_documented(edited)
        csv_path = self.folder / "edited.csv"
        ovimap("export", path, csv_path)
        with open(csv_path, newline="") as file:
            rows = list(csv.DictReader(file))
        objects = edited.objects()
        self.assertEqual([int(row["id"]) for row in rows], list(objects))
        self.assertEqual(len(rows), len(self.info["instances"]) - 2)
        self.assertEqual(edited.names()[int(first)], rows[0]["name"])
        for row in rows:
            self.assertEqual(int(row["points"]), objects[int(row["id"])][3])
        log = edited.rows("edits")
        self.assertEqual([entry[2] for entry in log], ["rename", "merge", "hide"])
        self.assertEqual(json.loads(log[1][3])["instances"], [int(first), int(second)])
        # What mapping found is still there.
        self.assertEqual(edited.rows("instances"), self.map.rows("instances"))
        self.assertEqual(content_hash(edited)[0], content_hash(self.map)[0])
        edited.database.close()


if __name__ == "__main__":
    unittest.main()
