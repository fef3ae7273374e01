"""Exudyn: cables of ANCF elements or of mass points and springs, on a rigid body, with its own statics.

Every cable is built with its unstrained length. The platform's ends are held by stiff springs or by ideal joints
(Exudyn's `SphericalJoint`). The linearised system is Exudyn's; of the eigenvalues only as many are solved as are asked
for (SciPy's `eigh`), which is faster than Exudyn's call that solves them all.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
import scipy.linalg

import cdpr_struct.fem_reference as fem
from benchmarks.held_cable import GRAVITY, HeldCable
from benchmarks.peers import load

Joint = Literal["spring", "ideal"]
Element = Literal["ANCF", "points"]
SPRING = 1e10
"""[N/m] of the springs that stand for joints: softer ones change the cable, stiffer ones bury it in round-off."""


@dataclass(frozen=True, eq=False)
class Model:
    """An Exudyn system being built."""

    exudyn: Any
    items: Any
    container: Any
    system: Any
    ground: Any

    @classmethod
    def empty(cls) -> "Model":
        exudyn = load("Exudyn")
        import exudyn.itemInterface as items

        container = exudyn.SystemContainer()
        system = container.AddSystem()
        return cls(exudyn, items, container, system, system.AddObject(items.ObjectGround()))

    def point_of(self, body: Any, place: np.ndarray) -> Any:
        return self.system.AddMarker(self.items.MarkerBodyPosition(bodyNumber=body, localPosition=place))

    def join(self, one: Any, other: Any, joint: Joint) -> None:
        """Hold two markers together."""
        both = [one, other]
        if joint == "ideal":
            self.system.AddObject(self.items.ObjectJointSpherical(markerNumbers=both))
        else:
            spring = self.items.ObjectConnectorCartesianSpringDamper(markerNumbers=both, stiffness=[SPRING] * 3)
            self.system.AddObject(spring)

    def add_ancf(self, cable: HeldCable, elements: int, start: Any, end: Any, joint: Joint) -> None:
        """Cubic elements between two markers; a node has six unknowns, its place first."""
        system, items = self.system, self.items
        places = np.hstack(cable.parabola(elements))
        nodes = [system.AddNode(items.NodePointSlope1(referenceCoordinates=place)) for place in places]
        for pair in pairwise(nodes):
            element = system.AddObject(
                items.ObjectANCFCable(
                    length=cable.unstrained_length / elements,
                    massPerLength=cable.linear_density,
                    axialStiffness=cable.axial_stiffness,
                    nodeNumbers=list(pair),
                )
            )
            self.weigh(element)
        for node, marker in ((nodes[0], start), (nodes[-1], end)):
            self.join(marker, system.AddMarker(items.MarkerNodePosition(nodeNumber=node)), joint)

    def add_points(self, cable: HeldCable, elements: int, start: Any, end: Any) -> None:
        """Mass points and springs between two markers; half a bar's weight on each of them, no mass."""
        system, items = self.system, self.items
        nodes, _ = cable.parabola(elements)
        bar = cable.unstrained_length / elements
        mass, markers = cable.linear_density * bar, [start]
        for place in nodes[1:-1]:
            node = system.AddNode(items.NodePoint(referenceCoordinates=place))
            system.AddObject(items.ObjectMassPoint(mass=mass, nodeNumber=node))
            markers.append(system.AddMarker(items.MarkerNodePosition(nodeNumber=node)))
        markers.append(end)
        for i, pair in enumerate(pairwise(markers)):
            system.AddObject(
                items.ObjectConnectorSpringDamper(
                    markerNumbers=list(pair), referenceLength=bar, stiffness=cable.axial_stiffness / bar
                )
            )
            share = mass if i < elements - 1 else 0.5 * mass
            load_ = items.LoadForceVector(markerNumber=pair[1], loadVector=[0.0, 0.0, -share * GRAVITY])
            system.AddLoad(load_)

    def weigh(self, body: Any) -> None:
        """Gravity on a body."""
        marker = self.system.AddMarker(self.items.MarkerBodyMass(bodyNumber=body))
        self.system.AddLoad(self.items.LoadMassProportional(markerNumber=marker, loadVector=[0.0, 0.0, -GRAVITY]))

    def rest(self, joint: Joint = "spring") -> Any:
        """Static equilibrium becomes the initial state; returns the settings.

        With springs of 1e10 N/m, 16 digits do not let the residual fall further than it is asked to.
        """
        self.system.Assemble()
        settings = self.exudyn.SimulationSettings()
        settings.linearSolver.solverType = self.exudyn.LinearSolverType.EigenSparse
        settings.solution.file.write = False
        settings.parallel.numberOfThreads = 1
        newton = settings.staticSolver.newton
        newton.relativeTolerance, newton.absoluteTolerance = (1e-7, 1e-3) if joint == "spring" else (1e-9, 1e-7)
        newton.useModifiedNewton = False
        settings.staticSolver.verboseMode = 0
        self.exudyn.SolveStatic(self.system, settings, updateInitialValues=True)
        return settings

    def lowest(
        self, settings: Any, count: int, added_mass: np.ndarray | None = None, held: tuple[int, ...] = ()
    ) -> np.ndarray:
        """Frequencies [Hz]; added_mass (6, 6) of the first six unknowns, held: unknowns that do not move."""
        mass, stiffness, _ = self.exudyn.ComputeLinearizedSystem(self.system, settings)
        if added_mass is not None:
            mass[:6, :6] += added_mass
        symmetric = 0.5 * (stiffness + stiffness.T)
        free = np.setdiff1d(np.arange(len(mass)), held)
        mass, symmetric = mass[np.ix_(free, free)], symmetric[np.ix_(free, free)]
        values = scipy.linalg.eigh(symmetric, mass, eigvals_only=True, subset_by_index=(0, count - 1))
        return np.sqrt(values) / (2.0 * np.pi)


