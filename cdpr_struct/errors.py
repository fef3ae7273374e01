"""The errors that this package raises on purpose.

All are of one family, `CdprError`. `InputError` means that what the user gave cannot be used, every other one that
physics says no. They carry the numbers and the next step; the command line turns them into exit codes 2 and 1.
"""

from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any

NOTHING = "nothing"
"""The value of an `InputError` about what was not given."""


class CdprError(Exception):
    """What this package raises on purpose; if it is no `InputError`, the request is well-posed but cannot be met."""

    def __reduce__(self) -> tuple[Any, ...]:
        """As it is: what a kind's `__init__` takes is not what it says, and workers send errors home."""
        return _as_it_was, (type(self), self.args, self.__dict__)


def _as_it_was(kind: type[CdprError], said: tuple[Any, ...], state: dict[str, Any]) -> CdprError:
    error = kind.__new__(kind, *said)
    error.args = said
    error.__dict__.update(state)
    return error


class InputError(CdprError, ValueError):
    """Unusable input: where it is, what it was, and what would be right.

    Parameters
    ----------
    source : file, command-line option, or argument of a function.
    field : the name inside the source ("" if the source as a whole is meant).
    value : what was given; `NOTHING` where it is missing.
    expected : what would be right.
    """

    def __init__(self, source: str, field: str, value: object, expected: str) -> None:
        self.source, self.field, self.value, self.expected = source, field, value, expected
        place = f"{on_one_line(source, 400)}: {on_one_line(field, 200)}" if field else on_one_line(source, 400)
        plain = value.item() if type(value).__module__ == "numpy" and hasattr(value, "item") else value
        said = " is missing" if isinstance(plain, str) and plain == NOTHING else f": got {_shown(plain)}"
        super().__init__(f"{place}{said}; {on_one_line(expected, 1200)}")


def on_one_line(text: str, longest: int) -> str:
    """Text for a line on the screen: control signs escaped, and cut in the middle where it is longer than that."""
    if not text.isprintable():
        text = "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)
    if len(text) <= longest:
        return text
    half = longest // 2 - 20
    return f"{text[:half]} ... ({len(text)} characters) ... {text[-half:]}"


def _shown(value: object) -> str:
    """A value as Python writes it, cut."""
    try:
        return on_one_line(repr(value), 200)
    except (ValueError, RecursionError):  # an integer of thousands of digits, lists within lists without end
        return f"a {type(value).__name__} that is too long to be shown"


def told(error: Exception) -> CdprError | None:
    """An error of numerics or of the finite-element referee as one of this package; None if it is a defect."""
    if isinstance(error, CdprError):
        return error
    if type(error).__module__.startswith("cdpr_struct.fem_reference."):
        return CdprError(f"FEM reference: {error}")
    if isinstance(error, ArithmeticError) or type(error).__name__ == "LinAlgError":
        return CdprError(f"cannot be computed ({error}): check the size of masses, lengths and forces")
    return None


def not_utf8(source: str, error: UnicodeDecodeError) -> InputError:
    """What to say of a text file in another encoding."""
    return InputError(source, "", f"byte {error.object[error.start]:#x}", "a text file in UTF-8")


class UnholdablePoseError(CdprError):
    """No tension distribution above the lower bound balances the load at this pose."""

    def __init__(self, reason: str, cable: int | None = None, amount: float | None = None) -> None:
        self.cable, self.amount = cable, amount
        super().__init__(reason)


class UnstableEquilibriumError(CdprError):
    """The platform is balanced, but a small motion would grow: there are no vibrations about this state."""


class CrowdedModesError(CdprError):
    """A cable hangs so slack that it has more modes in the band than can be told apart."""


class ModesApartError(CdprError):
    """The frequencies of two models are not the same modes."""


class ConvergenceError(CdprError):
    """An iteration stopped before it converged; holds the last residual."""

    def __init__(self, what: str, residual: float, iterations: int, hint: str) -> None:
        self.residual, self.iterations = residual, iterations
        super().__init__(f"{what}: residual {residual:.3g} after {iterations} iterations. {hint}")


def known_names(name: str, known: Sequence[str], shown: Sequence[str] = ()) -> str:
    """What to say of a name that is not among those known: which of them is perhaps meant, and all (as `shown`)."""
    near = get_close_matches(name, known, 1)
    return (f"{near[0]} is perhaps meant; " if near else "") + f"known are {', '.join(shown or known)}"
