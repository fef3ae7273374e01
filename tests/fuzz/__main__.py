"""`python -m tests.fuzz --target robot --seconds 600`: one process, processor seconds, counts as JSON at the end."""

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
SLOWEST_EVER = 120  # s, after which libFuzzer calls an input a hang and stops

with atheris.instrument_imports(include=["cdpr_struct.robot", "cdpr_struct.measurement", "tomllib", "pyuff"]):
    from tests.fuzz import targets
from tests.fuzz.judging import Judge
from tests.fuzz.mutating import changed
from tests.fuzz.seeds import seeds


def main() -> None:
    """Fuzz one target until its processor time is used up; exit code 1 if there are findings."""
    asked = _arguments()
    place = targets.scratch()
    corpus, findings = asked.directory / asked.target / "corpus", asked.directory / asked.target / "findings"
    targets.seeds_of(asked.target, seeds(), corpus)
    judge = Judge(targets.reader(asked.target, place), findings)

    def one(data: bytes) -> None:
        judge(data)
        if judge.seconds() > asked.seconds:
            print(judge.summary(), flush=True)
            (findings.parent / f"summary-{asked.seed}.json").write_text(judge.summary())
            shutil.rmtree(place)
            sys.stderr.flush()
            os._exit(1 if judge.findings else 0)  # libFuzzer knows no other end of a run

    def mutate(data: bytes, longest: int, seed: int) -> bytes:
        rng = random.Random(seed)
        begun = rng.choice(judge.loaded) if judge.loaded and rng.random() < 0.5 else data
        made = atheris.Mutate(begun, longest) if rng.random() < 0.2 else changed(begun, rng)
        return bytes(made)[:longest]

    options = ["-max_len=%d" % LONGEST_INPUT, "-timeout=%d" % SLOWEST_EVER, "-rss_limit_mb=3000", f"-seed={asked.seed}"]
    options += ["-print_final_stats=0", "-verbosity=0", f"-artifact_prefix={findings}/", str(corpus)]
    atheris.Setup([sys.argv[0], *options], one, custom_mutator=mutate)
    atheris.Fuzz()


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--target", choices=list(targets.TARGETS), required=True)
    parser.add_argument("--seconds", type=float, default=600.0, help="processor time")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--directory", type=Path, default=Path(tempfile.gettempdir()) / "cdpr-fuzz")
    return parser.parse_args()


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    main()
