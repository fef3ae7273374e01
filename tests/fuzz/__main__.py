"""`python -m tests.fuzz --target robot --seconds 600`: one process at a time, processor seconds, counts as JSON."""

import argparse
import os
import random
import resource
import shutil
import sys
import tempfile
from pathlib import Path

import atheris

LONGEST_INPUT = 60_000  # bytes
SLOWEST_EVER = 1200  # s of the clock, after which libFuzzer calls an input a hang and stops

with atheris.instrument_imports(include=["cdpr_struct.robot", "cdpr_struct.measurement", "tomllib", "pyuff"]):
    from tests.fuzz import targets
    from tests.fuzz.judging import Judge
    from tests.fuzz.mutating import changed
    from tests.fuzz.seeds import seeds


def main() -> int:
    """Fuzz the targets, one after the other, each in a process of its own; 1 if one has findings."""
    asked = _arguments()
    ends = []
    for seed in range(asked.seed, asked.seed + asked.rounds):
        for target in targets.TARGETS if asked.target == "all" else [asked.target]:
            child = os.fork()
            if not child:
                _fuzz(target, seed, asked.seconds, asked.directory / target)
            ends.append(os.waitpid(child, 0)[1])
    return int(any(ends))


def _fuzz(target: str, seed: int, seconds: float, directory: Path) -> None:
    """Fuzz one target until its processor time is used up; ends the process, with 1 if there are findings."""
    place = targets.scratch()
    corpus, findings = directory / "corpus", directory / "findings"
    targets.seeds_of(target, seeds(), corpus)
    judge = Judge(targets.reader(target, place), findings)

    def one(data: bytes) -> None:
        judge(data)
        if judge.seconds() > seconds:
            print(f"{target}: {judge.summary()}", flush=True)
            (directory / f"summary-{seed}.json").write_text(judge.summary())
            shutil.rmtree(place)
            sys.stderr.flush()
            os._exit(1 if judge.findings else 0)  # libFuzzer knows no other end of a run

    def mutate(data: bytes, longest: int, number: int) -> bytes:
        rng = random.Random(number)
        begun = rng.choice(judge.loaded) if judge.loaded and rng.random() < 0.5 else data
        made = atheris.Mutate(begun, longest) if rng.random() < 0.2 else changed(begun, rng)
        return bytes(made)[:longest]

    options = [f"-max_len={LONGEST_INPUT}", f"-timeout={SLOWEST_EVER}", "-rss_limit_mb=3000", f"-seed={seed}"]
    options += ["-print_final_stats=0", "-verbosity=0", f"-artifact_prefix={findings}/", str(corpus)]
    atheris.Setup([sys.argv[0], *options], one, custom_mutator=mutate)
    atheris.Fuzz()


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--target", choices=[*targets.TARGETS, "all"], required=True)
    parser.add_argument("--seconds", type=float, default=600.0, help="processor time of a target in a round")
    parser.add_argument("--rounds", type=int, default=1, help="each goes on from what the one before found")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--directory", type=Path, default=Path(tempfile.gettempdir()) / "cdpr-fuzz")
    return parser.parse_args()


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    sys.exit(main())
