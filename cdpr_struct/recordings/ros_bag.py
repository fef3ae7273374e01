"""Recordings as ROS bags: ROS 1, ROS 2 (SQLite and MCAP), and single MCAP files of ROS messages."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Channel, Clock, Piece, Recording
from cdpr_struct.recordings.form import CALLED, Form
from cdpr_struct.recordings.library import library, reading
from cdpr_struct.recordings.ros_message import Reading, readings

_PROBED = 50  # messages of each topic from which its channels are told
_ROWS = 4096  # samples of a channel in a piece
_NANOSECOND = 1e-9
_TOPIC_END = "."


@dataclass(frozen=True, slots=True, eq=False)
class RosBag(Recording):
    """A bag.

    clock : `stamp`, the times of the messages' headers where they have one, or `received`, those of the recorder
    """

    clock: Clock

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        topics = {channel.group for channel in self.channels if channel.name in names}
        found: dict[str, list[tuple[float, float]]] = {name: [] for name in names}
        with reading(self.path, self.form), _open(self.path, self.form) as bag:
            connections = [c for c in bag.connections if c.topic in topics]
            for connection, received, raw in bag.messages(connections) if connections else ():
                for one in _read(bag, connection, raw):
                    name = connection.topic + _TOPIC_END + one.name
                    if name in found:
                        found[name].append((_time(one, received, bag.start_time, self.clock), one.value))
                        if len(found[name]) == _ROWS:
                            yield _piece(name, found[name])
                            found[name] = []
        for name, rest in found.items():
            if rest:
                yield _piece(name, rest)


def _piece(name: str, samples: list[tuple[float, float]]) -> Piece:
    time, values = np.array(samples).T
    return Piece(name, values, time)


def _time(one: Reading, received: int, start: int, clock: Clock) -> float:
    """Time of a reading [s] since the bag began; the difference is taken in whole nanoseconds."""
    return ((one.stamp if one.stamp and clock == "stamp" else received) - start) * _NANOSECOND


def _read(bag: Any, connection: Any, raw: bytes) -> Iterator[Reading]:
    return readings(bag.deserialize(raw, connection.msgtype))


def _open(path: Path, form: str) -> Any:
    """The bag; definitions of messages that it does not bring are those of the newest ROS 2."""
    bags, types = library("rosbags.highlevel", form, path), library("rosbags.typesys", form, path)
    return bags.AnyReader([path], default_typestore=types.get_typestore(types.Stores.LATEST))


def open_bag(path: Path, form: Form, clock: Clock = "stamp") -> RosBag:
    """The bag of a file or folder.

    Raises
    ------
    InputError : rosbags is not installed, the bag is damaged or empty, or no message has a number.
    """
    called = CALLED[form]
    channels: dict[str, Channel] = {}
    with reading(path, called), _open(path, called) as bag:
        if not bag.message_count:
            raise InputError(str(path), "", f"{called} without a message", "a bag in which something was recorded")
        topics, kinds = {c.topic for c in bag.connections}, {c.msgtype for c in bag.connections}
        for topic in sorted(topics):
            connections = [c for c in bag.connections if c.topic == topic]
            for connection, _, raw in islice(bag.messages(connections), _PROBED):
                for one in _read(bag, connection, raw):
                    name = topic + _TOPIC_END + one.name
                    own: Clock = "stamp" if one.stamp and clock == "stamp" else "received"
                    channels.setdefault(name, Channel(name, topic, "", own))
    if not channels:
        expected = "messages with numbers, such as geometry_msgs/PoseStamped or sensor_msgs/JointState"
        raise InputError(str(path), "", f"messages without numbers ({', '.join(sorted(kinds))})", expected)
    return RosBag(path, called, tuple(channels.values()), clock)
