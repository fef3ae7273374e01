"""MoorPy: quasi-static lines, a body on lines, and its lumped-mass modes of one line."""

from typing import Any

import numpy as np
import scipy.linalg

from benchmarks.held_cable import GRAVITY, HeldCable
from benchmarks.peers import load
from cdpr_struct.robot.robot import Robot

SEA_LEVEL = 20.0  # MoorPy wants everything below the water line; the water has no density here
TOLERANCE = 1e-6  # [m]


def line_type(name: str, axial_stiffness: float, linear_density: float, gravity: float) -> dict[str, Any]:
    """A cable in MoorPy's words."""
    kind: dict[str, Any] = dict.fromkeys(("d_vol", "input_d"), 0.004)
    kind |= dict.fromkeys(("BA", "EAd", "EAd_Lm", "Cd", "CdAx", "cost", "Ca", "CaAx"), 0.0)
    kind |= {"name": name, "m": linear_density, "w": linear_density * gravity, "EA": axial_stiffness}
    return kind | {"input_type": "x", "material": "x", "MBL": 1e9}


def cable_frequencies(cable: HeldCable, elements: int, count: int) -> np.ndarray:
    """Lowest frequencies of the clamped cable [Hz], from the matrices that `Line.getModes` uses.

    `getModes` itself stops with a NameError in MoorPy 1.3.0. The stiffness is not symmetric: every row takes
    the tension of its own node.
    """
    system = load("MoorPy").System(depth=100.0, rho=0.0, g=GRAVITY)
    system.lineTypes["cable"] = line_type("cable", cable.axial_stiffness, cable.linear_density, GRAVITY)
    for place in (cable.start, cable.end):
        system.addPoint(1, place - [0.0, 0.0, SEA_LEVEL])
    system.addLine(cable.unstrained_length, "cable", nSegs=elements, pointA=1, pointB=2)
    system.initialize()
    one = np.ones(1)
    mass, _, _, stiffness, _, _ = system.lineList[0].getDynamicMatrices(one, one, 0.0, system.depth)
    inner = slice(3, -3)
    values = scipy.linalg.eigvals(stiffness[inner, inner], mass[inner, inner])
    return np.sqrt(np.sort(values.real)[:count]) / (2.0 * np.pi)


def robot_system(robot: Robot, pose: np.ndarray, lengths: np.ndarray) -> Any:
    """MoorPy model of a robot: a body on lines, in water without density."""
    shift = np.array([0.0, 0.0, -SEA_LEVEL])
    system = load("MoorPy").System(depth=100.0, rho=0.0, g=robot.gravity)
    for i, cable in enumerate(robot.cables):
        name = f"cable {i}"
        system.lineTypes[name] = line_type(name, cable.axial_stiffness, cable.linear_density, robot.gravity)
    system.addBody(0, np.r_[pose + shift, 0, 0, 0], m=robot.platform.mass, v=0.0, rCG=robot.platform.center_of_mass)
    for i, anchor in enumerate(robot.platform_anchors):
        system.addPoint(1, robot.frame_anchors[i] + shift)
        system.addPoint(1, pose + shift + anchor)
        system.bodyList[0].attachPoint(2 * i + 2, anchor)
        system.addLine(lengths[i], f"cable {i}", pointA=2 * i + 1, pointB=2 * i + 2)
    system.initialize()
    return system


def rest_position(system: Any, pose: np.ndarray) -> np.ndarray:
    """Equilibrium position started at a pose [m]; analytic stiffness, as MoorPy solves by default."""
    body = system.bodyList[0]
    body.setPosition(np.r_[pose - [0.0, 0.0, SEA_LEVEL], 0, 0, 0])
    system.solveEquilibrium(tol=TOLERANCE, maxIter=500, no_fail=False, finite_difference=False)
    return np.asarray(np.array([0.0, 0.0, SEA_LEVEL]) + body.r6[:3])
