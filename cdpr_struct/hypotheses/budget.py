"""How much a search may fit: a larger budget never finds less."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Budget:
    """Causes fitted at least, nats from the best within which all are, beginnings of pairs, pairs of each fitted; nats
    from the best within which evidence converges, and of how many hypotheses at most.

    near : in the closed form, which errs by some nats where effects are large
    hopeless : nats behind the best from which a fit is not linearised again, even if its numbers moved far
    """

    causes: int = 3
    near: float = 14.0
    pair_near: float = 5.0
    hopeless: float = 30.0
    beginnings: int = 3
    pairs: int = 3
    sure: float = 8.0
    converged: int = 8
    alone: int = 6


BUDGETS = {"small": Budget(), "full": Budget(6, 20.0, 8.0, 60.0, 5, 6, 14.0, 24, 16)}
