# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map as a USD stage: rooms with their objects, each a mesh that is a rigid body."""

from __future__ import annotations

import os

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, Vt

from .scene import Scene, SceneObject


def write_usd(scene: Scene, path: str | os.PathLike[str], parts: int = 0) -> list[str]:
    """Writes .usda, .usdc or .usd: metres, z up, floor at z = 0. /Map/ROOM/OBJECT, and /Map/no_room for what is in none. Objects
    collide by their convex hulls and do not move by themselves (kinematic); walls and floors are to be seen alone. Nothing is left out. Recognised parts of an
    object are frames below it, at the middle of their boxes (ovimap:size).
    parts: other than 0, all are to be cut into convex parts, which simulators do themselves ("convexDecomposition")."""
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/Map").GetPrim())
    names = {0: "no_room"}
    for room in scene.graph["rooms"]:
        names[room["id"]] = f"{_identifier(room['name'])}_{room['id']}"
    for id, name in names.items():
        prim = UsdGeom.Xform.Define(stage, f"/Map/{name}").GetPrim()
        prim.CreateAttribute("ovimap:room", Sdf.ValueTypeNames.Int).Set(id)
    for thing in scene.objects:
        _add(stage, f"/Map/{names[thing.room]}/{thing.key}", thing, cut=parts > 0)
    stage.Export(os.fspath(path))
    return []


def _add(stage: Usd.Stage, path: str, thing: SceneObject, cut: bool) -> None:
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.AddTranslateOp().Set(Gf.Vec3d(*map(float, thing.center)))
    points = np.ascontiguousarray(thing.vertices - thing.center, dtype=np.float32)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray(len(thing.triangles), 3))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(thing.triangles.astype(np.int32).ravel()))
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([points.min(axis=0), points.max(axis=0)])))
    if len(thing.colors):
        linear = ((thing.colors / 255.0) ** 2.2).astype(np.float32)
        mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex).Set(Vt.Vec3fArray.FromNumpy(linear))
    prim = mesh.GetPrim()
    prim.CreateAttribute("ovimap:id", Sdf.ValueTypeNames.UInt).Set(thing.id)
    prim.CreateAttribute("ovimap:title", Sdf.ValueTypeNames.String).Set(thing.title)
    for number, (center, size) in enumerate(thing.parts, 1):
        part = UsdGeom.Xform.Define(stage, f"{path}/part_{number}")
        part.AddTranslateOp().Set(Gf.Vec3d(*map(float, center - thing.center)))
        part.GetPrim().CreateAttribute("ovimap:size", Sdf.ValueTypeNames.Float3).Set(Gf.Vec3f(*map(float, size)))
    if cut or not thing.is_shell:
        UsdPhysics.RigidBodyAPI.Apply(prim).CreateKinematicEnabledAttr(True)
        UsdPhysics.CollisionAPI.Apply(prim)
        UsdPhysics.MeshCollisionAPI.Apply(prim).CreateApproximationAttr(UsdPhysics.Tokens.convexDecomposition if cut else UsdPhysics.Tokens.convexHull)


def _identifier(name: str) -> str:
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in name)
