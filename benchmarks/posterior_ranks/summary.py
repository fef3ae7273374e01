"""Ranks of true sizes by cause, and whether they are uniform, as a table in Markdown."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from scipy.stats import kstest

from benchmarks.band_coverage.summary import limits
from benchmarks.markdown_page import table

LEVELS = (0.5, 0.9, 0.99)
UNIFORM = 0.01  # least p-value of Kolmogorov and Smirnov's test
Told = dict[str, Any]


def ranks(found: Sequence[Told], cause: str) -> np.ndarray:
    """(n,) of a cause."""
    return np.array([told["rank"] for told in found if told["cause"] == cause])


def p_value(values: np.ndarray) -> float:
    """Of the test that they are uniform."""
    return float(kstest(values, "uniform").pvalue)


def inside(values: np.ndarray, level: float) -> int:
    """How many lie in the central interval of a level."""
    return int((np.abs(values - 0.5) <= 0.5 * level).sum())


def faults(found: Sequence[Told]) -> Iterator[str]:
    """Causes whose ranks are not uniform."""
    for cause in causes(found):
        if p_value(ranks(found, cause)) < UNIFORM:
            yield cause


def causes(found: Sequence[Told]) -> list[str]:
    """In the order of the alphabet."""
    return sorted({told["cause"] for told in found})


def summary(found: Sequence[Told]) -> str:
    """The table and a sentence."""
    rows = []
    for cause in causes(found):
        values = ranks(found, cause)
        counts = " / ".join(str(inside(values, level)) for level in LEVELS)
        allowed = " / ".join("{} to {}".format(*limits(len(values), level)) for level in LEVELS)
        rows.append([f"`{cause}`", str(len(values)), counts, allowed, f"{p_value(values):.2g}"])
    bad = ", ".join(faults(found)) or "none"
    passed = sum(told["passed_over"] for told in found)
    head = ["cause", "campaigns", "truths in 50 / 90 / 99 % intervals", "allowed (99 %)", "p (uniform)"]
    end = f"Not uniform at {UNIFORM:g}: {bad}. Passed over, as the true robot cannot make them: {passed} campaigns."
    return f"{table(head, rows)}\n\n{end}"
