"""The study as a command: cases of a blind set are looked at, a summary is printed."""

import argparse
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from benchmarks.diagnosed_bands.summary import summary
from benchmarks.diagnosed_bands.trying import tried
from benchmarks.seed_runs import tried_seeds

NAME = "diagnosed-bands"
_ABOUT = "Do bands of robots that a diagnosis extended hold as many truths as they say? --seeds are numbers of cases."


def main(words: Sequence[str]) -> int:
    """Look at the cases of a set that has been diagnosed, and print what came of them."""
    parser = argparse.ArgumentParser(f"python -m benchmarks {NAME}", add_help=False)
    parser.add_argument("--set", type=Path, required=True, metavar="DIR", help="a blind set with its answers")
    given, rest = parser.parse_known_args(words)
    count = len(list((given.set / "answers").glob("c*")))
    found = tried_seeds(rest, f"{NAME} --set DIR", _ABOUT, range(1, count + 1), partial(tried, given.set))
    print(summary(found))
    return 0
