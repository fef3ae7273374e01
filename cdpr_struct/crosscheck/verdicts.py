"""What must hold for the FEM to confirm a model, and in which words it does not."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

Judged = Literal["exact", "dsm"]
JUDGED: tuple[Judged, ...] = get_args(Judged)
SHORT = {"exact": "exact model", "dsm": "DSM"}


@dataclass(frozen=True, slots=True)
class Criteria:
    """What must hold for the verdicts.

    relative_error, exact_error : largest deviation of a frequency of the DSM, of the exact model, from the
                       extrapolated FEM [-]
    assurance        : smallest share of an FEM shape that must lie in the model's cluster it is paired with [-]
    fem_share        : largest uncertainty of an extrapolated FEM frequency, in shares of the largest deviation [-]
    minimum_tolerance: a determinant minimum farther than this from a frequency does not stand for it [Hz]
    """

    relative_error: float = 0.01
    exact_error: float = 1e-4
    assurance: float = 0.5
    fem_share: float = 0.1
    minimum_tolerance: float = 0.03

    def tolerance(self, model: Judged) -> float:
        """Largest relative deviation of the model's frequencies [-]."""
        return self.exact_error if model == "exact" else self.relative_error

    def fem_uncertainty(self, model: Judged) -> float:
        """Largest relative uncertainty of the FEM that judges the model [-]."""
        return self.fem_share * self.tolerance(model)


@dataclass(frozen=True, slots=True, eq=False)
class Agreement:
    """A model's k frequencies beside the FEM's.

    hertz, limit, uncertainty : (k,) of the model, of the FEM in the limit of fine meshes, and how sure that is [Hz]
    assurance : (k,) share of the FEM shape that lies in the cluster of the model's mode [-]
    certified : whether a count proves that none of the model's frequencies is missing
    elements  : of the finest mesh, per cable;  neutral, fem_neutral : freedoms that nothing holds, by model and FEM
    """

    model: Judged
    criteria: Criteria
    hertz: np.ndarray
    limit: np.ndarray
    uncertainty: np.ndarray
    assurance: np.ndarray
    certified: bool
    elements: int
    neutral: int
    fem_neutral: int

    @property
    def error(self) -> np.ndarray:
        """(k,) relative deviation from the FEM's limit, signed [-]."""
        return self.hertz / self.limit - 1.0

    @property
    def failing(self) -> np.ndarray:
        """(k,) whether the mode is farther off than the tolerance."""
        return np.asarray(np.abs(self.error) > self.criteria.tolerance(self.model))

    @property
    def undecided(self) -> str:
        """Why the FEM cannot judge, "" if it can."""
        asked = self.criteria.fem_uncertainty(self.model)
        blurred = self.uncertainty / self.limit
        worst = int(np.argmax(blurred))
        if blurred[worst] <= asked:
            return ""
        return (
            f"the FEM has not converged with {self.elements} elements per cable: its limit of mode {worst + 1} is "
            f"uncertain by {100 * blurred[worst]:.2g} %, over {100 * asked:g} %; allow more elements"
        )

    @property
    def objections(self) -> list[str]:
        """Sentences, one per criterion that is not met; empty when the model holds."""
        return [text for failed, text in self._against() if failed] + [text for text in (self.undecided,) if text]

    @property
    def status(self) -> str:
        """HOLDS, DOES NOT HOLD, or NOT DECIDED where nothing speaks against the model but the FEM is not certain."""
        if not self.objections:
            return "HOLDS"
        return "NOT DECIDED" if self.objections == [self.undecided] else "DOES NOT HOLD"

    def _against(self) -> list[tuple[bool, str]]:
        worst, lost = int(np.argmax(np.abs(self.error))), int(np.argmin(self.assurance))
        name, tolerance = SHORT[self.model], self.criteria.tolerance(self.model)
        others = int(self.failing.sum()) - 1
        alike = f" (as {'is' if others == 1 else 'are'} {others} more)" if others > 0 else ""
        return [
            (
                bool(self.failing[worst]),
                f"mode {worst + 1}: {name} {self.hertz[worst]:.4f} Hz is off by {signed_percent(self.error[worst])} "
                f"from the FEM's {self.limit[worst]:.4f} Hz, over {100 * tolerance:g} %{alike}",
            ),
            (
                bool(self.assurance[lost] < self.criteria.assurance),
                f"mode {lost + 1} at {self.limit[lost]:.4f} Hz has no partner of its shape in the {name} "
                f"(best share {self.assurance[lost]:.2f})",
            ),
            (
                self.neutral != self.fem_neutral,
                f"the {name} has {self.neutral} neutral freedoms, the FEM {self.fem_neutral}",
            ),
            (not self.certified, f"the count of the natural frequencies of the {name} could not be certified"),
        ]


def signed_percent(ratio: float) -> str:
    """A small ratio in percent with a sign, two digits after the point or two significant ones."""
    percent = 100.0 * ratio
    return f"{percent:+.2f} %" if abs(percent) >= 0.1 else f"{percent:+.2g} %"
