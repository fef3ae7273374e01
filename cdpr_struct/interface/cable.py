"""Everything about one cable under one end force."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import SMALLEST, read_numbers, real
from cdpr_struct.interface.given import Numbers
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.reports.text import cable_text
from cdpr_struct.reports.trust_without_robot import cable_trust, with_trust

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CableResult(Result):
    """One cable: end point, sag, stiffness, frequencies, validity; all of it is in `answer`."""

    @property
    def title(self) -> str:
        """Which cable."""
        return f"A cable of {self.answer['input']['length_m']:g} m"

    def text(self) -> str:
        """Parameters, matrices, frequencies and verdict."""
        return cable_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """Whether the closed form is within its printed limits."""
        from cdpr_struct.reports.cable_page import validity_sentence

        return [validity_sentence(self.answer["validity"])]

    def columns(self) -> Mapping[str, Any]:
        """Columns of profile.csv."""
        from cdpr_struct.reports.cable_page import profile_columns

        return profile_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The hanging cable."""
        from cdpr_struct.reports.figures import single_cable

        return lambda figure: single_cable.draw_profile(figure, self.answer), single_cable.PROFILE_SIZE

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.cable_page import cable_files

        return cable_files(self.answer)


@answered
def cable(
    *, force: Numbers, length: float, EA: float, rho: float, gravity: float = 9.81, fem: bool = False
) -> CableResult:
    """Describe one cable under an end force: shape, stiffness, validity of the DSM, natural frequencies.

    Parameters
    ----------
    force : FX, FZ at the free end [N], z up;  length : unstrained [m]
    EA : axial stiffness [N];  rho : linear density [kg/m];  gravity : [m/s^2]
    fem : the referee's frequencies, too

    Raises
    ------
    InputError : an unusable argument.
    """
    force_x, force_z = read_numbers(force, "force", (2,), "numbers FX,FZ in N")
    for name, value in (("length", length), ("EA", EA), ("rho", rho), ("gravity", gravity)):
        real(value, name, "give a finite number above zero", 0.0, float("inf"))
    if abs(force_x) < SMALLEST:
        expected = "give a horizontal force that is not zero (a vertical cable has no plane)"
        raise InputError("force", "FX", force_x, expected)
    told = describe_cable(force_x, force_z, length, EA, rho, gravity, fem)
    return CableResult(with_trust(told, cable_trust(told)))
