"""Answers of every method to every campaign, in the form in which the blind tests store those of the diagnosis.

Nothing here can see a truth: it gets the directory of campaigns only, and the answers are written before any is scored.
"""

from __future__ import annotations

import json
import sys
import time
import traceback
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from rich.progress import track

from benchmarks.diagnosis_baselines.evidence_methods import linear_evidence, noise_evidence
from benchmarks.diagnosis_baselines.material import Material, kept_material, write_whole
from benchmarks.diagnosis_baselines.parameter_methods import largest_drop, lasso, matching_pursuit, ridge
from benchmarks.diagnosis_baselines.stepwise_bic import stepwise_bic, stepwise_extended_bic
from tests.blind.running import RECORD, RESULT

METHODS: dict[str, Callable[[Material], tuple[str, ...]]] = {
    "largest_drop": largest_drop,
    "ridge": ridge,
    "lasso": lasso,
    "matching_pursuit": matching_pursuit,
    "stepwise_bic": stepwise_bic,
    "stepwise_extended_bic": stepwise_extended_bic,
    "noise_evidence": noise_evidence,
    "linear_evidence": linear_evidence,
}
SURE, UNSURE = 0.95, 0.5  # a single name counts as said with confidence, several do not


def answer_all(campaigns: Path, out: Path, names: list[str], workers: int, again: bool = False) -> int:
    """Answer every case that some method has not answered yet; returns how many were answered."""
    todo = [name for name in names if again or not all(_record(out, m, name).exists() for m in METHODS)]
    with ProcessPoolExecutor(workers) as pool:
        jobs = [pool.submit(answer, campaigns / name / "campaign.toml", out, name) for name in todo]
        for job in track(as_completed(jobs), "answer", len(jobs), disable=not sys.stderr.isatty()):
            job.result()
    return len(todo)


def answer(campaign: Path, out: Path, name: str) -> None:
    """Answers of all methods to one case; one that breaks has failed, and says so in its record."""
    try:
        material = kept_material(campaign, out / "material" / f"{name}.pickle")
    except Exception:
        for method in METHODS:
            _store(_record(out, method, name), None, 0.0, traceback.format_exc())
        return
    for method, choose in METHODS.items():
        started, said, error = time.perf_counter(), None, ""
        try:
            said = verdict(choose(material))
        except Exception:
            error = traceback.format_exc()
        _store(_record(out, method, name), said, time.perf_counter() - started, error)


def verdict(causes: tuple[str, ...]) -> dict[str, Any]:
    """The causes named by a method as a verdict of the diagnosis would say them."""
    if not causes:
        return {"status": "adequate", "causes": [], "class": [], "probability": SURE}
    return {"status": "named", "causes": [*causes], "class": [], "probability": SURE if len(causes) == 1 else UNSURE}


def answers_of(out: Path, method: str) -> Path:
    """Directory of a method's answers."""
    return out / "answers" / method


def _record(out: Path, method: str, name: str) -> Path:
    return answers_of(out, method) / name / RECORD


def _store(record: Path, said: dict[str, Any] | None, seconds: float, error: str) -> None:
    """The verdict first, the record last: a case with a record is done."""
    record.parent.mkdir(parents=True, exist_ok=True)
    result = record.with_name(RESULT)
    if said is None:
        result.unlink(missing_ok=True)
    else:
        write_whole(result, (json.dumps({"verdict": said}, indent=1) + "\n").encode())
    entry = {"exit_code": int(said is None), "seconds": round(seconds, 3), "stderr": error[-2000:]}
    write_whole(record, (json.dumps(entry, indent=1) + "\n").encode())
