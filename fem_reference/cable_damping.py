"""How strongly are cables damped? A viscous force on every cable node, in proportion to its mass."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.cable_modes import first_omega
from cdpr_struct.fem_reference.robot import RobotEquilibrium


def damping_rates(
    equilibrium: RobotEquilibrium, damping_ratio: ArrayLike | None, mass: MassModel = "lumped"
) -> np.ndarray:
    """Damping force per mass and velocity of every cable, alpha = 2 xi omega_1, (m,) [1/s].

    damping_ratio : xi [-], one for all cables or (m,), or None for none. omega_1 is the first frequency of each
    cable with its platform end held, as this model finds it, pulley included.

    Raises
    ------
    ValueError : a negative ratio, or neither one nor m of them.
    """
    count = len(equilibrium.cables)
    if damping_ratio is None:
        return np.zeros(count)
    ratios = np.asarray(damping_ratio, dtype=float)
    if ratios.shape not in ((), (count,)) or not (ratios >= 0.0).all():
        raise ValueError(f"damping_ratio must be one or {count} numbers of at least 0, got {damping_ratio!r}")
    if not ratios.any():
        return np.zeros(count)
    return 2.0 * ratios * np.array([first_omega(cable, mass) for cable in equilibrium.cables])
