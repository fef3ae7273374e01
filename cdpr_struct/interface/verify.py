"""The DSM model on trial before the finite-element referee."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from cdpr_struct.crosscheck.fem_robot import NOT_IN_FEM
from cdpr_struct.crosscheck.verification import Criteria, Verification
from cdpr_struct.crosscheck.verification import verify as tried
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of, read_numbers, read_robot, real, whole
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, Progress, RobotLike
from cdpr_struct.interface.modes import ASSEMBLIES
from cdpr_struct.interface.operating_point import pose_in_degrees, rest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.verification_result import eigenfrequency_columns, verification_json
from cdpr_struct.reports.verification_text import verdict, verification_text

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VerifyResult(Result):
    """What the referee says of the DSM at one pose.

    trial : frequencies of both, convergence, determinant scan, validity limits, objections()
    """

    trial: Verification

    @property
    def holds(self) -> bool:
        """Whether the referee has no objection."""
        return not self.trial.objections()

    @property
    def title(self) -> str:
        """Whose frequencies are tried."""
        return f"{self.trial.point.entered.name}: DSM against FEM"

    def text(self) -> str:
        """Tables of modes, convergence and cables, then the verdict."""
        return verification_text(self.trial)

    def sentences(self) -> Sequence[str]:
        """The verdict."""
        return verdict(self.trial).split("\n")

    def columns(self) -> Mapping[str, Any]:
        """Columns of eigenfrequencies.csv."""
        return eigenfrequency_columns(self.trial)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Deviation of every mode."""
        from cdpr_struct.reports.figures import mode_errors

        return lambda figure: mode_errors.draw_mode_errors(figure, self.trial), mode_errors.SIZE

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.verification_page import verification_files

        return verification_files(self.trial)


@answered
def verify(
    robot: RobotLike,
    pose: PoseLike | None = None,
    *,
    lengths: Numbers | None = None,
    start: PoseLike | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    elements: Numbers = (10, 20, 40, 80),
    modes: int = 60,
    assembly: str = "consistent",
    tolerance: float = 0.01,
    progress: Progress = silent,
    free: FreeAngles | None = None,
) -> VerifyResult:
    """Compare the DSM's eigenfrequencies with those of the finite-element referee; `holds` says whether they agree.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    elements : counts per cable, ascending multiples of the first;  modes : how many to compare
    assembly : consistent, or thesis (eq. 3.8 as printed);  tolerance : largest relative deviation from the FEM [-]
    progress : called with the name of each step
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there.
    """
    counts = read_elements(elements)
    whole(modes, "modes", 1, 200)
    real(tolerance, "tolerance", "give a ratio between 0 and 1, like 0.01", 0.0, 1.0)
    way = one_of(assembly, "assembly", ASSEMBLIES)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature)
    require_locked_lengths(machine, "the DSM on trial knows no such winch; compare modes --model exact and --model fem")
    state = rest(machine.without_extensions(*NOT_IN_FEM), pose, lengths, start, free)
    with state.advised():
        trial = tried(state.point, counts, modes, way, Criteria(relative_error=tolerance), progress)
    told = verification_json(trial, pose_in_degrees(state.point)) | state.told()
    return VerifyResult(with_extensions(told, machine, "verify"), trial)


def read_elements(given: Numbers) -> list[int]:
    """Element counts: at least three, ascending, multiples of the first.

    Raises
    ------
    InputError : anything else.
    """
    values = read_numbers(given, "elements", None, "element counts")
    counts = [int(v) for v in values]
    ascending = all(a < b for a, b in pairwise(counts))
    integers = [float(c) for c in counts] == values
    if not (integers and len(counts) >= 3 and counts[0] >= 4 and ascending and all(c % counts[0] == 0 for c in counts)):
        expected = "give at least three ascending multiples of the first (4 or more), like 10,20,40,80"
        raise InputError("elements", "", given, expected)
    if counts[-1] > 2000:
        raise InputError("elements", "", given, "at most 2000 elements per cable")
    return counts
