"""What do the hand-set constants of the diagnosis do to its verdicts, when they are halved and doubled?

    python -m tests.blind make --set messy-dev --out results/messy-dev      likewise peaks-dev and dev
    python -m benchmarks.diagnosis_constants --blind results                15 to 30 minutes on one core
    python -m benchmarks.diagnosis_constants --blind results --write        and puts the table into the page

Each campaign is diagnosed as is, and once more for every constant and factor. Results are kept in --log, line by line,
so that an interrupted run goes on; --only SET/CASE ... limits the campaigns. Constants that act on damping ratios, FRFs
or plans alone are tried on these.
"""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")

from benchmarks.hand_set import HAND_SET, Constant, changed
from benchmarks.markdown_page import put, table
from cdpr_struct.diagnosis import diagnosing
from cdpr_struct.diagnosis.damping_law import damping_finding
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.hypotheses import search
from cdpr_struct.hypotheses.explain import Explained, explained
from cdpr_struct.hypotheses.search import BUDGETS
from cdpr_struct.hypotheses.significant import p_of_null
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.planning.campaign_plan import planned
from tests.blind.answers import LARGEST_AMBIGUOUS_CLASS, Answer, names_in_truth, right_answer, right_class
from tests.blind.campaign_files import opened_truth
from tests.crosscheck.frf_campaign import Shaken, fem_campaign
from tests.laws.test_signal_modes import rows as damping_ratios

PAGE = Path(__file__).parents[1] / "docs" / "diagnosis_constants.md"
CAMPAIGNS = (
    "messy-dev/c062", "messy-dev/c054", "messy-dev/c001", "messy-dev/c003", "messy-dev/c011", "messy-dev/c007",
    "dev/c042", "dev/c052", "dev/c004", "peaks-dev/c009", "dev/c005", "dev/c019",
)  # fmt: skip
PLANS = ("messy-dev/c003", "dev/c003", "dev/c009")
DAMPING = {
    "entered": (0.0, "adequate", ()), "material": (8e-4, "named", ("viscous_damping",)),
    "structural": (0.02, "named", ("hysteretic_damping",)), "friction": (0.02, "named", ("coulomb_damping",)),
}  # fmt: skip
SEEDS, STRONG = (3, 4, 5), (1.0, 0.1)
GAINS = {"right gain": 1.0, "gain 1.15": 1.15}
FACTORS = (0.5, 2.0)
HEAD = ["file", "constant", "value", "what it is", "origin", "right at half, as is, double", "changed at half, double"]


@dataclass(frozen=True, slots=True)
class Found:
    """A verdict, whether it is right (None: nobody knows), and what is said beside it."""

    verdict: str
    right: bool | None
    beside: str = ""


@dataclass(frozen=True, slots=True)
class Case:
    """Something to diagnose, as is or with a constant times a factor."""

    group: str
    name: str
    run: Callable[[Constant | None, float], Found]


def _verdict(found: Diagnosis) -> str:
    classes = sorted("|".join(sorted(names)) for names in found.decision.classes)
    return " ".join([found.decision.status, *classes])


def _beside(found: Diagnosis) -> str:
    left = found.left_out
    gain = "" if left is None or not left.concerned.any() else f"gain {left.ratio(left.concerned):.1f}"
    return f"{len(found.set_aside)} outliers {gain}"


def _is_right(found: Diagnosis, truth: dict[str, Any]) -> bool:
    """As `tests.blind score` counts: spoilt campaigns may leave a class of four."""
    said = found.decision
    names = tuple(own[0] for own in said.classes)
    answer = Answer(said.status, names, said.classes, said.probability, 0.0, {})
    if "way" in truth and truth["kind"] != "null":
        return right_class(answer, names_in_truth(truth), LARGEST_AMBIGUOUS_CLASS)
    return right_answer(answer, truth)


class _PValue(float):
    """A p-value of the null model that knows what it was computed from."""

    origin: tuple[Any, ...]


def _remembered(*origin: Any) -> _PValue:
    found = _PValue(p_of_null(*origin))
    found.origin = origin
    return found


