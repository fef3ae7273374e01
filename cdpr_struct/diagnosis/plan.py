"""Before measuring: the smallest sizes that would be detected, and what would be confused."""

from typing import Any

import numpy as np

from cdpr_struct.diagnosis.causes.sensors import COMMON
from cdpr_struct.diagnosis.detectable import noncentrality
from cdpr_struct.diagnosis.evidence import Candidate, Choice, choices
from cdpr_struct.diagnosis.refit import Ground

WIDE = 2.5  # prior sigmas that a rival's size may have
SAME = 3.0  # nats: expected evidence below which two causes are one class


def minimum_detectable(candidates: list[Candidate]) -> dict[str, dict[str, Any]]:
    """Per cause the size found with probability 0.8 at a false alarm rate of 0.001.

    For several parameters the root mean square size of a random pattern.
    """
    table = {}
    for candidate in candidates:
        choice = plainest(candidate)
        d = choice.signature.shape[1]
        needed = noncentrality(d)
        strength = float((choice.signature**2).sum())
        first = choice.pattern.parameters[0]
        size = np.sqrt(needed / max(strength, 1e-300)) * first.prior
        table[candidate.name] = {
            "value": float(np.expm1(size)) if first.ratio else float(size),
            "unit": "relative" if first.ratio else first.unit,
            "pattern": choice.pattern.label or "as a whole",
        }
    return table


def plainest(candidate: Candidate) -> Choice:
    """All cables or all states alike if there is such a pattern, else everything, at the typical scale."""
    typical = [c for c in choices(candidate) if c.scale == 1.0]
    alike = [c for c in typical if c.pattern.label in ("all alike", COMMON)]
    return (alike or [max(typical, key=lambda c: c.signature.shape[1])])[0]


def confusable(ground: Ground) -> list[dict[str, Any]]:
    """Pairs of causes whose expected evidence against each other at twice the detectable size is below `SAME` nats.

    For a cause of signature g, the best that rival k leaves is g' (1 + G_k G_k')^-1 g / 2.
    """
    pairs = []
    options = {c.name: plainest(c) for c in ground.candidates}
    for name, choice in options.items():
        d = choice.signature.shape[1]
        weight = float(np.sqrt((choice.signature**2).sum()))
        if not weight:
            continue
        direction = np.ones(d) / np.sqrt(d) if d > 1 else np.ones(1)
        g = choice.signature @ direction
        g = g * 2.0 * np.sqrt(noncentrality(1)) / max(float(np.linalg.norm(g)), 1e-300)
        for other, rival in options.items():
            if other != name:
                nats = left_over(g, WIDE * rival.signature)
                if nats < SAME:
                    pairs.append({"cause": name, "taken_for": other, "nats": nats})
    return sorted(pairs, key=lambda p: p["nats"])


def left_over(g: np.ndarray, signature: np.ndarray) -> float:
    """g' (1 + G G')^-1 g / 2: expected log evidence of the cause g against a rival with signatures G."""
    b = signature.T @ g
    matrix = np.eye(signature.shape[1]) + signature.T @ signature
    return float(0.5 * (g @ g - b @ np.linalg.solve(matrix, b)))
