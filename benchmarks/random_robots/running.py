"""Seeds tried by several processes, one line of JSON each; what an earlier run has done is not done again."""

import argparse
import json
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from benchmarks.random_robots.summary import summary
from benchmarks.random_robots.trying import tried

FILE = "seeds.jsonl"
_AHEAD = 64  # seeds a process has in hand


def main(words: Sequence[str]) -> int:
    """Try seeds and print what came of them; 1 if any answer is wrong."""
    parser = argparse.ArgumentParser("python -m benchmarks random-robots", description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=_span, default=range(10_000), metavar="A:B[:N]",
        help="from A to B - 1, every Nth (0:10000)")  # fmt: skip
    parser.add_argument("--workers", type=int, default=1, help="processes (1)")
    parser.add_argument("--out", type=Path, required=True, help=f"folder of {FILE}, which is continued")
    given = parser.parse_args(words)
    file = given.out / FILE
    given.out.mkdir(parents=True, exist_ok=True)
    done = read(file)
    run([seed for seed in given.seeds if seed not in done], given.workers, file)
    found = [told for seed, told in read(file).items() if seed in given.seeds]
    print(summary(found))
    return int(any(told["violations"] for told in found))


def read(file: Path) -> dict[int, dict[str, Any]]:
    """What is known by seed; a last line that was cut short is removed from the file."""
    if not file.exists():
        return {}
    text = file.read_text("utf-8")
    whole = text[: text.rfind("\n") + 1]
    if whole != text:
        file.write_text(whole, "utf-8")
    return {told["seed"]: told for told in map(json.loads, whole.splitlines())}


def run(seeds: Sequence[int], workers: int, file: Path) -> None:
    """Append a line for every seed as soon as it is tried."""
    with file.open("a", encoding="utf-8") as lines, ProcessPoolExecutor(workers) as pool:
        for first in range(0, len(seeds), _AHEAD * workers):
            part = seeds[first : first + _AHEAD * workers]
            for each in as_completed([pool.submit(tried, seed) for seed in part]):
                lines.write(json.dumps(each.result()) + "\n")
                lines.flush()


def _span(text: str) -> range:
    try:
        first, end, *step = (int(part or 0) for part in text.split(":"))
        return range(first, end, *step)
    except (ValueError, TypeError) as error:
        raise argparse.ArgumentTypeError(f"{text!r}: give A:B or A:B:N, whole numbers") from error


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
