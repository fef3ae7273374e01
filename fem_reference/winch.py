"""The start of a cable whose winch pulls with a constant force, whatever length that takes.

The first bar slides through a held point. Its unstrained length f is free: the winch, which stores cable under the
tension T at that point, gives f away for (T + T^2 / 2 EA) f, half the weight of the bar rides on its end. With d the
vector along the bar, h half its weight per unstrained length,

    U(d, f) = EA (|d| - f)^2 / 2 f + (T + T^2 / 2 EA) f - h . d f,

and f is eliminated. Statics reaches T by rounds: about a length, the bar is made longer by a compliance times what its
tension is above the wanted one, which becomes length of the whole cable in the next round.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.sliding_bar import sliding_mass

SOFTER = 100.0  # compliance of the rounds over that of the cable


@dataclass(frozen=True, eq=False)
class Winch:
    """A held point, or one on a mast, where a cable comes from its winch.

    exit_point  : (3,) [m], world
    tension     : [N] that the winch holds there
    drawn       : [m] unstrained length paid out beyond the guessed one
    behind      : [m], length of a cable that gives way like the rounds do: the scale of their round-off
    direction   : (3,) unit vector along the first bar
    half_weight : (3,) [N], half the weight of the first bar
    """

    exit_point: np.ndarray
    tension: float
    drawn: float
    behind: float
    direction: np.ndarray
    half_weight: np.ndarray

    @classmethod
    def at(
        cls, point: np.ndarray, tension: float, drawn: float, length: float, first_bar: np.ndarray, weight: np.ndarray
    ) -> Winch:
        """With a first bar along `first_bar` (3,), half its weight (3,) [N], of a cable guessed `length` [m] long."""
        along = fixed_array("first_bar", first_bar / np.linalg.norm(first_bar), (3,))
        return cls(point, tension, drawn, SOFTER * length, along, weight)

    @property
    def bar_tension(self) -> float:
        """Tension [N] of the first bar, which carries half its weight less than the held point."""
        return self.tension - float(self.half_weight @ self.direction)

    @property
    def unstrained_length(self) -> float:
        """[m] of the cable behind the held point, if there were `behind` of it at first."""
        return self.behind - self.drawn

    def handed_on(self, bar: float) -> np.ndarray:
        """Nothing: the bar's weight rides on a point that only slides along it."""
        del bar
        return np.zeros(3)

    def first_bar_stiffness(self, tension: float, free_length: float, axial_stiffness: float) -> np.ndarray:
        """Stiffness (6, 6) [N/m] of the first bar between the held point and the first free node."""
        strain, tangent = 1.0 + tension / axial_stiffness, self.direction
        across = tension / (free_length * strain) * (np.eye(3) - np.outer(tangent, tangent))
        weight = self.half_weight / free_length
        riding = (np.outer(tangent, weight) + np.outer(weight, tangent)) / strain
        riding += np.outer(weight, weight) * free_length / (axial_stiffness * strain**2)
        block = across - riding
        return np.block([[block, -block], [-block, block]])

    def first_bar_mass(
        self, mass: np.ndarray, tension: float, free_length: float, axial_stiffness: float
    ) -> np.ndarray:
        """Mass (6, 6) [kg] of the first bar from that of a bar with held ends: along itself it moves as a whole."""
        del tension, free_length, axial_stiffness
        return sliding_mass(mass, self.direction, 1.0)
