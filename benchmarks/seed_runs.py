"""Seeds tried by several processes, one line of JSON each; what an earlier run has done is not done again."""

import argparse
import json
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

FILE = "seeds.jsonl"
_AHEAD = 64  # seeds a process has in hand

Told = dict[str, Any]


def tried_seeds(words: Sequence[str], name: str, about: str, seeds: range, tried: Callable[[int], Told]) -> list[Told]:
    """What came of the seeds that a command line asks for, those of earlier runs among them.

    seeds : if none are given;  tried : what came of one, with its `seed`; a function of a module
    """
    parser = argparse.ArgumentParser(f"python -m benchmarks {name}", description=about)
    parser.add_argument("--seeds", type=span, default=seeds, metavar="A:B[:N]",
        help=f"from A to B - 1, every Nth ({seeds.start}:{seeds.stop})")  # fmt: skip
    parser.add_argument("--workers", type=int, default=1, help="processes (1)")
    parser.add_argument("--out", type=Path, required=True, help=f"folder of {FILE}, which is continued")
    given = parser.parse_args(words)
    file = given.out / FILE
    given.out.mkdir(parents=True, exist_ok=True)
    done = read(file)
    run([seed for seed in given.seeds if seed not in done], given.workers, file, tried)
    return [told for seed, told in sorted(read(file).items()) if seed in given.seeds]


def read(file: Path) -> dict[int, Told]:
    """What is known by seed; a last line that was cut short is removed from the file."""
    if not file.exists():
        return {}
    text = file.read_text("utf-8")
    whole = text[: text.rfind("\n") + 1]
    if whole != text:
        file.write_text(whole, "utf-8")
    return {told["seed"]: told for told in map(json.loads, whole.splitlines())}


def run(seeds: Sequence[int], workers: int, file: Path, tried: Callable[[int], Told]) -> None:
    """Append a line for every seed as soon as it is tried; a bar on a terminal says how many are left."""
    from rich.console import Console
    from rich.progress import Progress

    shown = Progress(console=Console(stderr=True), transient=True, disable=not Console(stderr=True).is_terminal)
    with file.open("a", encoding="utf-8") as lines, ProcessPoolExecutor(workers) as pool, shown as bar:
        task = bar.add_task("seeds", total=len(seeds))
        for first in range(0, len(seeds), _AHEAD * workers):
            part = seeds[first : first + _AHEAD * workers]
            for each in as_completed([pool.submit(tried, seed) for seed in part]):
                lines.write(json.dumps(each.result()) + "\n")
                lines.flush()
                bar.advance(task)


def span(text: str) -> range:
    """Seeds from words like 0:200 or 0:200:10."""
    try:
        first, end, *step = (int(part or 0) for part in text.split(":"))
        return range(first, end, *step)
    except (ValueError, TypeError) as error:
        raise argparse.ArgumentTypeError(f"{text!r}: give A:B or A:B:N, whole numbers") from error
