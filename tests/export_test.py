#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What `ovimap export` writes, opened by programs that know nothing of ovimap: trimesh, Khronos' glTF validator,
Pillow, PyYAML, csv and json. Usage: export_test.py PROGRAM"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
try:
    import numpy as np
    import trimesh
    import yaml
    from PIL import Image
except ImportError as missing:  # set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what this test needs")
    sys.exit(77)
from tiny_room import TinyRoom, ovimap

VALIDATOR = ROOT / ".deps/gltf-validator"


def picture_of(path):
    with Image.open(path) as image:
        return np.asarray(image)


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.room = TinyRoom(frames=24, voxel_size_m=0.02)
        cls.folder, cls.map, cls.info = cls.room.folder, cls.room.map, cls.room.info
        cls.objects = {entry["id"]: entry for entry in cls.info["instances"]}

    @classmethod
    def tearDownClass(cls):
        cls.room.close()

    def export(self, name, *options):
        path = self.folder / name
        ovimap("export", self.map, path, *options)
        return path

    def assert_inside(self, vertices, box, margin):
        """Most of an object's vertices lie in its box; specks do not, nor a few corners of triangles on its border."""
        low, high = np.array(box["min"]) - margin, np.array(box["max"]) + margin
        share = np.all((vertices >= low) & (vertices <= high), axis=1).mean()
        self.assertGreater(share, 0.9)

    def test_glb_has_a_node_per_object(self):
        scene = trimesh.load(self.export("room.glb"))
        named = {}
        for name, geometry in scene.geometry.items():
            named[name] = geometry
        found = 0
        for node in scene.graph.nodes_geometry:
            transform, geometry = scene.graph[node]
            extras = scene.graph.transforms.edge_data[(scene.graph.transforms.parents[node], node)].get("metadata") or {}
            identifier = extras.get("id")
            if identifier is None:
                self.assertEqual(node, "background")
                continue
            found += 1
            self.assertEqual(node, f"{self.objects[identifier]['label'] or 'object'} {identifier}")
            self.assertEqual(extras["box"], self.objects[identifier]["box"])
            world_from_gltf = np.linalg.inv(transform)
            # Geometry keeps world coordinates below the node that turns the world upright.
            self.assert_inside(named[geometry].vertices, extras["box"], 0.03)
            self.assertTrue(np.allclose(world_from_gltf @ world_from_gltf.T, np.eye(4), atol=1e-5))
        self.assertEqual(found, len(self.objects))
        height = scene.bounds[1] - scene.bounds[0]
        ply = trimesh.load(self.export("room.ply"))
        extent = ply.bounds[1] - ply.bounds[0]  # z is up there, y here
        self.assertTrue(np.allclose(height, extent[[0, 2, 1]], atol=0.05), (height, extent))

    def test_glb_is_valid(self):
        if not (VALIDATOR / "node_modules").is_dir():
            self.skipTest("tools/setup.sh installs the glTF validator")
        for what in ("mesh", "instances"):
            path = self.export(f"{what}.glb", "--what", what)
            report = json.loads(subprocess.run(
                ["node", str(ROOT / "tests/validate_glb.js"), str(VALIDATOR), str(path)],
                check=True, capture_output=True, text=True).stdout)
            issues = report["issues"]
            self.assertEqual((issues["numErrors"], issues["numWarnings"]), (0, 0), issues["messages"][:5])
            self.assertEqual(report["info"]["materialCount"], 1)
            self.assertGreater(report["info"]["totalTriangleCount"], 1000)

    def test_ply_is_a_mesh_or_points(self):
        mesh = trimesh.load(self.export("mesh.ply"), process=False)
        self.assertGreater(len(mesh.faces), 1000)
        points = trimesh.load(self.export("points.ply", "--what", "points"), process=False)
        self.assertIsInstance(points, trimesh.PointCloud)
        self.assertTrue(np.array_equal(points.vertices, mesh.vertices))

    def test_csv_has_a_row_per_object(self):
        with open(self.export("room.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["id"]) for row in rows], list(self.objects))
        for row in rows:
            entry = self.objects[int(row["id"])]
            for axis, letter in enumerate("xyz"):
                for end in ("min", "max"):
                    self.assertAlmostEqual(float(row[f"{end}_{letter}"]), entry["box"][end][axis], places=6)
            self.assertEqual((int(row["points"]), int(row["views"])), (entry["points"], entry["views"]))

    def test_scene_json_says_how_things_stand(self):
        scene = json.loads(self.export("room.json").read_text())
        self.assertEqual({entry["id"] for entry in scene["instances"]}, set(self.objects))
        self.assertTrue(scene["relations"])
        for relation in scene["relations"]:
            self.assertIn(relation["object"], self.objects)
            self.assertIn(relation["anchor"], self.objects)
            self.assertIn(relation["relation"], ("on", "inside", "above", "beside", "near"))
            self.assertGreaterEqual(relation["score"], 0.5)
        on = [r for r in scene["relations"] if r["relation"] == "on"]
        self.assertTrue(on)
        for relation in on:  # what rests on a thing begins above that thing's foot
            a, b = (self.objects[relation[key]]["box"] for key in ("object", "anchor"))
            self.assertGreater(a["min"][2] + 0.06, b["min"][2])

    def test_folder_has_each_object(self):
        folder = self.export("objects")
        self.assertTrue((folder / "scene.json").is_file())
        entries = [path for path in folder.iterdir() if path.is_dir()]
        self.assertEqual(len(entries), len(self.objects))
        crops = 0
        for path in entries:
            entry = json.loads((path / "object.json").read_text())
            self.assertEqual(entry["box"], self.objects[entry["id"]]["box"])
            mesh = trimesh.load(path / "mesh.ply")
            self.assert_inside(mesh.vertices, entry["box"], 0.03)
            for crop in entry["crops"]:
                picture, mask = picture_of(path / crop["file"]), picture_of(path / crop["mask"])
                self.assertEqual(picture.shape[:2], mask.shape)
                self.assertEqual(set(np.unique(mask)) - {0}, {255})
                crops += 1
        self.assertGreater(crops, len(entries))
        self.assertIn("not empty", ovimap("export", self.map, folder, code=2))

    def test_grid_is_what_map_server_reads(self):
        path = self.export("grid.yaml", "--heights", "0.3,1.0")
        for name in ("grid.yaml", "grid_0.30m.yaml", "grid_1.00m.yaml"):
            grid = yaml.safe_load((self.folder / name).read_text())
            picture = picture_of(self.folder / grid["image"])
            self.assertEqual(picture.dtype, np.uint8)
            # As map_server: p = (255 - x) / 255; occupied above one threshold, free below the other.
            chance = (255.0 - picture) / 255.0
            occupied, free = chance > grid["occupied_thresh"], chance < grid["free_thresh"]
            self.assertGreater(occupied.sum(), 50)
            self.assertGreater(free.sum(), 50)
            esdf = picture_of(self.folder / grid["esdf"]["image"]).astype(float)
            self.assertEqual(esdf.shape, picture.shape)
            if name == "grid.yaml":  # distances in the plane, each against every obstacle
                self.assertEqual(set(np.unique(picture)) - {0, 254, 205}, set())
                rows, columns = np.nonzero(occupied)
                for row in range(0, picture.shape[0], 7):
                    for column in range(0, picture.shape[1], 7):
                        nearest = np.hypot(rows - row, columns - column).min() * grid["resolution"]
                        self.assertAlmostEqual(esdf[row, column] * grid["esdf"]["metres_per_unit"], nearest, delta=6e-4)
            else:
                self.assertTrue((esdf[occupied] == 0).all())
                self.assertTrue((esdf[free] > 0).all())
        self.check_free_floor(path)

    def check_free_floor(self, path):
        """Where the recording's camera stood, nothing stands in the way."""
        grid = yaml.safe_load(path.read_text())
        picture = picture_of(self.folder / grid["image"])
        poses = np.loadtxt(self.folder / "synth/room/traj.txt").reshape(-1, 4, 4)
        hits = 0
        for pose in poses:
            column, row = ((pose[:2, 3] - grid["origin"][:2]) / grid["resolution"]).astype(int)
            self.assertGreater(picture[picture.shape[0] - 1 - row, column], 0)
            hits += picture[picture.shape[0] - 1 - row, column] == 254
        self.assertGreater(hits, len(poses) // 3)

    def test_targets_are_checked_before_the_work(self):
        for name in ("nowhere/a.glb", "nowhere/folder", "a.xyz"):
            self.assertTrue(ovimap("export", self.map, self.folder / name, code=2))
        self.assertIn("nowhere", ovimap("export", self.folder / "missing.ovimap", self.folder / "nowhere/a.ply", code=2))
        self.assertIn("nowhere", ovimap("report", self.folder / "missing.ovimap", self.folder / "nowhere/a.html", code=2))
        self.assertIn("points", ovimap("export", self.map, self.folder / "a.glb", "--what", "points", code=2))
        self.assertFalse(os.path.exists(self.folder / "a.glb"))


if __name__ == "__main__":
    unittest.main()