def cable_frequencies(cable: HeldCable, elements: int, count: int, element: Element = "ANCF") -> np.ndarray:
    """Lowest frequencies of the clamped cable [Hz]."""
    model = Model.empty()
    ends = [model.point_of(model.ground, place) for place in (cable.start, cable.end)]
    if element == "points":
        model.add_points(cable, elements, *ends)
        return model.lowest(model.rest(), count)
    model.add_ancf(cable, elements, *ends, joint="ideal")
    last = 6 * elements
    return model.lowest(model.rest("ideal"), count, held=(0, 1, 2, last, last + 1, last + 2))


def robot_frequencies(
    robot: fem.RobotData,
    position: np.ndarray,
    elements: int,
    count: int,
    joint: Joint = "spring",
    element: Element = "ANCF",
) -> np.ndarray:
    """Lowest frequencies of a robot whose platform is not turned, from its unstrained lengths [Hz]."""
    model, body = _with_platform(robot, position)
    added = np.zeros((6, 6))
    for start, arm, data in zip(robot.frame_anchors, robot.platform_anchors, robot.cables, strict=True):
        cable = HeldCable(start, position + arm, data.unstrained_length, data.axial_stiffness, data.linear_density)
        markers = model.point_of(model.ground, start), model.point_of(body, arm)
        if element == "ANCF":
            model.add_ancf(cable, elements, *markers, joint=joint)
        else:
            model.add_points(cable, elements, *markers)
            added += 0.5 * data.mass / elements * _point_mass(arm)
    settings = model.rest(joint)
    if joint == "ideal":
        values, _ = model.exudyn.ComputeODE2Eigenvalues(model.system, settings, numberOfEigenvalues=count)
        return np.sqrt(values) / (2.0 * np.pi)
    return model.lowest(settings, count, added)


def _with_platform(robot: fem.RobotData, position: np.ndarray) -> tuple[Model, Any]:
    """A model with the rigid body; its node's six unknowns come first."""
    model, platform = Model.empty(), robot.platform
    if np.any(platform.center_of_mass):
        raise ValueError("the benchmark's platforms have their centre of mass at the reference point")
    j = platform.inertia
    node = model.system.AddNode(model.items.NodeRigidBodyRxyz(referenceCoordinates=[*position.tolist(), 0.0, 0.0, 0.0]))
    inertia = [j[0, 0], j[1, 1], j[2, 2], j[1, 2], j[0, 2], j[0, 1]]
    body = model.system.AddObject(model.items.ObjectRigidBody(mass=platform.mass, inertia=inertia, nodeNumber=node))
    model.weigh(body)
    return model, body


def _point_mass(arm: np.ndarray) -> np.ndarray:
    """(6, 6) of a unit point mass on a rigid body that is not turned."""
    x, y, z = arm
    motion = np.hstack([np.eye(3), [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]])
    return motion.T @ motion
