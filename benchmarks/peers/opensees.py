"""OpenSees: cables of co-rotational trusses with an initial strain, on a platform of rigid links or stiff beams.

Nodes stand on the start parabola; each truss gets the stiffness and the initial strain that make its tension
EA (l / L0 - 1) with L0 of the cable's unstrained length. Half of the mass is lumped and half consistent: the leading
errors of the two cancel, so that frequencies converge with the fourth power, not the second.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

import cdpr_struct.fem_reference as fem
from benchmarks.held_cable import GRAVITY, HeldCable
from benchmarks.peers import load

Arms = Literal["rigid link", "stiff beam"]
_BEAM = 1e11  # [N], [N m^2] of the beams that stand for rigid arms
_PLATFORM = 1


@dataclass
class Model:
    """The one model that OpenSees holds, being built; tags are handed out in turn."""

    ops: Any
    degrees: int
    node: int = _PLATFORM
    element: int = 0

    @classmethod
    def empty(cls, degrees: int) -> "Model":
        """degrees : 3 without, 6 with a platform."""
        ops = load("OpenSeesPy")
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", degrees)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        return cls(ops, degrees)

    def add_cable(self, cable: HeldCable, elements: int, held_end: bool) -> int:
        """Trusses from start to end; returns the tag of the end node."""
        nodes, _ = cable.parabola(elements)
        spans = np.linalg.norm(np.diff(nodes, axis=0), axis=1).tolist()
        bar = cable.unstrained_length / elements
        mass = cable.linear_density * bar
        for i, place in enumerate(nodes.tolist()):
            share = 0.5 if i in (0, elements) else 1.0
            self._add_node(place, share * mass, held=i == 0 or (held_end and i == elements), last=i == elements)
            if i:
                self._add_truss(cable, bar, spans[i - 1])
        return self.node

    def _add_node(self, place: list[float], mass: float, held: bool, last: bool) -> None:
        self.node += 1
        spare = self.degrees - 3
        self.ops.node(self.node, *place, "-mass", *[0.5 * mass] * 3, *[0.0] * spare)
        self.ops.load(self.node, 0.0, 0.0, -mass * GRAVITY, *[0.0] * spare)
        if held:
            self.ops.fix(self.node, *[1] * self.degrees)
        elif spare and not last:
            self.ops.fix(self.node, 0, 0, 0, 1, 1, 1)

    def _add_truss(self, cable: HeldCable, bar: float, span: float) -> None:
        self.element += 1
        plain, strained = 2 * self.element, 2 * self.element + 1
        self.ops.uniaxialMaterial("Elastic", plain, cable.axial_stiffness * span / bar)
        self.ops.uniaxialMaterial("InitStrainMaterial", strained, plain, 1.0 - bar / span)
        density = 0.5 * cable.linear_density * bar / span
        self.ops.element(
            "corotTruss", self.element, self.node - 1, self.node, 1.0, strained, "-rho", density, "-cMass", 1
        )  # fmt: skip

    def hold_to_platform(self, node: int, arms: Arms) -> None:
        """Tie a cable's end to the platform's node."""
        if arms == "rigid link":
            self.ops.rigidLink("beam", _PLATFORM, node)
            return
        self.element += 1
        self.ops.element(
            "elasticBeamColumn", self.element, _PLATFORM, node, 1.0, _BEAM, _BEAM, 1.0, 1.0, 1.0, 1
        )  # fmt: skip

    def frequencies(self, count: int) -> np.ndarray:
        """Statics under the weight, then the lowest frequencies [Hz]."""
        ops = self.ops
        ops.system("UmfPack")
        ops.numberer("RCM")
        ops.constraints("Transformation")
        ops.test("NormDispIncr", 1e-10, 50, 0)
        ops.algorithm("Newton")
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static", "-noWarnings")
        if ops.analyze(1) != 0:
            raise RuntimeError("OpenSees found no static equilibrium")
        return np.sqrt(ops.eigen(count)) / (2.0 * np.pi)


def cable_frequencies(cable: HeldCable, elements: int, count: int) -> np.ndarray:
    """Lowest frequencies of the clamped cable [Hz]."""
    model = Model.empty(3)
    model.add_cable(cable, elements, held_end=True)
    return model.frequencies(count)


def robot_frequencies(
    robot: fem.RobotData, position: np.ndarray, elements: int, count: int, arms: Arms = "stiff beam"
) -> np.ndarray:
    """Lowest frequencies of a robot whose platform is not turned, from its unstrained lengths [Hz]."""
    model, platform = Model.empty(6), robot.platform
    if np.any(platform.center_of_mass) or np.any(platform.inertia - np.diag(np.diag(platform.inertia))):
        raise ValueError("the benchmark's platforms have their centre of mass and main axes at the reference point")
    weight = [0.0, 0.0, -platform.mass * GRAVITY, 0.0, 0.0, 0.0]
    model.ops.node(
        _PLATFORM, *position.tolist(), "-mass", *[platform.mass] * 3, *np.diag(platform.inertia).tolist()
    )  # fmt: skip
    model.ops.load(_PLATFORM, *weight)
    if arms == "stiff beam":
        model.ops.geomTransf("Corotational", 1, 0.3, 0.1, 1.0)
    for start, arm, data in zip(robot.frame_anchors, robot.platform_anchors, robot.cables, strict=True):
        cable = HeldCable(start, position + arm, data.unstrained_length, data.axial_stiffness, data.linear_density)
        model.hold_to_platform(model.add_cable(cable, elements, held_end=False), arms)
    return model.frequencies(count)
