"""Can a result be trusted? Each check with its number and limit, and what it means for the result where it fails."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

_ROUNDING = 1e-9  # below it digits are those of a machine


@dataclass(frozen=True, slots=True)
class Check:
    """A number that says how far a result can be trusted.

    what        : in words
    value       : that was found;  limit : up to which (`at_least`: from which on) it is good;  unit : of both
    consequence : sentences on what follows where it is not good, () where it is
    note        : it is to be known rather than doubted
    """

    what: str
    value: float
    limit: float
    consequence: tuple[str, ...] = ()
    unit: str = ""
    at_least: bool = False
    note: bool = False

    @classmethod
    def of(
        cls, what: str, value: float, limit: float, consequence: str | Iterable[str | None] | None, unit: str = "",
        at_least: bool = False, note: bool = False,
    ) -> "Check":  # fmt: skip
        """A check whose consequence may be one sentence, several, or None."""
        sentences = (consequence,) if isinstance(consequence, str) or consequence is None else consequence
        said = tuple(text for text in sentences if text)
        return cls(what, float(value), float(limit), said, unit, at_least, note)

    @property
    def holds(self) -> bool:
        """Whether nothing follows."""
        return not self.consequence

    @property
    def words(self) -> str:
        """The number and, where it fails, its limit."""
        if self.holds and not (self.value or self.limit or self.unit):
            return f"no {self.what}"
        unit = f" {self.unit}" if self.unit else ""
        side = "at least" if self.at_least else "at most"
        bound = "" if self.holds else f" ({side} {self.limit:.3g}{unit})"
        number = f"below {_ROUNDING:g}" if 0.0 < self.value < _ROUNDING else f"{self.value:.2g}"
        return f"{self.what} {number}{unit}{bound}"

    def json(self) -> dict[str, Any]:
        """The check under the keys that scripts rely on."""
        return {
            "what": self.what,
            "value": self.value,
            "limit": self.limit,
            "side": "at least" if self.at_least else "at most",
            "unit": self.unit,
            "holds": self.holds,
            "doubted": not (self.holds or self.note),
            "consequence": " ".join(self.consequence),
        }


@dataclass(frozen=True, slots=True)
class Trust:
    """The checks of a result."""

    checks: tuple[Check, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether no check raises a doubt."""
        return not self.doubted

    @property
    def doubted(self) -> list[Check]:
        """Checks that fail and are more than a note."""
        return [check for check in self.checks if not (check.holds or check.note)]

    @property
    def warnings(self) -> list[str]:
        """Sentences that a reader of the result must not miss."""
        return [sentence for check in self.doubted for sentence in check.consequence]

    @property
    def sentences(self) -> list[str]:
        """One line on all checks, then what is to be known beside; nothing without checks."""
        if not self.checks:
            return []
        judged = [check for check in self.checks if not check.note]
        notes = [" ".join(check.consequence) for check in self.checks if check.note and not check.holds]
        return [*([_line(judged, self.doubted)] if judged else []), *notes]

    def json(self) -> dict[str, Any]:
        """The result's `trust`."""
        return {
            "holds": self.holds,
            "checks": [check.json() for check in self.checks],
            "sentences": self.sentences,
        }


def _line(judged: list[Check], doubted: list[Check]) -> str:
    count = len(judged)
    if not doubted:
        told = ", ".join(check.words for check in judged)
        return f"Trust: {'the check holds' if count == 1 else f'all {count} checks hold'} ({told})."
    failed = ", ".join(check.words for check in doubted)
    return f"Trust: {count - len(doubted)} of {count} checks hold; not: {failed}. See the warnings."


def trust_sentences(result: Mapping[str, Any]) -> list[str]:
    """Sentences of a result's `trust`, for screen, page and notebook."""
    return list(result.get("trust", {}).get("sentences", ()))
