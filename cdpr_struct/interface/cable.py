"""Everything about one cable under one end force."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import SMALLEST, read_numbers, real
from cdpr_struct.interface.banded_cable import TolerancesLike, banded_cable, read_cable_tolerances, read_held
from cdpr_struct.interface.bands import read_band
from cdpr_struct.interface.given import Numbers
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.reports.text import cable_text, paragraphs
from cdpr_struct.reports.trust import Trust
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
        """Parameters, matrices, frequencies and verdict; bands if there are any."""
        from cdpr_struct.reports.cable_bands_told import cable_bands_text

        more = cable_bands_text(self.answer["bands"]) if "bands" in self.answer else []
        return paragraphs(cable_text(self.answer), *more)

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
    *,
    force: Numbers,
    length: float,
    EA: float,
    rho: float,
    gravity: float = 9.81,
    fem: bool = False,
    band: float | None = None,
    samples: int | None = None,
    tolerances: TolerancesLike | None = None,
    held: str | None = None,
) -> CableResult:
    """Describe one cable under an end force: shape, stiffness, validity of the DSM, natural frequencies.

    Parameters
    ----------
    force : FX, FZ at the free end [N], z up;  length : unstrained [m]
    EA : axial stiffness [N];  rho : linear density [kg/m];  gravity : [m/s^2]
    fem : the referee's frequencies, too
    band : level of a band about each frequency [%], like 90: within the cable's tolerances
    samples : with band, so many cables drawn within the tolerances check it
    tolerances : with band, one sigma each, like {"length_m": 0.001} or "length_m=0.001,axial_stiffness=0.05"; names:
        length_m, anchor_m, axial_stiffness, linear_density, load_cell_gain, load_cell_bias_N
    held : with band, what stays as entered: "force" (default; as a load cell tells it) or "ends" (the anchors)

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
    asked, sizes = read_band(band, samples), read_cable_tolerances(tolerances)
    stays = read_held("force" if held is None else held)
    for name, given in (("tolerances", tolerances), ("held", held)):
        if asked is None and given is not None:
            raise InputError(name, "", given, "it belongs to `band`; give that, too, or leave it out")
    told = describe_cable(force_x, force_z, length, EA, rho, gravity, fem)
    trust = cable_trust(told)
    if asked is not None:
        bands, checks = banded_cable(told, asked, sizes, stays)
        told, trust = {**told, "bands": bands}, Trust((*trust.checks, *checks))
    return CableResult(with_trust(told, trust))
