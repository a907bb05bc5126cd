# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A participant that ROS 2 nodes take for one of theirs: topics, services, and how well they are delivered.

Names, prefixes, user data and the header of services are as rmw_cyclonedds writes them (its src/rmw_node.cpp and src/serdata.hpp;
https://design.ros2.org/articles/topic_and_service_names.html says the same of names).
"""

from __future__ import annotations

import functools
import os
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from cyclonedds.core import DDSException, InstanceState, ReadCondition, SampleState, ViewState, WaitSet
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from .._ovimap import Error
from . import types

GRAPH, GRAPH_TOPIC = "rmw_dds_common/msg/ParticipantEntitiesInfo", "ros_discovery_info"
MOST_DOMAIN = 232  # above it the ports of DDS leave 16 bits
TAKEN_AT_ONCE = 16
# What peers say of the structure of types is not looked at, as ROS 2 itself goes by names: Fast DDS describes types in another way
# than Cyclone DDS, so the same message would not be taken for the same. The numbers are RTI's, eProsima's, Cyclone's and Gurum's.
# An image comes as hundreds of packets at once; as many as the system allows are to wait for us.
SETTINGS = """<CycloneDDS><Domain>
<Compatibility><IgnoreTypeInformation>1.1,1.15,1.16,1.18</IgnoreTypeInformation></Compatibility>
<Internal><SocketReceiveBufferSize min="default" max="16MB"/></Internal>
</Domain></CycloneDDS>"""


@dataclass(frozen=True)
class Quality:
    """How a topic is delivered: docs/robots.md says which topic has which, and why."""

    depth: int
    reliable: bool = True
    latched: bool = False  # a late subscriber gets the last `depth` messages


SENSOR_DATA = Quality(depth=5, reliable=False)
TRANSFORMS = Quality(depth=100)
STATIC_TRANSFORMS = Quality(depth=100, latched=True)
LATCHED = Quality(depth=1, latched=True)
EVENTS = Quality(depth=100, latched=True)
CLOCK = Quality(depth=1, reliable=False)
SERVICE = Quality(depth=10)


def _policies(quality: Quality, user_data: str) -> Qos:
    history = Policy.History.KeepLast(quality.depth)
    # All of rmw_cyclonedds: XCDR1 alone, and what is kept for late subscribers is kept apart.
    policies = [history, Policy.DataRepresentation(use_cdrv0_representation=True), Policy.Userdata(user_data.encode())]
    policies.append(Policy.Reliability.Reliable(duration(infinite=True)) if quality.reliable else Policy.Reliability.BestEffort)
    if quality.latched:
        unlimited = -1
        policies += [Policy.Durability.TransientLocal, Policy.DurabilityService(0, history, unlimited, unlimited, unlimited)]
    else:
        policies.append(Policy.Durability.Volatile)
    return Qos(*policies)


def qualified(name: str) -> str:
    """A topic's or service's full name: "camera/info" is "/camera/info"."""
    return "/" + name.strip("/")


def topic_of(name: str) -> str:
    """The name in DDS."""
    return "rt" + qualified(name)


class Publisher:
    """Of messages of one type on one topic."""

    def __init__(self, writer: Any, name: str) -> None:
        self._writer, self._name = writer, name

    def publish(self, message: Any) -> None:
        self.publish_bytes(types.encode(self._name, message))

    def publish_bytes(self, data: bytes) -> None:
        self._writer.write(types.sample(self._writer.topic.data_type, data))

    @property
    def subscribers(self) -> int:
        return len(self._writer.get_matched_subscriptions())


class Subscription:
    """To a topic; `take` gives what came since."""

    def __init__(self, reader: Any, name: str, topic: str) -> None:
        self.reader, self.name, self.topic = reader, name, topic

    @property
    def publishers(self) -> int:
        return len(self.reader.get_matched_publications())

    @property
    def mismatched(self) -> int:
        """Publishers that offer less than we ask for, so nothing of theirs comes."""
        return int(self.reader.get_requested_incompatible_qos_status().total_count)

    def take(self) -> Iterator[Any]:
        """Messages; None for one whose bytes cannot be read."""
        for sample in self._samples():
            try:
                yield types.decode(self.name, types.bytes_of(sample))
            except Exception:  # whatever another program wrote
                yield None

    def _samples(self) -> Iterator[types.Sample]:
        while True:
            taken = self.reader.take(N=TAKEN_AT_ONCE)
            yield from (sample for sample in taken if isinstance(sample, types.Sample))
            if len(taken) < TAKEN_AT_ONCE:
                return


class Service(Subscription):
    """Answers requests. Requests and replies carry 16 bytes before their body: the client, and its number of the request."""

    def __init__(self, reader: Any, name: str, topic: str, writer: Any, answer: Callable[[Any], Any]) -> None:
        super().__init__(reader, f"{name}_Request", topic)
        self._reply, self._writer, self._answer = f"{name}_Response", writer, answer

    def serve(self) -> None:
        for sample in self._samples():
            header, request = split_header(types.bytes_of(sample))
            try:
                asked = types.decode(self.name, request)
            except Exception:  # whatever another program wrote
                continue
            reply = types.encode(self._reply, self._answer(asked))
            self._writer.write(types.sample(self._writer.topic.data_type, with_header(header, reply)))


def split_header(data: bytes) -> tuple[bytes, bytes]:
    """The header of a request or reply, and the message without it. The header's 16 bytes move no alignment (of 8 at most)."""
    start = types.ENCAPSULATION_BYTES
    end = start + types.SERVICE_HEADER_BYTES
    return data[start:end], data[:start] + data[end:]


def with_header(header: bytes, data: bytes) -> bytes:
    start = types.ENCAPSULATION_BYTES
    return data[:start] + header + data[start:]


class Node:
    """One participant with one node. domain: ROS_DOMAIN_ID where it is None, else 0. Raises Error where DDS cannot begin."""

    def __init__(self, domain: int | None = None, *, name: str = "ovimap") -> None:
        number = _domain(domain)
        try:
            _begin(number)
            self._participant = DomainParticipant(number, qos=Qos(Policy.Userdata(b"enclave=/;")))
        except DDSException as fault:
            raise Error(f"DDS cannot begin in domain {number} ({fault}); check CYCLONEDDS_URI and that the machine has a network "
                        "interface that is up") from None
        self._waiting = WaitSet(self._participant)
        self._conditions: list[Any] = []
        self._name = name
        self._readers: list[bytes] = []
        self._writers: list[bytes] = []
        graph = Topic(self._participant, GRAPH_TOPIC, types.message_type(GRAPH))
        self._graph = Publisher(DataWriter(self._participant, graph, qos=_policies(LATCHED, _hash_data(GRAPH))), GRAPH)
        self._tell_graph()

    def publisher(self, name: str, topic: str, quality: Quality) -> Publisher:
        kind = types.message_type(name)
        return Publisher(self._writer(topic_of(topic), kind, quality, _hash_data(name)), name)

    def subscription(self, name: str, topic: str, quality: Quality) -> Subscription:
        reader = self._reader(topic_of(topic), types.message_type(name), quality, _hash_data(name))
        return Subscription(reader, name, qualified(topic))

    def service(self, name: str, service: str, answer: Callable[[Any], Any]) -> Service:
        own = f"serviceid={_endpoint_id()};"
        path, request, reply = qualified(service), f"{name}_Request", f"{name}_Response"
        writer = self._writer(f"rr{path}Reply", types.service_type(reply), SERVICE, own + _hash_data(reply))
        reader = self._reader(f"rq{path}Request", types.service_type(request), SERVICE, own + _hash_data(request))
        return Service(reader, name, path, writer, answer)

    def client(self, name: str, service: str) -> Client:
        own = f"clientid={_endpoint_id()};"
        path, request, reply = qualified(service), f"{name}_Request", f"{name}_Response"
        writer = self._writer(f"rq{path}Request", types.service_type(request), SERVICE, own + _hash_data(request))
        reader = self._reader(f"rr{path}Reply", types.service_type(reply), SERVICE, own + _hash_data(reply))
        return Client(Subscription(reader, reply, path), writer, request)

    def wait(self, seconds: float) -> None:
        """Until a message comes to one of the subscriptions, or the time is over."""
        self._waiting.wait(duration(seconds=seconds))

    def _writer(self, topic: str, kind: Any, quality: Quality, user_data: str) -> Any:
        writer = DataWriter(self._participant, Topic(self._participant, topic, kind), qos=_policies(quality, user_data))
        self._writers.append(writer.guid.bytes)
        self._tell_graph()
        return writer

    def _reader(self, topic: str, kind: Any, quality: Quality, user_data: str) -> Any:
        reader = DataReader(self._participant, Topic(self._participant, topic, kind), qos=_policies(quality, user_data))
        condition = ReadCondition(reader, SampleState.Any | ViewState.Any | InstanceState.Any)
        self._waiting.attach(condition)
        self._conditions.append(condition)  # they live as long as somebody holds them
        self._readers.append(reader.guid.bytes)
        self._tell_graph()
        return reader

    def _tell_graph(self) -> None:
        """Says which readers and writers are this node's, for `ros2 node list` and the like."""
        mine = types.make("rmw_dds_common/msg/NodeEntitiesInfo", node_namespace="/", node_name=self._name,
                          reader_gid_seq=[_gid(one) for one in self._readers], writer_gid_seq=[_gid(one) for one in self._writers])
        self._graph.publish(types.make(GRAPH, gid=_gid(self._participant.guid.bytes), node_entities_info_seq=[mine]))


class Client:
    """Asks a service; for programs without ROS, and for tests."""

    def __init__(self, replies: Subscription, writer: Any, name: str) -> None:
        self._replies, self._writer, self._name = replies, writer, name
        self._id = uuid.uuid4().bytes[:8]
        self._asked = 0

    @property
    def ready(self) -> bool:
        return bool(self._writer.get_matched_subscriptions()) and self._replies.publishers > 0

    def ask(self, request: Any) -> int:
        """Sends a request; returns its number."""
        self._asked += 1
        header = self._id + self._asked.to_bytes(8, "little")
        self._writer.write(types.sample(self._writer.topic.data_type, with_header(header, types.encode(self._name, request))))
        return self._asked

    def answers(self) -> Iterator[tuple[int, Any]]:
        """(number of the request, reply) of what came since, to this client."""
        for sample in self._replies._samples():
            header, reply = split_header(types.bytes_of(sample))
            if header[:8] == self._id:
                yield int.from_bytes(header[8:], "little"), types.decode(self._replies.name, reply)


def _gid(guid: bytes) -> Any:
    return types.make("rmw_dds_common/msg/Gid", data=np.frombuffer(guid, np.uint8))


@functools.cache
def _begin(number: int) -> Domain:
    """Once a process and domain; what CYCLONEDDS_URI says stands before ours."""
    return Domain(number, ",".join(filter(None, (os.environ.get("CYCLONEDDS_URI"), SETTINGS))))


def _hash_data(name: str) -> str:
    return f"typehash={types.type_hash(name)};"


def _endpoint_id() -> str:
    return ".".join(f"{byte:x}" for byte in uuid.uuid4().bytes)


def _domain(given: int | None) -> int:
    text = str(given) if given is not None else os.environ.get("ROS_DOMAIN_ID") or "0"
    if not text.isdigit() or int(text) > MOST_DOMAIN:
        raise Error(f"'{text}' is no domain of DDS; give a number from 0 to {MOST_DOMAIN}, as --domain or in ROS_DOMAIN_ID")
    return int(text)
