# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""ROS 2 messages as DDS knows them: names, structure and bytes.

rosbags has the definitions, their hashes and the code for CDR; from the definitions come the descriptions by which Cyclone DDS
checks what arrives. Both are those of a real ROS 2 node of rmw_cyclonedds (its src/dyntype.cpp and src/TypeSupport_impl.hpp).
"""

from __future__ import annotations

import functools
from typing import Any

from cyclonedds.idl import IdlStruct, make_idl_struct
from cyclonedds.idl import types as _types
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

idl: Any = _types  # which types cannot see that its classes are subscripted
QUERY = "ovimap_msgs/srv/Query"
APPROACH = "ovimap_msgs/srv/Approach"

# vision_msgs 4 (since ROS 2 Humble), which is no part of ROS' core, and our services.
DEFINITIONS = {
    "vision_msgs/msg/ObjectHypothesis": "string class_id\nfloat64 score",
    "vision_msgs/msg/ObjectHypothesisWithPose": "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
    "vision_msgs/msg/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
    "vision_msgs/msg/Detection3D": "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id",
    "vision_msgs/msg/Detection3DArray": "std_msgs/Header header\nDetection3D[] detections",
    f"{QUERY}_Request": "string text",
    f"{QUERY}_Response": "bool found\nstring message\nvision_msgs/Detection3DArray matches",
    f"{APPROACH}_Request": "string text\ngeometry_msgs/Point[<=1] start",
    f"{APPROACH}_Response": "bool found\nstring message\nvision_msgs/Detection3DArray matches\ngeometry_msgs/PoseArray poses\nnav_msgs/Path way",
}
# ROS' generator takes "char" for a uint8, by whose hash others know the type; rosbags does not.
CORRECTED = {"rmw_dds_common/msg/Gid": "uint8[16] data"}
# rmw_cyclonedds puts this before the body of every request and reply: who asked, and which question it was.
SERVICE_HEADER = [("client", idl.uint64), ("sequence_number", idl.int64)]
SERVICE_HEADER_BYTES = 16
ENCAPSULATION_BYTES = 4  # of CDR: its kind and options


@functools.cache
def store() -> Typestore:
    """The definitions of ROS 2 Jazzy and those above."""
    made = get_typestore(Stores.ROS2_JAZZY)
    for name in CORRECTED:
        del made.fielddefs[name]
    for name, text in (CORRECTED | DEFINITIONS).items():
        made.register({name: _parsed(name, text)})
    return made


def register(name: str, text: str) -> None:
    """A further type, by what its .msg file says, or its .srv file on one side of the line."""
    store().register({name: _parsed(name, text)})


def _parsed(name: str, text: str) -> Any:
    [parsed] = get_types_from_msg(text, name).values()  # rosbags has messages alone, and renames the parts of services
    return parsed


def make(name: str, /, **fields: Any) -> Any:
    """A message of that type; all fields are to be given."""
    return store().types[name](**fields)


def type_hash(name: str) -> str:
    """As ROS 2 computes it (RIHS01, REP 2011 and 2016): "RIHS01_" and 64 hexadecimal digits."""
    return store().hash_rihs01(name)


def dds_name(name: str) -> str:
    """"sensor_msgs/msg/Image" is called "sensor_msgs::msg::dds_::Image_"."""
    package, kind, message = name.split("/")
    return f"{package}::{kind}::dds_::{message}_"


class Sample(IdlStruct):
    """Bytes of a message, read when they are asked for. Its subclasses are the types that Cyclone DDS knows."""

    def serialize(self, buffer: Any = None, endianness: Any = None, use_version_2: Any = None) -> bytes:
        return bytes_of(self)

    @classmethod
    def deserialize(cls, data: bytes, has_header: bool = True, use_version_2: Any = None) -> Sample:
        return sample(cls, data)

    @classmethod
    def deserialize_key(cls, data: bytes, has_header: bool = True, use_version_2: Any = None) -> Sample:
        return sample(cls, b"")  # what says that a publisher is gone; ROS 2 has no keys


def sample(kind: type[Sample], data: bytes) -> Sample:
    """data: with its encapsulation, as it goes over the wire."""
    made = object.__new__(kind)
    vars(made)["data"] = data
    return made


def bytes_of(made: Sample) -> bytes:
    """With their encapsulation."""
    data: bytes = vars(made)["data"]
    return data


def encode(name: str, message: Any) -> bytes:
    """CDR, little-endian, with its encapsulation."""
    return bytes(store().serialize_cdr(message, name))


def decode(name: str, data: bytes) -> Any:
    """Pictures and point clouds are views of the bytes."""
    return store().deserialize_cdr(data, name)


@functools.cache
def message_type(name: str) -> type[Sample]:
    """How Cyclone DDS sees a message."""
    kind: type[Sample] = _struct(name, _fields(name), (Sample,))
    return kind


@functools.cache
def service_type(name: str) -> type[Sample]:
    """... a request or a reply, which has a header."""
    kind: type[Sample] = _struct(name, SERVICE_HEADER + _fields(name), (Sample,))
    return kind


def _struct(name: str, fields: list[tuple[str, Any]], bases: tuple[type, ...] = ()) -> Any:
    package, kind, message = name.split("/")
    return make_idl_struct(message, dds_name(name).replace("::", "."), dict(fields), bases=bases, dataclassify=not bases)


def _fields(name: str) -> list[tuple[str, Any]]:
    return [(field, _idl_of(description)) for field, description in store().fielddefs[name][1]]


@functools.cache
def _nested(name: str) -> Any:
    return _struct(name, _fields(name))


def _idl_of(description: Any) -> Any:
    kind, what = description
    if kind.name == "NAME":
        return _nested(what)
    if kind.name == "BASE":
        base, bound = what
        if base == "string":
            return idl.bounded_str[bound] if bound else str
        return {"bool": bool, "byte": idl.uint8, "octet": idl.uint8, "char": idl.uint8}.get(base) or getattr(idl, base)
    element, length = _idl_of(what[0]), what[1]
    if kind.name == "ARRAY":
        return idl.array[element, length]
    return idl.sequence[element, length] if length else idl.sequence[element]