def _searched(campaign: Campaign) -> list[Explained]:
    """The search for causes, whose p-values can be computed again."""
    search.p_of_null = _remembered
    try:
        return explained(campaign, BUDGETS["small"], lambda _: None)
    finally:
        search.p_of_null = p_of_null


def _diagnosed(campaign: Campaign, truth: dict[str, Any], searched: list[Explained] | None = None) -> Found:
    """From the start, or from a search on."""
    if searched is not None:
        for one in searched:
            assert isinstance(one.search.p_value, _PValue)
            one.search.p_value = _remembered(*one.search.p_value.origin)
        diagnosing.explained = lambda *_: searched  # type: ignore[assignment]
    try:
        found = diagnosing.diagnosed(campaign)
    finally:
        diagnosing.explained = explained
    return Found(_verdict(found), _is_right(found, truth), _beside(found))


def _blind(place: Path, name: str) -> Case:
    """One of `tests.blind`, with its truth; it is searched once, before any constant is changed."""
    group, number = name.split("/")
    file = place / group / "campaigns" / number / "campaign.toml"
    truth = opened_truth(number, file.parents[1], place / f"{group}-sealed")
    campaign = load_campaign(str(file))
    kept: list[list[Explained]] = []

    def run(constant: Constant | None, factor: float) -> Found:
        if not kept:
            kept.append(_searched(campaign))
        if constant is None:
            return _diagnosed(campaign, truth, kept[0])
        acts, before = constant.acts_by, None if constant.acts_by is None else constant.acts_by(campaign)
        with changed(constant, factor):
            beside = constant.beside or (acts is not None and acts(campaign) == before)
            return _diagnosed(campaign, truth, kept[0] if beside else None)

    return Case("verdicts", name, run)


def _simple(group: str, name: str, diagnose: Callable[[], Found]) -> Case:
    """Diagnosed from the start each time."""

    def run(constant: Constant | None, factor: float) -> Found:
        if constant is None:
            return diagnose()
        with changed(constant, factor):
            return diagnose()

    return Case(group, name, run)


def _plan(place: Path, name: str) -> Found:
    group, case = name.split("/")
    found = planned(load_campaign(str(place / group / "campaigns" / case / "campaign.toml")))
    first = ["".join(gain.measurement.family) for gain in found.gains[:5]]
    pairs = sorted((c.cause, c.taken_for) for c in found.confusable)
    return Found(", ".join(first), None, f"{pairs} {sorted(found.not_testable)}")


def _damping(law: str, seed: int, strong: float) -> Found:
    size, status, causes = DAMPING[law]
    found = damping_finding(damping_ratios(law, strong * size, seed), 0.3)
    said = " ".join([found.status, *sorted(found.causes)])
    held = found.status == "class" and set(causes) < set(found.causes)
    return Found(said, held or (found.status, found.causes) == (status, causes))


def _frf(gain: float) -> Found:
    """FRFs of the FEM; modal constants are made with the gain and held against a campaign that does not know it."""
    with tempfile.TemporaryDirectory() as folder:
        campaign = fem_campaign(Path(folder), Shaken(gain=(gain,) * 3))
        found = diagnosing.diagnosed(campaign)
    named = (("accelerometer_gain",),) if gain != 1.0 else ()
    return Found(_verdict(found), found.decision.classes == named, _beside(found))


def cases(place: Path, only: list[str]) -> Iterator[Case]:
    """Everything to be diagnosed, quick ones first."""
    for law, seed, strong in product(DAMPING, SEEDS, STRONG):
        yield _simple("damping", f"{law} {seed} x {strong:g}", partial(_damping, law, seed, strong))
    for name in PLANS:
        yield _simple("plans", name, partial(_plan, place, name))
    for name, gain in GAINS.items():
        yield _simple("frf", name, partial(_frf, gain))
    for name in only or CAMPAIGNS:
        yield _blind(place, name)


def measure(place: Path, only: list[str], log: Path) -> None:
    """Fill the log with what it does not hold yet."""
    done = {(row["case"], row["constant"], row["factor"]) for row in read(log)}
    for case in cases(place, only):
        todo = [(c, f) for c in HAND_SET if c.tried == case.group for f in FACTORS]
        left = [(c, f) for c, f in todo if (_key(case), c.key, f) not in done]
        if not left and (_key(case), "", 1.0) in done:
            continue
        _keep(log, case, "", 1.0, case.run(None, 1.0))
        for constant, factor in left:
            _keep(log, case, constant.key, factor, case.run(constant, factor))


