"""A cable cut into bars, and what is known of it once it hangs still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cdpr_struct.fem_reference.bar_element import MassModel, bar_mass, bar_stiffness
from cdpr_struct.fem_reference.pulley import Wrap
from cdpr_struct.fem_reference.sliding_bar import Eyelet
from cdpr_struct.fem_reference.winch import Winch


@dataclass(frozen=True)
class CableData:
    """Uniform elastic cable.

    unstrained_length : L [m]
    axial_stiffness   : EA [N]
    linear_density    : mu [kg/m], per unstrained length
    line_give         : compliance [m/N] of what is elastic in line behind the start: joint, load cell, dead cable
    winch_tension     : [N] that a winch holds at the start, the length then being a guess; 0 where it holds the length
    drag_width        : [m], drag coefficient times diameter, on which wind presses
    lumps             : pairs of a distance from the end, unstrained [m], and a mass [kg] that sits there; between two
                        nodes it is shared as on a lever
    """

    unstrained_length: float
    axial_stiffness: float
    linear_density: float
    line_give: float = 0.0
    winch_tension: float = 0.0
    drag_width: float = 0.0
    lumps: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        for name in ("unstrained_length", "axial_stiffness", "linear_density"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ValueError(f"CableData.{name} must be positive and finite, got {getattr(self, name)!r}")
        for name in ("line_give", "winch_tension", "drag_width"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise ValueError(f"CableData.{name} must be zero or more, got {getattr(self, name)!r}")

    def node_lumps(self, elements: int) -> np.ndarray:
        """Masses (n + 1,) [kg] that sit on the nodes of a mesh, start to end."""
        masses = np.zeros(elements + 1)
        for distance, mass in self.lumps:
            place = elements * (1.0 - min(distance / self.unstrained_length, 1.0))
            first = min(int(place + 1e-9), elements - 1)
            masses[first] += mass * (first + 1.0 - place)
            masses[first + 1] += mass * (place - first)
        return masses

    @property
    def path_behind(self) -> float:
        """Length [m] of a cable that gives way like what is in line behind the start."""
        return self.line_give * self.axial_stiffness

    @property
    def mass(self) -> float:
        """Mass [kg] of the whole cable."""
        return self.linear_density * self.unstrained_length


@dataclass(frozen=True, eq=False)
class CableEquilibrium:
    """A cable of n bars at rest between two held ends; at the first it may slide, over a pulley or through an eyelet.

    cable            : the data it was solved for, of what lies beyond its start
    node_load        : (3,) [N], world, weight and wind on each free node
    nodes            : (n + 1, 3) [m], world, from start to end
    tension_vectors  : (n, 3) [N], world, pull of each bar along its way from start to end
    start_force      : (3,) [N], applied to the cable at its start to hold it
    end_force        : (3,) [N], applied to the cable at its end to hold it
    residual_norm    : largest force [N] left over at an interior node, evaluated from `nodes` alone
    iterations       : Newton steps spent
    wrap             : where it lies on its pulley, or the eyelet or winch from which it slides, None if it is held
    """

    cable: CableData
    node_load: np.ndarray
    nodes: np.ndarray
    tension_vectors: np.ndarray
    start_force: np.ndarray
    end_force: np.ndarray
    residual_norm: float
    iterations: int
    wrap: Wrap | Eyelet | Winch | None = None

    @property
    def elements(self) -> int:
        """Number n of bars."""
        return len(self.tension_vectors)

    @property
    def element_length(self) -> float:
        """Unstrained length [m] of one bar."""
        return self.cable.unstrained_length / self.elements

    @property
    def tensions(self) -> np.ndarray:
        """Tension (n,) [N] of every bar."""
        return np.linalg.norm(self.tension_vectors, axis=-1)

    @property
    def residual_floor(self) -> float:
        """Smallest `residual_norm` [N] that nodes stored in float64 can show: EA eps max|x| / L0."""
        reach = max(float(np.abs(self.nodes).max()), self.element_length)
        return self.cable.axial_stiffness * float(np.finfo(float).eps) * reach / self.element_length

    @property
    def wrap_angle(self) -> float:
        """Angle [rad] by which the pulley turns the cable; zero without a pulley.

        `wrap.angle`, where the first bar leaves, is behind by half the turn of a bar. The pull at the exit
        corrects that, and also the turn of the cable over the distance by which the exit then shifts.
        """
        if not isinstance(self.wrap, Wrap):
            return 0.0
        pull, bar = -self.start_force, self.element_length * (1.0 + self.tensions[0] / self.cable.axial_stiffness)
        late = float(np.arctan2(pull @ self.wrap.outward, pull @ self.wrap.pulley.axis)) - self.wrap.angle
        return self.wrap.angle + late / (1.0 + 2.0 * self.wrap.pulley.radius * late / float(bar))

    def element_stiffness(self) -> np.ndarray:
        """Tangent stiffness (n, 6, 6) [N/m] of every bar in this state.

        With a pulley the start node of the first bar is the held entry point, so that bar acts on its last
        node alone.
        """
        tensions, stiffness = self.tensions, self.cable.axial_stiffness
        matrices = bar_stiffness(
            self.tension_vectors / tensions[:, None],
            tensions,
            np.array(self.element_length),
            np.array(stiffness),
        )
        if self.wrap is not None:
            matrices[0] = self.wrap.first_bar_stiffness(float(tensions[0]), self.element_length, stiffness)
        return matrices

    def element_mass(self, mass: MassModel = "lumped") -> np.ndarray:
        """Mass matrix (n, 6, 6) [kg] of every bar; a start that slides moves as the first free node demands."""
        each = np.full(self.elements, self.cable.linear_density * self.element_length)
        matrices = bar_mass(each, mass)
        lumps = self.cable.node_lumps(self.elements)
        matrices[:, 3:, 3:] += lumps[1:, None, None] * np.eye(3)
        matrices[0, :3, :3] += lumps[0] * np.eye(3)
        if self.wrap is not None:
            state = float(self.tensions[0]), self.element_length, self.cable.axial_stiffness
            matrices[0] = self.wrap.first_bar_mass(matrices[0], *state)
        return matrices
