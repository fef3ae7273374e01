"""All benchmarks, or some, by one command.

    python -m benchmarks [QUESTION ..] [--quick] [--write]
    python -m benchmarks random-robots|band-coverage|posterior-ranks [--seeds A:B] [--workers N] --out DIR
    python -m benchmarks diagnosed-bands --set DIR [--seeds A:B] [--workers N] --out DIR

--quick : few runs and small cases, to see that all run; --write : put the answers and figures into docs/benchmarks.md
"""

import argparse
import datetime
import platform
import sys
import warnings
from pathlib import Path

from benchmarks import (
    distribution,
    frf,
    geometric_term,
    growth,
    pose_batch,
    robot_modes,
    single_cable,
    statics_forward_kinematics,
    verified_robots,
    vibration_floor,
)
from benchmarks.band_coverage import running as band_coverage
from benchmarks.diagnosed_bands import running as diagnosed_bands
from benchmarks.markdown_page import put
from benchmarks.peers import versions
from benchmarks.posterior_ranks import running as posterior_ranks
from benchmarks.question import Question
from benchmarks.random_robots import running as random_robots

QUESTIONS: tuple[Question, ...] = tuple(
    module.QUESTION
    for module in (
        single_cable,
        robot_modes,
        pose_batch,
        vibration_floor,
        statics_forward_kinematics,
        frf,
        distribution,
        geometric_term,
        verified_robots,
        growth,
    )
)
STUDIES = {study.NAME: study.main for study in (random_robots, band_coverage, diagnosed_bands, posterior_ranks)}
PAGE = Path(__file__).parents[1] / "docs" / "benchmarks.md"


def machine() -> str:
    """Where, when and with what."""
    return f"{processor()}, one thread; Python {platform.python_version()}, " + ", ".join(
        f"{name} {number}" for name, number in versions().items()
    )


def processor() -> str:
    """Name of the processor, as the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    named = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.machine()


def main(words: list[str] | None = None) -> int:
    """Print, and write if asked; a study has arguments of its own."""
    given_words = sys.argv[1:] if words is None else words
    if given_words and (study := STUDIES.get(given_words[0])):
        return study(given_words[1:])
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=(__doc__ or "").split("\n")[0])
    names = [question.name for question in QUESTIONS]
    parser.add_argument("question", nargs="*", help=f"of: {', '.join(names)}; all if none is named")
    parser.add_argument("--quick", action="store_true", help="few runs and small cases")
    parser.add_argument("--write", action="store_true", help=f"put the answers into {PAGE.name}")
    given = parser.parse_args(given_words)
    if unknown := set(given.question) - set(names):
        parser.error(f"no question {sorted(unknown)[0]!r}; there are: {', '.join(names)}")
    if given.quick and given.write:
        parser.error("--write takes measured figures; --quick ones are not")
    warnings.simplefilter("ignore")
    for question in QUESTIONS:
        if not given.question or question.name in given.question:
            tell(question, given.quick, given.write)
    return 0


def tell(question: Question, quick: bool, write: bool) -> None:
    """One question on the screen, and on the page."""
    print(f"## {question.asks}\n", flush=True)
    found = question.answer(quick)
    stamp = f"Measured on {datetime.date.today().isoformat()}: {machine()}."
    print(f"{found.text}\n\n{stamp}\n", flush=True)
    if write:
        PAGE.write_text(put(PAGE.read_text("utf-8"), question.name, f"{found.text}\n\n{stamp}"), "utf-8")
        for name, draw in found.figures.items():
            draw(PAGE.parent / name)


if __name__ == "__main__":
    sys.exit(main())
