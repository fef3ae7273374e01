"""The study as a command: seeds are tried, a summary is printed."""

from collections.abc import Sequence

from benchmarks.band_coverage.summary import answered, faults, summary
from benchmarks.band_coverage.trying import tried
from benchmarks.seed_runs import tried_seeds

NAME = "band-coverage"
_ABOUT = "Do bands of predictions hold as many robots as they say? What an earlier run has done is not done again."


def main(words: Sequence[str]) -> int:
    """Try seeds and print what came of them; 1 if a share is outside what chance allows."""
    found = tried_seeds(words, NAME, _ABOUT, range(250), tried)
    print(summary(found))
    return int(any(faults(answered(found, False))))
