"""What a recording holds: channels of numbers, read in pieces so that a large file need not fit into memory."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

Clock = Literal["", "file", "stamp", "received"]
"""Where a sample's time comes from: nowhere, the file, the message's own header, or the recorder's receipt of it."""


@dataclass(frozen=True, slots=True)
class Channel:
    """A channel of numbers.

    name  : of its own in the recording;  unit : as the file says it, "" if it does not
    group : channels of one group have their samples in common: a table, a topic, a group of the file
    clock : where the time of its samples comes from; "" if another channel has to say it
    """

    name: str
    group: str = ""
    unit: str = ""
    clock: Clock = ""


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Consecutive samples (n,) of a channel, and their times (n,) [s] if the file says these."""

    channel: str
    values: np.ndarray
    time: np.ndarray | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Recording(ABC):
    """A file, or a folder, of one of the forms that can be read.

    form : what it is, for people
    """

    path: Path
    form: str
    channels: tuple[Channel, ...]

    @abstractmethod
    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        """Samples of the named channels, those of each channel in their order.

        Raises
        ------
        InputError : the file is damaged.
        """
