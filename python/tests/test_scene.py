# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Maps as scene graphs, opened in the programs that the exports are for."""
import json
import os
import subprocess
import sys

import numpy as np
import ovimap
import pytest
from ovimap.scene import read_scene
from ovimap.scene.scene import hull_corners, inside_hull


@pytest.fixture(scope="module")
def scene(saved_map):
    return read_scene(saved_map)


def test_the_hull_of_a_box_holds_what_is_in_it():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], np.float32)
    hull = hull_corners(corners)
    inside = inside_hull(hull, np.array([[0.5, 1, 1.5], [0.01, 0.01, 0.01], [1.2, 1, 1], [0.5, -0.2, 1]], np.float32))
    assert inside.tolist() == [True, True, False, False]
    sheet = hull_corners(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32))
    assert np.ptp(sheet[:, 2]) > 0.005, "a sheet has a thickness"


def test_the_graph_names_everything_once(scene, saved_map):
    graph, opened = scene.graph, ovimap.Map.open(saved_map)
    ids = [said["id"] for said in graph["objects"]]
    assert ids == opened.instances.ids.tolist()
    assert [room["id"] for room in graph["rooms"]] == list(range(1, len(graph["rooms"]) + 1))
    for room in graph["rooms"]:
        assert room["objects"] == [said["id"] for said in graph["objects"] if said["room"] == room["id"]]
        assert set(room["known_by"]) <= set(room["objects"]) and sum(room["kinds"].values()) < 1
    assert len(graph["relations"]) == len(opened.relations())
    assert all(a < b < len(graph["places"]) for a, b in graph["links"])


def test_the_tiny_room_is_one_room(scene):
    [room] = scene.graph["rooms"]
    assert 5 < room["area_m2"] < 11.3  # of 3.6 x 3.1 m
    inside = [said for said in scene.graph["objects"] if said["room"] == 1]
    assert len(inside) > len(scene.graph["objects"]) / 2
    assert all(abs(scene.position(place["place"])[2]) < 0.01 for place in scene.graph["places"])


def test_it_opens_in_spark_dsg(scene, tmp_path):
    dsg = pytest.importorskip("spark_dsg")
    from ovimap.scene.spark import write_spark

    write_spark(scene, tmp_path / "room.json")
    graph = dsg.DynamicSceneGraph.load(str(tmp_path / "room.json"))
    assert graph.get_layer(dsg.DsgLayers.OBJECTS).num_nodes() == len(scene.objects)
    assert graph.get_layer(dsg.DsgLayers.ROOMS).num_nodes() == len(scene.graph["rooms"])
    assert graph.get_layer(dsg.DsgLayers.PLACES).num_nodes() == len(scene.graph["places"])
    thing = scene.objects[0]
    node = graph.get_node(dsg.NodeSymbol("O", thing.id))
    assert node.attributes.name == thing.title and np.allclose(node.attributes.position, thing.center, atol=1e-4)
    for thing in scene.objects:  # from an object up to its room
        if thing.room:
            place = graph.get_node(graph.get_node(dsg.NodeSymbol("O", thing.id)).get_parent())
            assert place.get_parent() == dsg.NodeSymbol("R", thing.room).value


def test_it_opens_in_usd(scene, tmp_path):
    pytest.importorskip("pxr")
    from ovimap.scene.usd import write_usd
    from pxr import Usd, UsdGeom, UsdPhysics

    for ending in ("usda", "usdc"):
        write_usd(scene, tmp_path / f"room.{ending}")
        stage = Usd.Stage.Open(str(tmp_path / f"room.{ending}"))
        assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1
        meshes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
        assert len(meshes) == len(scene.objects)
        ids = {prim.GetAttribute("ovimap:id").Get(): prim for prim in meshes}
        box_of = UsdGeom.BBoxCache(Usd.TimeCode.Default(), ["default"])
        for thing in scene.objects:
            low = box_of.ComputeWorldBound(ids[thing.id]).ComputeAlignedRange().GetMin()
            assert np.allclose(low, thing.center - thing.size / 2, atol=1e-3)
            assert ids[thing.id].HasAPI(UsdPhysics.RigidBodyAPI) != thing.is_shell


