"""How to read a force distribution, and how it was computed."""

from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution

_COSTS = {
    "norm": "the Euclidean norm of the cable forces",
    "weighted-norm": "the weighted Euclidean norm of the cable forces",
    "p-norm": "the p-norm of the cable forces",
    "middle": "the distance of the cable forces from the middle of their bounds",
    "centre": "the sum of the logarithms of the inverse distances to all bounds (analytic centre)",
}


def distribution_notes(found: TrajectoryDistribution) -> list[tuple[str, list[str]]]:
    """Headings with their paragraphs."""
    return [
        (
            "How to read this",
            [
                "A robot with more cables than degrees of freedom can hold a pose with many sets of cable forces. A "
                "lower bound keeps every cable tight; of the sets above it, the one of least cost is chosen.",
                "Fixed and pose-dependent bound are the thesis's (5.16) and (5.15) as printed. Their formula (5.10) "
                "lacks a unit: it gives the frequency b only to cables of 9.81 m and less to longer ones. The "
                "frequency bound is the force at which the exact lowest frequency of the cable is b.",
            ],
        ),
        (
            "How it was computed",
            [
                f"At every instant {_COSTS[found.cost.name]} is minimised subject to the balance of the platform with "
                "its inertia forces and to the bounds. The catenary is solved exactly; bounds on force, length and "
                "frequency become bounds on the chord tension of each cable. Every instant's optimum is checked by its "
                "Karush-Kuhn-Tucker residual "
                f"(largest {found.distribution.kkt_residual.max():.1g}).",
                "Bounds hold at the platform end. The energy is the integral of |force at the platform| |change of "
                "unstrained length| over all cables: no recuperation, no friction, no holding losses. Of the "
                "definitions tried it meets the thesis's printed energies best. Motor force and power are those at the "
                "frame end.",
                "Cable frequencies: linearised elastic catenary, both ends held, in plane or out of plane, whichever "
                "is lower. Assumed: linear elastic cables, quasi-static cable shapes, a rigid platform.",
            ],
        ),
    ]
