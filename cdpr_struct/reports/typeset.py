"""Signs of print for what terminals and options write in ASCII: ±, µm, m³, ≥, 1.3·10⁻³⁹."""

import re

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER = re.compile(r"(?<=[A-Za-zλχ)])\^(-?\d+)")
_SCIENTIFIC = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d{1,3})(?!\w|\.\d)")
_COMPARED = re.compile(r"(^|(?<=\S))\s?([<>])=\s?(?=[-+]?[\d.])")
_SIGNS = ((re.compile(r"\+-(?=\s*\d)"), "±"), (re.compile(r"(?<![A-Za-z])um(?![A-Za-z])"), "µm"))
_SMALLEST, _LARGEST = 0.999e-4, 1e5  # numbers between are written without a power of ten


def raised(exponent: str) -> str:
    """Digits and sign of an exponent as superscripts."""
    return exponent.translate(_RAISED)


def typeset(text: str) -> str:
    """A sentence or a cell of a table as it is printed on a page."""
    for pattern, sign in _SIGNS:
        text = pattern.sub(sign, text)
    text = _COMPARED.sub(lambda found: f"{' ' if found.start() else ''}{'≥' if found[2] == '>' else '≤'} ", text)
    text = _POWER.sub(lambda found: raised(found[1]), text)
    return _SCIENTIFIC.sub(_number, text)


def _number(found: re.Match[str]) -> str:
    """140 for 1.4e+02, 0.0014 for 1.4e-03, 1.4·10⁻³⁹ beyond: with the digits it came with."""
    factor, exponent = found[1], int(found[2])
    value = float(f"{factor}e{exponent}")
    if value == 0.0:
        return "0"
    if _SMALLEST <= value < _LARGEST:
        decimals = max(len(factor.partition(".")[2]) - exponent, 0)
        return f"{value:.{decimals}f}"
    return f"10{raised(str(exponent))}" if factor == "1" else f"{factor}·10{raised(str(exponent))}"
