"""Script B: let the tool diagnose each campaign, one process a case, given the campaign directory and nothing else."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Collection, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

TIME_LIMIT = 900.0  # s
RESULT, RECORD = "result.json", "run.json"


def default_command() -> list[str]:
    """The installed program beside the interpreter that runs the harness."""
    return [str(Path(sys.executable).with_name("cdpr-struct")), "diagnose"]


def diagnose_all(
    campaigns: Path,
    answers: Path,
    budget: str,
    workers: int,
    command: Sequence[str],
    again: bool = False,
    only: Collection[str] | None = None,
    scheduler: str | None = None,
) -> int:
    """Run every campaign (of those in `only`) that has no answer yet; returns how many were run.

    scheduler : address of a Dask scheduler whose workers see the same files, in place of `workers` of this machine
    """
    names = sorted(path.parent.name for path in campaigns.glob("*/campaign.toml"))
    names = [name for name in names if only is None or name in only]
    todo = [name for name in names if again or not (answers / name / RECORD).exists()]
    columns = (TextColumn("diagnose"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, disable=not sys.stderr.isatty()) as bar, _pool(workers, scheduler) as pool:
        task = bar.add_task("diagnose", total=len(todo))
        jobs = [pool.submit(diagnose, campaigns / n, answers / n, budget, command) for n in todo]
        for job in jobs:
            job.add_done_callback(lambda _: bar.advance(task))
        for job in jobs:
            job.result()
    return len(todo)


@contextmanager
def _pool(workers: int, scheduler: str | None) -> Iterator[Executor]:
    if scheduler is None:
        with ThreadPoolExecutor(workers) as pool:
            yield pool
        return
    from dask.distributed import Client

    with Client(scheduler, timeout=10) as client:
        yield client.get_executor()


def diagnose(campaign: Path, answer: Path, budget: str, command: Sequence[str]) -> None:
    """One diagnosis on a copy of the campaign, away from everything else; the record is written last."""
    answer.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="blind-") as place:
        work = Path(place)
        shutil.copytree(campaign, work / "campaign")
        call = [*command, str(work / "campaign" / "campaign.toml"), "--out", str(work / "out"), "--budget", budget]
        started = time.perf_counter()
        code, said = _called(call, work)
        seconds = time.perf_counter() - started
        for name in (RESULT, "extended_robot.toml"):
            if (work / "out" / name).exists():
                shutil.copy(work / "out" / name, answer / name)
    record = {"exit_code": code, "seconds": round(seconds, 2), "budget": budget, "stderr": said[-2000:]}
    (answer / RECORD).write_text(json.dumps(record, indent=1) + "\n", "utf-8")


def _called(call: list[str], work: Path) -> tuple[int, str]:
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            call, cwd=work, env=environment, capture_output=True, text=True, timeout=TIME_LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        return -1, f"stopped after {TIME_LIMIT:g} s"
    return done.returncode, done.stderr
