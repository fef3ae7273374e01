"""Modes of robots at rest as their cables' expansion spans them, and the gradient of omega^2 of any combination."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel, StaticCables, expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.internal_mass import internal_omega, present
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.observation.cable_fields import fields_of_expansion, massless_fields
from cdpr_struct.observation.dependence import BENDING, TIGHTENED, Dependence
from cdpr_struct.observation.mode_gradient import CableGradient, cable_gradient, whole_gradient
from cdpr_struct.statics.masts import MastShapes

_STATIC_ORDER = 16  # of Gauss points along massless cables


@dataclass(frozen=True, slots=True, eq=False)
class ExpandedModes:
    """Modes of the robot in states (F,), without neutral freedoms.

    shapes : of unit modal mass;  dependence : what they depend on
    order, expansion : of the cables; None where these have no mass
    """

    point: OperatingPoint
    shapes: RitzModes
    dependence: Dependence
    order: int | None
    expansion: ModalExpansion | None

    @classmethod
    def at(
        cls, point: OperatingPoint, highest: float, assembly: Assembly, model: CableModel, fine: bool = False
    ) -> "ExpandedModes":
        """Modes below `highest` [rad/s]; of massless cables all.

        fine : frequencies to all digits and gradients to seven, not to six and five

        Raises
        ------
        UnstableEquilibriumError : a state is unstable.
        ValueError : the model is neither "exact" nor "static".
        """
        now = Dependence.of(point, assembly)
        if model == "static":
            inner = len(present(point.arrays))
            shapes = ritz_modes(point, StaticCables(point).expansion(0.0), 6 + inner, assembly).above_zero
            return cls(point, shapes, now, None, None)
        if model == "exact":
            return cls(point, *_catenary_modes(point, highest, assembly, now, fine))
        raise ValueError(f"model must be 'exact' or 'static', got {model!r}")

    def gradient(self, shapes: RitzModes | None = None) -> np.ndarray:
        """(F, n, k) of omega^2 by `Dependence.vector`, of these modes or of combinations of them."""
        modes = self.shapes if shapes is None else shapes
        arrays = self.point.arrays
        own = self._of_cables(modes)
        return whole_gradient(own, MastShapes.of(arrays), modes, internal_omega(arrays))

    def mixed(self, first: np.ndarray, second: np.ndarray, sign: float) -> RitzModes:
        """(F, k) sums (sign 1) or differences (-1) of two modes each, of unit modal mass, at their mean omega^2.

        first, second : (k,) indices of modes
        """
        one, other = self.shapes.modes(first), self.shapes.modes(second)
        names = ("platform", "end", "mast", "modal", "internal")
        sums = {name: (getattr(one, name) + sign * getattr(other, name)) / np.sqrt(2.0) for name in names}
        return replace(one, omega=np.sqrt(0.5 * (one.omega**2 + other.omega**2)), **sums)

    def _of_cables(self, shapes: RitzModes) -> CableGradient:
        cables, turn, squared = self.dependence.cables, shapes.platform[..., 3:], shapes.omega**2
        if self.order is None or self.expansion is None:
            return _massless_gradient(self.point, shapes, cables)
        expanded = (self.point, self.order, self.expansion, shapes.end)
        fields = fields_of_expansion(*expanded, shapes.modal, shapes.mast)
        own = cable_gradient(cables, fields, squared, turn)
        if not self.point.arrays.bending_stiffness.any():
            return own
        static = fields_of_expansion(*expanded, 0.0 * shapes.modal, shapes.mast).at_rest
        bent = cable_gradient(cables, static, 0.0 * squared, turn)
        return own.plus(bent, -1.0).plus(_massless_gradient(self.point, shapes, cables))  # K(0) knows no bending


def _catenary_modes(
    point: OperatingPoint, highest: float, assembly: Assembly, now: Dependence, fine: bool
) -> tuple[RitzModes, Dependence, int, ModalExpansion]:
    smooth = not (point.arrays.bending_stiffness.any() or point.arrays.added_mass.any())
    order = polynomial_order(point, highest, rough=smooth and not fine)
    expansion = expand_catenaries_at(point, order)
    if not (
        fine or point.arrays.has_masts
    ):  # the reduction keeps how cables answer the platform, not how they answer masts
        expansion = expansion.reduced(highest)
    below = (expansion.omega_squared < highest**2).sum(axis=(-2, -1)).max()
    shapes = ritz_modes(point, expansion, int(below) + beyond_cables(point), assembly).above_zero
    count = max(1, int((shapes.omega < highest).sum(axis=-1).max()))
    return shapes.modes(slice(0, count)), now, order, expansion


def beyond_cables(point: OperatingPoint) -> int:
    """By how many the robot's modes below a frequency exceed those of its clamped cables at most: Wittrick's count."""
    arrays = point.arrays
    return 6 + 3 * arrays.cable_count * int(arrays.has_masts) + len(present(arrays))


def _massless_gradient(point: OperatingPoint, shapes: RitzModes, cables: np.ndarray) -> CableGradient:
    """Of the energy in cables without mass that do not resist bending, at the ends' motion of these modes."""
    frame, local = shapes.expansion.frame, shapes.expansion.static_stiffness
    force = ((frame @ local)[..., None, :, :, :] @ shapes.end[..., None])[..., 0]
    flexible = cables.copy()
    flexible[..., [TIGHTENED, BENDING]] = 1.0, 0.0
    fields = massless_fields(point, _STATIC_ORDER, force)
    found = cable_gradient(flexible, fields, 0.0 * shapes.omega, shapes.platform[..., 3:])
    found.columns[..., [TIGHTENED, BENDING]] = 0.0
    return found
