"""A suspended receiver like that of a 500 m radio telescope, from typical published sizes.

Typical: six towers on a circle of 600 m, cable heads about 280 m above the lowest point of the dish, steel cables of
46 mm (about 8.7 kg/m, EA near 1.5e8 N), a feed cabin of 30 t and some 13 m across; as in descriptions of the
Five-hundred-metre Aperture Spherical Telescope. The centre of mass, 3.5 m below the cables' ring, is an assumption.
"""

import numpy as np

from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot


def fast_like() -> Robot:
    """Radial 6-6 robot."""
    angle = np.arange(6) * np.pi / 3.0
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(6)], axis=1)
    platform = Platform(30000.0, np.array([0.0, 0.0, -3.5]), np.diag([2.5e5, 2.5e5, 4.0e5]))
    frame = 300.0 * ring + [0.0, 0.0, 280.0]
    home = Pose(np.array([0.0, 0.0, 145.0]), np.zeros(3))
    return Robot("fast-like", platform, (Cable(1.5e8, 8.7),) * 6, 6.5 * ring, frame, home=home)


def few_cables(count: int) -> Robot:
    """A platform of 20 kg under three to five cables, its centre of mass off every plane of symmetry."""
    angle = 2.0 * np.pi * np.arange(count) / count + 0.2
    inner = angle + 0.5 * (-1.0) ** np.arange(count)
    ring, own = (np.stack([np.cos(a), np.sin(a), np.zeros(count)], axis=1) for a in (angle, inner))
    platform = Platform(20.0, np.array([0.03, -0.02, -0.2]), np.diag([0.8, 0.9, 1.1]))
    return Robot("few", platform, (Cable(2e5, 0.03),) * count, 0.3 * own, 4.0 * ring + [0.0, 0.0, 3.0])
