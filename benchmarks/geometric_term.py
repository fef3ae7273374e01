"""Which codes know that a cable's force turns with the arm it pulls at?

    python -m benchmarks geometric-term

A platform that turns carries its anchors along: the static cable force times the lever arm is a stiffness. Eq. (3.8) of
the thesis leaves it out, and so do joints and rigid links of other codes. No refinement removes that error. Each way to
hold cables to the platform is refined until it stands, and compared with the converged finite elements, and with our
model with the term (`consistent`) and without it (`thesis`).
"""

from collections.abc import Callable

import numpy as np

import cdpr_struct.fem_reference as fem
from benchmarks.markdown_page import table
from benchmarks.peers import exudyn_cables, moorpy_lines, opensees, present
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.robot_modes import POSITION
from benchmarks.robot_reference import converged_frequencies
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

COUNT = 40
WAYS: dict[str, tuple[str, Callable[[fem.RobotData, int], np.ndarray]]] = {
    "Exudyn, ideal joints (`SphericalJoint`)": (
        "Exudyn", lambda data, count: exudyn_cables.robot_frequencies(data, POSITION, 16, count, "ideal"),
    ),
    "Exudyn, springs of 1e10 N/m for joints": (
        "Exudyn", lambda data, count: exudyn_cables.robot_frequencies(data, POSITION, 16, count, "spring"),
    ),
    "OpenSees, `rigidLink`": (
        "OpenSeesPy", lambda data, count: opensees.robot_frequencies(data, POSITION, 128, count, "rigid link"),
    ),
    "OpenSees, stiff co-rotational beams": (
        "OpenSeesPy", lambda data, count: opensees.robot_frequencies(data, POSITION, 128, count, "stiff beam"),
    ),
}  # fmt: skip


class GeometricTerm:
    """asv-shaped: errors, not times."""

    params = tuple(WAYS)
    param_names = ("way",)

    def setup(self, way: str, count: int = COUNT) -> None:
        self.count, self.robot = count, load_robot("thesis-3-1")
        cables = inverse(self.robot, POSITION, np.eye(3)).cables
        self.point = OperatingPoint(self.robot, POSITION, np.eye(3), cables)
        self.data = to_fem(self.robot, cables.total_length)

    def frequencies(self, way: str) -> np.ndarray:
        return WAYS[way][1](self.data, self.count)

    def track_error(self, way: str) -> float:
        """Largest relative distance from the converged finite elements."""
        return farthest(self.frequencies(way), converged_frequencies(self.data, POSITION, self.count).hertz)


def farthest(hertz: np.ndarray, reference: np.ndarray) -> float:
    """Largest relative distance."""
    return float(np.abs(hertz / reference - 1.0).max())


def answer(quick: bool) -> Answer:
    """Distances of all ways."""
    peers, absent = present(("Exudyn", "OpenSeesPy", "MoorPy"))
    case = GeometricTerm()
    case.setup("", 12 if quick else COUNT)
    reference = converged_frequencies(case.data, POSITION, case.count).hertz
    consistent, thesis = (
        certified_modes(case.point, "exact", case.count, assembly).frequencies.hertz
        for assembly in ("consistent", "thesis")
    )
    found = {"cdpr-struct, `consistent`": consistent, "cdpr-struct, `thesis`": thesis}
    found |= {name: case.frequencies(name) for name, (peer, _) in WAYS.items() if peer in peers}
    rows = []
    for name, hertz in found.items():
        far, near = farthest(hertz, reference), farthest(hertz, thesis)
        rows.append([name, f"{far:.1e}", f"{near:.1e}", "has it" if far < near else "leaves it out"])
    head = ["code and joint", "from the converged FEM", "from our model without the term", "the term"]
    said = f"Largest relative distances of {case.count} frequencies. "
    return Answer(paragraphs(said + (_moorpy(case) if "MoorPy" in peers else ""), table(head, rows), *absent))


def _moorpy(case: GeometricTerm) -> str:
    """MoorPy has no modes of a body on vibrating lines; its static stiffness is compared."""
    system = moorpy_lines.robot_system(case.robot, POSITION, case.point.cables.total_length)
    system.solveEquilibrium(tol=1e-9, maxIter=500, finite_difference=False)
    rest = fem.solve_robot(case.data, POSITION, np.eye(3), 640)
    right, turned = fem.platform_dynamic_stiffness(rest, 0.0), rest.geometric_stiffness()
    off = np.abs(system.bodyList[0].getStiffnessA(all_DOFs=True) - right).max()
    return (
        f"MoorPy's `getStiffnessA` of the body differs by {off:.1e} (N/m, N, N m) at most from the FEM's static "
        f"stiffness, in which the term is {np.abs(turned).max():.1e} N m."
    )


QUESTION = Question("geometric-term", "Who knows that a cable's force turns with its arm?", answer)