def test_it_runs_in_mujoco(scene, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    from ovimap.scene.mjcf import write_mjcf

    left_out = write_mjcf(scene, tmp_path / "room.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml"))
    data = mujoco.MjData(model)
    assert model.nbody - 1 == len(scene.objects) - len(left_out) > 3
    assert model.njnt > 0, "nothing can move"
    mujoco.mj_forward(model, data)
    for thing in scene.objects:
        if thing.key not in left_out:
            assert np.allclose(data.body(thing.key).xpos, thing.center, atol=1e-3)
    assert_still(mujoco, model, data)


def assert_still(mujoco, model, data):
    """A second goes by, and what stands on something stays there."""
    before = data.qpos.copy()
    for _ in range(500):
        mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all() and data.warning.number.sum() == 0
    moved = np.linalg.norm((data.qpos - before).reshape(-1, 7)[:, :3], axis=1)
    assert np.median(moved) < 0.2


def test_convex_parts_are_closer_than_the_hull(scene):
    pytest.importorskip("vhacdx")
    from ovimap.scene.parts import convex_parts

    def is_closer(thing):
        """Points of the hull's box that lie in the shape: far fewer in the parts, while the surface lies in them all the same."""
        parts = convex_parts(thing, 32)
        assert 1 < len(parts) <= 32 and all(4 <= len(part) <= 256 for part in parts)
        box = np.random.default_rng(1).uniform(thing.hull.min(axis=0), thing.hull.max(axis=0), (4000, 3)).astype(np.float32)
        in_parts, in_hull = held(parts, box), held([thing.hull], box)
        seen = held(parts, thing.vertices[:: len(thing.vertices) // 500])
        return seen.mean() > 0.95 and in_parts.sum() < in_hull.sum() / 2

    solid = [thing for thing in scene.objects if not thing.is_shell and 0.5 < thing.size.max() < 1.7 and thing.size.min() > 0.3]
    assert len(solid) >= 3
    assert sum(is_closer(thing) for thing in solid) > len(solid) / 2


def held(parts, points):
    return np.any([inside_hull(part, points) for part in parts], axis=0)


def test_convex_parts_run_in_mujoco(scene, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    pytest.importorskip("vhacdx")
    from ovimap.scene.mjcf import write_mjcf

    assert write_mjcf(scene, tmp_path / "room.xml", parts=8) == []
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml"))
    data = mujoco.MjData(model)
    assert model.nbody - 1 == len(scene.objects) and 2 * len(scene.objects) < model.ngeom <= 8 * len(scene.objects) + 1
    assert_still(mujoco, model, data)


def test_usd_has_simulators_cut(scene, tmp_path):
    pytest.importorskip("pxr")
    from ovimap.scene.usd import write_usd
    from pxr import Usd, UsdGeom, UsdPhysics

    write_usd(scene, tmp_path / "room.usda", parts=8)
    stage = Usd.Stage.Open(str(tmp_path / "room.usda"))
    said = {UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get() for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)}
    assert said == {"convexDecomposition"}


def test_the_command_writes_what_the_name_says(saved_map, tmp_path):
    pytest.importorskip("vhacdx")

    def command(out, *options):
        return subprocess.run([sys.executable, "-m", "ovimap.scene_command", saved_map, out, *options], capture_output=True, text=True, check=False)

    said = command(tmp_path / "room.xml")
    assert said.returncode == 0 and "rooms: " in said.stdout, said
    said = command(tmp_path / "cut.xml", "--parts", "4")
    assert said.returncode == 0 and "_part_1" in (tmp_path / "cut.xml").read_text(), said
    said = command(tmp_path / "cut.xml", "--parts", "0")
    assert said.returncode == 2 and "from 1 to 256" in said.stderr
    said = command(tmp_path / "room.obj")
    assert said.returncode == 2 and ".usda" in said.stderr and said.stderr.count("\n") == 1


def test_the_program_writes_the_same_graph(scene, saved_map, tmp_path):
    program = os.environ.get("OVIMAP_PROGRAM")
    if not program:
        pytest.skip("the program was not built; set OVIMAP_PROGRAM")
    subprocess.run([program, "export", saved_map, tmp_path / "room.json", "--what", "rooms"], check=True, capture_output=True)
    assert json.loads((tmp_path / "room.json").read_text()) == scene.graph