def _key(case: Case) -> str:
    return f"{case.group} {case.name}"


def _keep(log: Path, case: Case, constant: str, factor: float, found: Found) -> None:
    row = {"case": _key(case), "constant": constant, "factor": factor, "verdict": found.verdict, "right": found.right}
    with log.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row | {"beside": found.beside}) + "\n")
    print(f"{_key(case):24} {constant or 'as is':16} {factor:3g}  {found.right!s:5}  {found.verdict}", flush=True)


def read(log: Path) -> list[dict[str, Any]]:
    """Rows of the log; of the same run the last."""
    if not log.exists():
        return []
    rows = [json.loads(line) for line in log.read_text("utf-8").splitlines()]
    return list({(row["case"], row["constant"], row["factor"]): row for row in rows}.values())


def results(log: Path) -> str:
    """The table: one line a constant."""
    found = {(row["case"], row["constant"], row["factor"]): row for row in read(log)}
    return table(HEAD, [_line(constant, found) for constant in HAND_SET])


def _line(constant: Constant, found: dict[tuple[str, str, float], dict[str, Any]]) -> list[str]:
    factors = (0.5, 1.0, 2.0)
    names = {f: constant.key if f != 1.0 else "" for f in factors}
    own = sorted({key[0] for key in found if key[1] == constant.key})
    own = [case for case in own if all((case, names[f], f) in found for f in factors)]
    first = [f"{constant.room}/{constant.file}.py", f"`{constant.name}`", _shown(constant.value)]
    first += [constant.words, constant.origin]
    if not own:
        return [*first, "-", "not tried: no set has the data"]
    rows = {f: [found[case, names[f], f] for case in own] for f in factors}
    known = all(row["right"] is not None for row in rows[1.0])
    right = ", ".join(str(sum(row["right"] for row in rows[f])) for f in factors) if known else "-"
    counted = f"{right} of {len(own)}" if known else "-"
    return [*first, counted, _changes(rows, len(own), constant.tried)]


def _changes(rows: dict[float, list[dict[str, Any]]], count: int, tried: str) -> str:
    """How many verdicts, and how many other statements, are not those as is."""
    differ = {
        part: [sum(a[part] != b[part] for a, b in zip(rows[f], rows[1.0], strict=True)) for f in FACTORS]
        for part in ("verdict", "beside")
    }
    what = {"plans": "plans", "damping": "laws", "frf": "verdicts", "verdicts": "verdicts"}[tried]
    said = f"{differ['verdict'][0]}, {differ['verdict'][1]} {what}"
    return said if tried == "damping" else f"{said}; {differ['beside'][0]}, {differ['beside'][1]} statements"


def _shown(value: Any) -> str:
    numbers = [float(one) for one in value] if hasattr(value, "__len__") else [float(value)]
    return ", ".join(f"{number:.4g}" for number in numbers)


def main(arguments: list[str]) -> int:
    """Measure, print the table; with --write also put it into the page."""
    parser = argparse.ArgumentParser("python -m benchmarks.diagnosis_constants", description=__doc__.splitlines()[0])
    parser.add_argument("--blind", default="results", help="directory of the sets messy-dev, peaks-dev and dev")
    parser.add_argument("--log", default="results/diagnosis_constants.jsonl", help="what was found so far")
    parser.add_argument("--only", nargs="*", default=[], metavar="SET/CASE", help="these campaigns alone")
    parser.add_argument("--table", action="store_true", help="no further diagnosis, only the table")
    parser.add_argument("--write", action="store_true", help="put the table into docs/diagnosis_constants.md")
    options = parser.parse_args(arguments)
    log = Path(options.log)
    log.parent.mkdir(parents=True, exist_ok=True)
    if not options.table:
        measure(Path(options.blind), options.only, log)
    text = results(log)
    print(text)
    if options.write:
        PAGE.write_text(put(PAGE.read_text("utf-8"), "hand-set", text), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
