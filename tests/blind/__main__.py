"""python -m tests.blind make|run|score|report|sizes|mesh

make   draws campaigns and seals their truth        (script A)
run    diagnoses every campaign without an answer   (script B)
score  opens the truth and computes the figures     (script C)
report writes OUT/blind_tests.md, of a final set docs/blind_tests.md
sizes  measures the referee's smallest detectable sizes again
mesh   measures the error of the referee's mesh again
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")

from rich.progress import track

from tests.blind.answers import asking_for_more
from tests.blind.campaign_files import write_case
from tests.blind.case_drawing import ROBOTS, CaseKind, can_be_separated, drawn_case
from tests.blind.detectability import write_table
from tests.blind.mesh_error import all_mesh_errors
from tests.blind.moving_scoring import moving_figures, moving_page, moving_rows
from tests.blind.moving_sets import MovingKind, moving_case, moving_kinds
from tests.blind.report_page import write_page
from tests.blind.running import default_command, diagnose_all
from tests.blind.scoring import case_rows, figures, scored_cases
from tests.blind.spoilt_scoring import spoilt_figures, spoilt_page, spoilt_rows
from tests.blind.spoilt_sets import RECORDED, SpoiltKind, spoilt_cases, spoilt_kinds
from tests.blind.suite import FINAL_RATES, FULL, composed, record_final_use, set_seed

_Group = tuple[list[tuple[str, SpoiltKind]], int, Path, Path]  # named kinds of one reality, seed, where to
_Moving = tuple[MovingKind, str, tuple[int, ...], Path, Path]
Job = tuple[CaseKind, str, tuple[int, ...], Path, Path]  # what, name, seed, where to, where the truth goes
DOCS = Path(__file__).resolve().parents[2] / "docs" / "blind_tests.md"
MESH = Path(__file__).with_name("mesh_error.json")
FOLLOW_UPS = "followups"  # ambiguous cases measured again
RATES = "rates"  # more nulls, just detectable effects and pairs beside a final set, which has few of each
WHOLE = {"dev": 200, "final": 200, "ci": 12, "unseen": 24, "laws": 8, "rare": 150, "rates": 800}
WHOLE |= {"outside-dev": 24, "outside-held": 24, "conventions": 40, "conventions-small": 40, "no-conventions": 200}
SPOILT = {"messy": 270, "peaks": 180, "sizes": 224, "messy-dev": 81, "peaks-dev": 63, "sizes-dev": 64}
SPOILT |= {"few": 180, "few-dev": 144, "causes": 620, "one-cable": 40}
SPOILT |= {"unread": 42, "wheels": 90, "unread-dev": 12, "wheels-dev": 12}
SPOILT |= {name + part: size for name in RECORDED for part, size in (("", 90), ("-dev", 30))}
MOVING = {"delays": 120, "delays-dev": 30}
SETS = WHOLE | SPOILT | MOVING


def campaigns_of(out: Path) -> Path:
    """Where the campaigns are: all that a diagnosis may see."""
    return out / "campaigns"


def sealed_of(options: argparse.Namespace) -> Path:
    """Where the truth is."""
    return Path(options.sealed) if options.sealed else Path(options.out).with_name(Path(options.out).name + "-sealed")


def make(options: argparse.Namespace) -> int:
    """Draw and write all cases of a set that are not there yet, or all again."""
    out, sealed = Path(options.out), sealed_of(options)
    total = options.count or SETS[options.set]
    run = {"set": options.set, "release": options.release, "count": total}
    if other := _other_set(out, run):
        print(f"tests.blind: --out {out} holds {other}; give another directory", file=sys.stderr)
        return 2
    if options.set in SPOILT:
        jobs: list[Any] = _groups(options.set, options.release, total, out, sealed)
    elif options.set in MOVING:
        jobs = _moving(options.set, options.release, total, out, sealed)
    else:
        jobs = jobs_of(options.set, options.release, total, out, sealed, options.again)
    if options.set == "final":
        more = round(total * sum(FINAL_RATES.values()) / sum(FULL.values()))
        jobs += jobs_of("final-rates", options.release, more, out / RATES, sealed / RATES, options.again)
    if options.set == "final" and not (out / "run.json").exists():
        record_final_use(options.release)
    out.mkdir(parents=True, exist_ok=True)
    (out / "run.json").write_text(json.dumps(run) + "\n", "utf-8")
    with ProcessPoolExecutor(options.workers) as pool:
        maker = _made_group if options.set in SPOILT else _made_moving if options.set in MOVING else make_case
        made = pool.map(maker, jobs)
        for _ in track(made, "make", len(jobs), disable=not sys.stderr.isatty()):
            pass
    return 0


def jobs_of(name: str, release: str, total: int, out: Path, sealed: Path, again: bool = False) -> list[Job]:
    """What is still to be made of a set, or all of it."""
    base = set_seed(name, release)
    kinds = composed(name, total, base)
    letter = "r" if name == "final-rates" else "c"
    jobs = [(kind, f"{letter}{n:03d}", (base, n), out, sealed) for n, kind in enumerate(kinds, start=1)]
    return [job for job in jobs if again or not (campaigns_of(out) / job[1] / "manifest.json").exists()]


def _groups(name: str, release: str, total: int, out: Path, sealed: Path) -> list[_Group]:
    """What is still to be made of a set of spoilt campaigns; cases of one reality together, since it is drawn once."""
    base = set_seed(name, release)
    groups: dict[int, list[tuple[str, SpoiltKind]]] = {}
    for number, kind in enumerate(spoilt_kinds(name, total, base), start=1):
        groups.setdefault(kind.group, []).append((f"c{number:03d}", kind))
    written = {path.parent.name for path in campaigns_of(out).glob("*/manifest.json")}
    return [(kinds, base, out, sealed) for kinds in groups.values() if not {case for case, _ in kinds} <= written]


def _moving(name: str, release: str, total: int, out: Path, sealed: Path) -> list[_Moving]:
    """What is still to be made of a set of motions."""
    base = set_seed(name, release)
    jobs = [(kind, f"c{n:03d}", (base, n), out, sealed) for n, kind in enumerate(moving_kinds(total, base), start=1)]
    return [job for job in jobs if not (campaigns_of(out) / job[1] / "manifest.json").exists()]


def _made_moving(job: _Moving) -> None:
    kind, name, seed, out, sealed = job
    write_case(moving_case(kind, seed), name, seed, campaigns_of(out), sealed)


def _made_group(job: _Group) -> None:
    kinds, base, out, sealed = job
    for name, case, seed in spoilt_cases(kinds, base):
        write_case(case, name, seed, campaigns_of(out), sealed)


def _other_set(out: Path, run: dict[str, Any]) -> str:
    """What a directory holds, if that is not this set; there may be less or more of the same one."""
    file = out / "run.json"
    held = json.loads(file.read_text("utf-8")) if file.exists() else run
    same = all(held[key] == run[key] for key in ("set", "release"))
    return "" if same else f"the set {held['set']} {held['release']}".strip()


def make_case(job: Job) -> None:
    """Write a campaign and its truth, of an ambiguous case also the follow-up."""
    kind, name, seed, out, sealed = job
    if can_be_separated(kind):
        more = drawn_case(replace(kind, separated=True), seed)
        write_case(more, name, seed, campaigns_of(out / FOLLOW_UPS), sealed / FOLLOW_UPS)
    write_case(drawn_case(kind, seed), name, seed, campaigns_of(out), sealed)


def run(options: argparse.Namespace) -> int:
    """Diagnose what has no answer yet."""
    out = Path(options.out)
    command = shlex.split(options.command) if options.command else default_command()
    about = json.loads((out / "run.json").read_text("utf-8")) | {"budget": options.budget}
    (out / "run.json").write_text(json.dumps(about) + "\n", "utf-8")
    how = (options.budget, options.workers, command, options.again)
    diagnose_all(campaigns_of(out), out / "answers", *how, scheduler=options.scheduler)
    untimed = (options.budget, max(options.workers, os.cpu_count() or 1), command, options.again)
    diagnose_all(campaigns_of(out / RATES), out / RATES / "answers", *untimed, scheduler=options.scheduler)
    more = out / FOLLOW_UPS
    asking = asking_for_more(out / "answers")
    diagnose_all(campaigns_of(more), more / "answers", *how, only=asking, scheduler=options.scheduler)
    return 0


def score(options: argparse.Namespace) -> int:
    """Compute the figures; prints them and writes score.json."""
    out = Path(options.out)
    cases, served, rates = (
        scored_cases(campaigns_of(out / part), out / part / "answers", sealed_of(options) / part)
        for part in ("", FOLLOW_UPS, RATES)
    )
    about: dict[str, Any] = json.loads((out / "run.json").read_text("utf-8"))
    about["date"] = datetime.now(UTC).date().isoformat()
    if about["set"] in SPOILT:
        found = spoilt_rows(cases, case_rows(cases))
        return _scored({"run": about, "figures": spoilt_figures(cases), "rows": found}, out)
    if about["set"] in MOVING:
        return _scored({"run": about, "figures": moving_figures(cases), "rows": moving_rows(cases)}, out)
    rows = {"rows": case_rows(cases), "rates": case_rows(rates)}
    return _scored({"run": about, "figures": figures(cases, served, rates)} | rows, out)


def _scored(scores: dict[str, Any], out: Path) -> int:
    (out / "score.json").write_text(json.dumps(scores, indent=1) + "\n", "utf-8")
    print(json.dumps(scores["figures"], indent=1))
    return 0


def report(options: argparse.Namespace) -> int:
    """Write the page from score.json: that of the docs for a final set."""
    scores = json.loads((Path(options.out) / "score.json").read_text("utf-8"))
    mesh = json.loads(MESH.read_text("utf-8")) if MESH.exists() else None
    own = DOCS if scores["run"]["set"] == "final" else Path(options.out) / DOCS.name
    page = Path(options.page) if options.page else own
    if scores["run"]["set"] in SPOILT:
        page.write_text(spoilt_page(scores), "utf-8")
    elif scores["run"]["set"] in MOVING:
        page.write_text(moving_page(scores), "utf-8")
    else:
        write_page(scores, page, mesh)
    print(f"Written: {page}")
    return 0


def sizes(options: argparse.Namespace) -> int:
    """Measure the smallest detectable sizes of the robots named, or of all."""
    robots = [options.robot] if options.robot else list(ROBOTS)
    write_table(robots, options.workers)
    write_table(robots, options.workers, statics=True)
    return 0


def mesh(_: argparse.Namespace) -> int:
    """Measure the mesh error of all robots."""
    MESH.write_text(json.dumps(all_mesh_errors(), indent=1) + "\n", "utf-8")
    return 0


def main(arguments: list[str] | None = None) -> int:
    """Command line of the harness."""
    parser = argparse.ArgumentParser(prog="python -m tests.blind", description=__doc__.splitlines()[0])
    parser.add_argument("step", choices=("make", "run", "score", "report", "sizes", "mesh"))
    parser.add_argument("--set", choices=tuple(SETS), default="dev")
    parser.add_argument("--count", type=int, default=0, help="cases (default: the whole set)")
    parser.add_argument("--out", default="", help="directory of campaigns and answers (default: results/blind-SET)")
    parser.add_argument("--sealed", default="", help="directory of the truth (default: OUT-sealed)")
    parser.add_argument("--release", default="", help="name of a release, whose own seeds are taken")
    parser.add_argument("--budget", choices=("small", "full"), default="small")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--scheduler", help="address of a Dask scheduler that shares out the diagnoses of run")
    parser.add_argument("--command", default="", help="what to run instead of cdpr-struct diagnose")
    parser.add_argument("--again", action="store_true", help="make, or diagnose, also what is there")
    parser.add_argument("--page", default="", help="page that report writes")
    parser.add_argument("--robot", default="", help="robot whose sizes are measured")
    options = parser.parse_args(arguments)
    options.out = options.out or f"results/blind-{options.set}"
    steps = {"make": make, "run": run, "score": score, "report": report, "sizes": sizes, "mesh": mesh}
    return steps[options.step](options)


if __name__ == "__main__":
    sys.exit(main())
