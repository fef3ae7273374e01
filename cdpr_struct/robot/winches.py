"""Winches that hold lengths: one for each cable, or one that winds several cables together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.cable import Cable


@dataclass(frozen=True, slots=True, eq=False)
class Winches:
    """w winches that hold lengths, in the order of their first cables. What one says is the length of its first cable.

    names  : (w,) as in the robot file; "cable 3" for the own winch of cable 3
    cables : (w,) tuples of the cables on it, numbers from 1
    share  : (m, w) length wound of a cable over that of the first one on its winch, 0 where it is on another
    offset : (m,) unstrained length of a cable where its winch would say nothing [m]; 1 m where a winch holds a tension,
             which takes what length it needs
    home   : (w,) what the winch says at home [m], 0 where no home length is known
    """

    names: tuple[str, ...]
    cables: tuple[tuple[int, ...], ...]
    share: np.ndarray
    offset: np.ndarray
    home: np.ndarray

    @classmethod
    def of(cls, cables: Sequence[Cable]) -> "Winches":
        """Those of a robot's cables; of winches that hold tensions there are none."""
        groups: dict[str | int, list[int]] = {}
        for number, cable in enumerate(cables, start=1):
            if not cable.winch_tension:
                groups.setdefault(cable.winch or number, []).append(number)
        share = np.zeros((len(cables), len(groups)))
        offset = np.array([1.0 if cable.winch_tension else 0.0 for cable in cables])
        for column, numbers in enumerate(groups.values()):
            rows = np.array(numbers) - 1
            ratio, home = np.array([(cables[row].winch_ratio, cables[row].home_length) for row in rows]).T
            share[rows, column] = ratio / ratio[0]
            offset[rows] = home - share[rows, column] * home[0]
        home = np.array([cables[numbers[0] - 1].home_length for numbers in groups.values()])
        names = tuple(key if isinstance(key, str) else f"cable {key}" for key in groups)
        return cls(names, tuple(map(tuple, groups.values())), share, offset, home)

    @property
    def count(self) -> int:
        """w."""
        return len(self.names)

    def lengths(self, said: np.ndarray) -> np.ndarray:
        """(..., m) unstrained lengths of the cables where the winches say `said` (..., w) [m]."""
        return said @ self.share.T + self.offset

    def said(self, lengths: np.ndarray) -> np.ndarray:
        """(..., w) what winches say that fits unstrained lengths (..., m) best, of equal ratios the mean [m]."""
        return np.asarray(((lengths - self.offset) @ self.share) / (self.share**2).sum(axis=0))

    def apart(self, lengths: np.ndarray) -> np.ndarray:
        """(..., m) by how much lengths (..., m) differ from what their winches can have wound [m]; 0 where a winch
        holds a tension."""
        there = self.share.any(axis=1)
        return np.where(there, lengths - self.lengths(self.said(lengths)), 0.0)


def winches_fault(cables: Sequence[Cable]) -> str:
    """What is wrong with the winches that several cables share, "" if nothing."""
    for number, cable in enumerate(cables, start=1):
        if not cable.winch.isprintable():
            return f"cables[{number}].winch: give a name of printable characters on one line"
        if cable.winch and cable.winch_tension:
            return f"cables[{number}]: a winch that holds a tension winds one cable; leave out winch or winch_tension"
        for name, own in (("home_length", 0.0), ("winch_ratio", 1.0)):
            if getattr(cable, name) != own and not cable.winch:
                return f"cables[{number}].{name} belongs to `winch`; leave it out"
    for name in dict.fromkeys(cable.winch for cable in cables if cable.winch):
        known = [bool(cable.home_length) for cable in cables if cable.winch == name]
        if any(known) and not all(known):
            return f"winch {name}: give home_length for all of its cables, or for none"
    return ""
