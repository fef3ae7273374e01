"""The study as a command: seeds are tried, a summary is printed."""

import sys
from collections.abc import Sequence

from benchmarks.random_robots.summary import summary
from benchmarks.random_robots.trying import tried
from benchmarks.seed_runs import tried_seeds

NAME = "random-robots"
_ABOUT = "Seeds tried by several processes; what an earlier run has done is not done again."


def main(words: Sequence[str]) -> int:
    """Try seeds and print what came of them; 1 if any answer is wrong."""
    found = tried_seeds(words, NAME, _ABOUT, range(10_000), tried)
    print(summary(found))
    return int(any(told["violations"] for told in found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
