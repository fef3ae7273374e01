"""Made-up linear material: whitened signatures of three causes, one of four cables each its own."""

import numpy as np

from benchmarks.diagnosis_baselines.material import Material
from cdpr_struct.diagnosis.causes.cause import Cause, Parameter, Pattern
from cdpr_struct.diagnosis.evidence import Candidate

ROWS, CABLES = 60, 4


def still(world, theta):
    return world


def candidate(name: str, signature: np.ndarray, per_cable: bool = False, positive: bool = False) -> Candidate:
    """A cause with prior sigma 0.5 of every parameter."""
    d = signature.shape[1]
    basic = tuple(Parameter(f"{name}_{i}", "m", 0.5, positive=positive) for i in range(d))
    patterns = [Pattern("", np.eye(d), basic, 1.0)]
    if per_cable:
        patterns = [
            Pattern("all alike", np.ones((d, 1)), basic[:1], 0.5),
            Pattern("each its own", np.eye(d), basic, 0.5),
        ]
    return Candidate(Cause(name, name, basic, still), signature, patterns)


def material(effect: dict[str, np.ndarray], seed: int = 0, noise: float = 1.0) -> Material:
    """White noise, and effects theta by name: `own` (4 cables), `lone` (1), `bounded` (1, not negative).

    Of the same without tolerances the residuals are twice as large.
    """
    rng = np.random.default_rng(77)
    sizes = {"own": CABLES, "lone": 1, "bounded": 1}
    found = [
        candidate(n, 10.0 * rng.standard_normal((ROWS, d)) / np.sqrt(ROWS), n == "own", n == "bounded")
        for n, d in sizes.items()
    ]
    z = noise * np.random.default_rng(seed).standard_normal(ROWS)
    for one in found:
        if one.name in effect:
            z = z - one.signature @ effect[one.name]
    return Material(z, found, frozenset(), 2.0 * z, found)
