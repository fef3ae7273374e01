"""The robot as it was really built: numbers off by the tolerances, straight from their definition, for the FEM."""

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct import Robot


def drawn_true_robot(rng: np.random.Generator, robot: Robot, lengths: np.ndarray) -> fem.RobotData:
    """A robot whose numbers are off; winches where those of the robot as entered are.

    lengths : (m,) paid out by the robot as entered [m]

    The tolerances of the robot are standard deviations: of each anchor's coordinates at both ends, of the zero of each
    cable's length, of the logarithm of EA and mu (half of that variance is common to all cables), of mass and centre
    of mass, of the logarithm of the inertia about each axis, and of each pulley's radius.
    """
    size, m = robot.tolerances, len(robot.cables)
    body, normal = robot.platform, rng.standard_normal

    def from_one_reel(sigma: float) -> np.ndarray:
        return np.exp(sigma * (normal(m) + normal()) / np.sqrt(2.0))

    paid = lengths + size["length_m"] * normal(m)
    stiff = robot.axial_stiffness * from_one_reel(size["axial_stiffness"])
    heavy = robot.linear_density * from_one_reel(size["linear_density"])
    grown = np.diag(np.exp(0.5 * size["platform_inertia"] * normal(3)))
    pulleys = tuple(
        None if one is None else fem.PulleyData(one.radius + size["pulley_radius_m"] * normal(), np.array(one.axis))
        for one in robot.pulleys
    )
    return fem.RobotData(
        robot.frame_anchors + size["anchor_m"] * normal((m, 3)),
        robot.platform_anchors + size["anchor_m"] * normal((m, 3)),
        tuple(fem.CableData(float(a), float(b), float(c)) for a, b, c in zip(paid, stiff, heavy, strict=True)),
        fem.PlatformData(
            body.mass + size["platform_mass_kg"] * normal(),
            body.center_of_mass + size["center_of_mass_m"] * normal(3),
            grown @ body.inertia @ grown,
        ),
        np.array([0.0, 0.0, -robot.gravity]),
        pulleys,
    )
