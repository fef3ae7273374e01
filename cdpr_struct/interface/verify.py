"""The exact model and the closed-form DSM before the finite-element referee."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from cdpr_struct.crosscheck.fem_robot import NOT_IN_FEM
from cdpr_struct.crosscheck.verdicts import JUDGED, Criteria
from cdpr_struct.crosscheck.verification import Verification
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
from cdpr_struct.reports.verification_result import eigenfrequency_columns, verification_checks, verification_json
from cdpr_struct.reports.verification_text import verification_text
from cdpr_struct.reports.verification_verdict import verdict_lines

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

MOST_ELEMENTS = 1280
LARGEST_COUNT = 2000


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VerifyResult(Result):
    """What the referee says of both models at one pose.

    trial : frequencies of all, convergence, determinant scan, validity limits; judged, agreement(model), causes
    """

    trial: Verification

    @property
    def holds(self) -> bool:
        """Whether the referee confirms the model that is judged first: the exact one, or the one that was named."""
        return not self.trial.objections()

    @property
    def title(self) -> str:
        """Whose frequencies are tried."""
        return f"{self.trial.point.entered.name}: models against FEM"

    def text(self) -> str:
        """Tables of modes, convergence and cables, then the verdict."""
        return verification_text(self.trial)

    def sentences(self) -> Sequence[str]:
        """The verdicts, with causes, and what to do."""
        return verdict_lines(self.trial)

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
    tolerance: float | None = None,
    progress: Progress = silent,
    free: FreeAngles | None = None,
    model: str | None = None,
    most_elements: int = MOST_ELEMENTS,
) -> VerifyResult:
    """Compare eigenfrequencies of the exact model and the DSM with those of the FEM; `holds` if they agree.

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
    assembly : consistent, or thesis (eq. 3.8 as printed)
    tolerance : largest relative deviation from the FEM [-]; default: 1e-4 for the exact model, 0.01 for the DSM
    model : exact or dsm, the only one to judge; default: both, and `holds` is about the exact one
    most_elements : a cable; the FEM is refined up to this until its limit is certain to a tenth of the tolerance
    progress : called with the name of each step
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there.
    """
    counts = read_elements(elements)
    whole(modes, "modes", 1, 200)
    whole(most_elements, "most_elements", counts[-1], LARGEST_COUNT)
    judged = JUDGED if model is None else (one_of(model, "model", JUDGED),)
    criteria = Criteria()
    if tolerance is not None:
        real(tolerance, "tolerance", "give a ratio between 0 and 1, like 0.01", 0.0, 1.0)
        criteria = Criteria(relative_error=tolerance, exact_error=tolerance)
    way = one_of(assembly, "assembly", ASSEMBLIES)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, winches=True)
    require_locked_lengths(
        machine, "the closed-form DSM knows no such winch; compare modes --model exact and --model fem"
    )
    state = rest(machine.without_extensions(*NOT_IN_FEM), pose, lengths, start, free)
    with state.advised():
        trial = tried(state.point, counts, modes, way, criteria, progress, most_elements, judged)
    told = verification_json(trial, pose_in_degrees(state.point)) | state.told(*verification_checks(trial))
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
    if counts[-1] > LARGEST_COUNT:
        raise InputError("elements", "", given, f"at most {LARGEST_COUNT} elements per cable")
    return counts
