"""The study as a command: seeds are tried, a summary is printed."""

from collections.abc import Sequence

from benchmarks.posterior_ranks.summary import faults, summary
from benchmarks.posterior_ranks.trying import tried
from benchmarks.seed_runs import tried_seeds

NAME = "posterior-ranks"
_ABOUT = "Are true sizes of causes spread over their posteriors? What an earlier run has done is not done again."


def main(words: Sequence[str]) -> int:
    """Try seeds and print what came of them; 1 if the ranks of a cause are not uniform."""
    found = tried_seeds(words, NAME, _ABOUT, range(2000), tried)
    print(summary(found))
    return int(any(faults(found)))
