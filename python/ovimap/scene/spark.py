# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map as a scene graph of spark-dsg, which Hydra and its friends read."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import spark_dsg as dsg

from .scene import Scene


def spark_graph(scene: Scene) -> Any:
    """A DynamicSceneGraph: objects (symbols O), places (p), rooms (R) and one building (B). z is up, the floor at z = 0. Edges:
    building to rooms, room to its places, place to the objects nearest to it, doors between rooms, ways between places, and
    between objects what stands on or in what."""
    graph = dsg.DynamicSceneGraph()
    rooms, places = scene.graph["rooms"], scene.graph["places"]
    _add_building(graph, scene)
    for room in rooms:
        attributes = dsg.RoomNodeAttributes()
        attributes.position, attributes.name = scene.position(room["center"]), room["name"]
        symbol = dsg.NodeSymbol("R", room["id"])
        graph.add_node(dsg.DsgLayers.ROOMS, symbol, attributes)
        graph.insert_edge(dsg.NodeSymbol("B", 0), symbol)
    for number, place in enumerate(places):
        attributes = dsg.PlaceNodeAttributes()
        attributes.position, attributes.distance = scene.position(place["place"]), place["radius_m"]
        graph.add_node(dsg.DsgLayers.PLACES, dsg.NodeSymbol("p", number), attributes)
        if place["room"]:
            graph.insert_edge(dsg.NodeSymbol("R", place["room"]), dsg.NodeSymbol("p", number))
    for a, b in scene.graph["links"]:
        graph.insert_edge(dsg.NodeSymbol("p", a), dsg.NodeSymbol("p", b))
    for door in scene.graph["doors"]:
        graph.insert_edge(*(dsg.NodeSymbol("R", room) for room in door["rooms"]))
    _add_objects(graph, scene)
    return graph


def write_spark(scene: Scene, path: str | os.PathLike[str], parts: int = 0) -> list[str]:
    """Writes the graph as spark-dsg does, .json or .sparkdsg, of boxes, so that parts say nothing. Nothing is left out."""
    spark_graph(scene).save(os.fspath(path), include_mesh=False)
    return []


def _add_building(graph: Any, scene: Scene) -> None:
    attributes = dsg.SemanticNodeAttributes()
    attributes.name = "building"
    centers = [scene.position(room["center"]) for room in scene.graph["rooms"]]
    attributes.position = np.mean(centers, axis=0) if centers else np.zeros(3)
    graph.add_node(dsg.DsgLayers.BUILDINGS, dsg.NodeSymbol("B", 0), attributes)


def _add_objects(graph: Any, scene: Scene) -> None:
    middles = np.array([scene.position(place["place"]) for place in scene.graph["places"]]).reshape(-1, 3)
    rooms = np.array([place["room"] for place in scene.graph["places"]], dtype=int)
    for thing in scene.objects:
        attributes = dsg.ObjectNodeAttributes()
        attributes.position, attributes.name = thing.center, thing.title
        attributes.bounding_box = dsg.BoundingBox(thing.size, thing.center)
        symbol = dsg.NodeSymbol("O", thing.id)
        graph.add_node(dsg.DsgLayers.OBJECTS, symbol, attributes)
        here = np.flatnonzero(rooms == thing.room)
        if thing.room and len(here):
            away = np.linalg.norm(middles[here, :2] - thing.center[:2], axis=1)
            graph.insert_edge(dsg.NodeSymbol("p", int(here[away.argmin()])), symbol)
    known = {thing.id for thing in scene.objects}
    for said in scene.graph["relations"]:
        if said["relation"] in ("on", "inside") and {said["object"], said["anchor"]} <= known:
            graph.insert_edge(dsg.NodeSymbol("O", said["object"]), dsg.NodeSymbol("O", said["anchor"]))
