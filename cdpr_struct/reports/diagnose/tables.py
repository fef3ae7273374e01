"""Tables of a diagnosis as text, the same on the screen and on the page."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from cdpr_struct.reports.diagnose.words import quantity
from cdpr_struct.reports.html import HtmlTable
from cdpr_struct.reports.text import with_sigma
from cdpr_struct.reports.tolerances_told import defaults_used
from cdpr_struct.robot.tolerances import tolerance_unit

Row = Mapping[str, Any]


def standing(result: Row) -> list[str]:
    """Status, probability and p-value in one line, then each class of several causes."""
    said = result["verdict"]
    lines = [f"status: {said['status']}; probability {percentage(said['probability'])}; p = {result['p_value']:.2g}"]
    lines += [f"class: {' | '.join(names)}" for names in said["class"] if len(names) > 1]
    if said["status"] == "class" and len(lines) == 1:
        lines.append(f"reported as a class: {_why_unnamed(result['gain'])}")
    return lines


def _why_unnamed(gain: Row) -> str:
    """Why the only cause of a class has no name."""
    if gain["ratio"] is None and gain["added_mode_nats"] is None:
        return "a single state leaves no held-out data to confirm the cause"
    return "no cause is likely enough" if gain["confirmed"] else "held-out states do not confirm the cause"


def percentage(probability: float) -> str:
    """A probability with two decimals, never one or zero."""
    return "above 0.99" if probability > 0.995 else "below 0.01" if probability < 0.005 else f"{probability:.2f}"


def errors(result: Row) -> HtmlTable:
    """Simulation against measurement, kind by kind."""
    some = any(row["expected"] is not None for row in result["simulation_error"])
    rows = [
        [
            row["kind"], f"{row['rms']:.3g}", *(_expected(row) if some else ()), row["unit"],
            "" if row["chi2_per_n"] is None else figure(row["chi2_per_n"], 2), _place(row["worst"]),
        ]
        for row in result["simulation_error"]
    ]  # fmt: skip
    note = "p: upper bound of the probability of evidence this strong against the nominal model if nothing were wrong."
    columns = ["kind", "rms", *(("expected",) if some else ()), "unit", "chi2/n", "worst"]
    prose = frozenset({len(columns) - 3, len(columns) - 1})
    return HtmlTable("Simulation against measurement", columns, rows, note * bool(result["significant"]), prose=prose)


def _expected(row: Row) -> list[str]:
    return ["" if row["expected"] is None else f"{row['expected']:.3g}"]


def _place(worst: Row) -> str:
    return f"{worst['case']}" + (f", cable {worst['cable']}" if "cable" in worst else "")


def figure(value: float, decimals: int = 1) -> str:
    """A number that a person reads: decimals up to ten thousand, beyond it one digit and a power of ten."""
    return f"{value:.{decimals}f}" if abs(value) < 1e4 else f"{value:.0e}".replace("e+", "e").replace("e0", "e")


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """One cause, or several that were fitted together and share one evidence; sizes by name."""

    causes: tuple[str, ...]
    gain: float
    explained: float | None
    sizes: dict[str, Row]
    words: str = ""

    @property
    def name(self) -> str:
        """Its causes, joined."""
        return " + ".join(self.causes)


def hypotheses(rows: Sequence[Row]) -> list[Hypothesis]:
    """Candidates as they were judged: rows of one fit are one hypothesis, whose evidence counts once."""
    found: list[Hypothesis] = []
    for row in rows:
        causes = (row["cause"], *row.get("with", ()))
        last = found[-1] if found else None
        if last and set(causes) == set(last.causes) and row["log_evidence_gain"] == last.gain:
            last.sizes.update(row["parameters"])
            continue
        sizes, words = dict(row["parameters"]), row.get("description", "")
        found.append(Hypothesis(causes, row["log_evidence_gain"], row["explained_fraction"], sizes, words))
    return found


def candidates(rows: Sequence[Row], most: int, sizes: int) -> HtmlTable | None:
    """Corrections and the likeliest hypotheses, `most` in all, with the clearest few sizes of each."""
    shown = [
        [h.name, figure(h.gain), f"{100.0 * h.explained:.0f}" if h.explained else "", _first(h, sizes)]
        for h in hypotheses(rows)[:most]
    ]
    note = "Evidence: log Bayes factor against the nominal model, prior included (3 nats = a factor of 20). "
    note += "Explained: share of the excess chi-squared removed by the cause."
    if any(row.get("description") for row in rows):
        note += " Evidence of a correction is against the data as recorded; that of causes against the corrected data."
    columns = ["cause", "evidence [nats]", "explained [%]", "size"]
    return HtmlTable("Candidates", columns, shown, note, prose=frozenset({3})) if shown else None


def all_sizes(rows: Sequence[Row]) -> HtmlTable | None:
    """Every number of every hypothesis."""
    shown = [
        [h.name, name, with_sigma(p["value"], p["sigma"]), p["unit"]]
        for h in hypotheses(rows)
        for name, p in h.sizes.items()
    ]
    columns = ["candidate", "parameter", "size", "unit"]
    note = "Sizes are total deviations: cause and tolerance of the same parameter together."
    return HtmlTable("Sizes of all candidates", columns, shown, note, prose=frozenset({1, 3})) if shown else None


def _first(hypothesis: Hypothesis, count: int) -> str:
    """The sizes that are largest in sigmas, or what a correction does."""
    if not hypothesis.sizes:
        return hypothesis.words
    clearest = sorted(hypothesis.sizes, key=lambda name: -_sigmas(hypothesis.sizes[name]))[:count]
    kept = [(name, p) for name, p in hypothesis.sizes.items() if name in clearest]
    shown = [f"{name} {with_sigma(p['value'], p['sigma'])} {p['unit']}" for name, p in kept]
    more = len(hypothesis.sizes) - count
    return "; ".join(shown) + (f"; {more} more" if more > 0 else "")


def _sigmas(size: Row) -> float:
    """How many sigmas a size is off what was entered; zero without a sigma."""
    off = abs(size["value"] - (1.0 if size["unit"] == "ratio" else 0.0))
    return off / size["sigma"] if size["sigma"] and math.isfinite(size["sigma"]) and size["sigma"] > 0.0 else 0.0


def left_out(gain: Row) -> HtmlTable | None:
    """States that were left out, predicted from the rest: the same readings and unit as the gain that is claimed."""
    if not gain["per_kind"]:
        return None
    rows = [
        [kind, f"{g['counted']} of {g['of']}", f"{g['before_sigmas']:.2f}", f"{g['after_sigmas']:.2f}",
         f"{g['ratio']:.2f}"]
        for kind, g in gain["per_kind"].items()
    ]  # fmt: skip
    together = [gain["heldout_rms_before"], gain["heldout_rms_after"], gain["ratio"]]
    rows.append(["all of these", f"{gain['counted']} of {gain['of']}", *(f"{v:.2f}" for v in together)])
    note = "Counted: readings that the causes, fitted to the other states, change by more than one sigma. "
    note += "Sigmas here include the estimated noise factors; chi2/n uses the stated sigmas."
    if not gain["confirmed"]:
        note += " Held-out states do not confirm the causes, so no gain is claimed."
    title = f"Each {gain['left_out']} predicted from the others, rms error in sigmas"
    return HtmlTable(title, ["kind", "counted", "before", "after", "times smaller"], rows, note)


def noise(rows: Sequence[Row], all_of_them: bool = True) -> HtmlTable | None:
    """How much each kind of sensor scatters; on a screen only where it is not as stated, within a third."""
    shown = [row for row in rows if all_of_them or row["outliers"] or not 2.0 / 3.0 < row["factor"] < 1.5]
    cells = [
        [row["kind"].replace("_", " "), f"{row['factor']:.2f}", str(row["outliers"]), str(row["readings"])]
        for row in shown
    ]
    note = (
        "Factor: estimated scatter over the stated sigma, without outliers. Outlier: five or more times that scatter."
    )
    columns = ["sensor", "factor on sigma", "outliers", "of readings"]
    return HtmlTable("Sensor noise", columns, cells, note) if cells else None


def set_aside(rows: Sequence[Row]) -> HtmlTable | None:
    """Readings that contradict all others."""
    cells = [
        [quantity(row["kind"], row["frequency_hz"]), row["case"], str(row["cable"]) if row["cable"] else "",
         figure(row["off_sigmas"]), figure(row["log_evidence_gain"])]
        for row in rows
    ]  # fmt: skip
    note = (
        "These readings are down-weighted, not removed. Evidence: increase of the log evidence if the reading is wrong."
    )
    columns = ["reading", "case", "cable", "off by [sigma]", "evidence [nats]"]
    return HtmlTable("Readings that contradict all others", columns, cells, note) if cells else None


def next_steps(steps: Sequence[str]) -> HtmlTable | None:
    """What to measure next, one proposal a row."""
    rows = [[f"{i}. {step}"] for i, step in enumerate(steps, start=1)]
    note = "Nats: expected log evidence between the two causes, whichever is true (3 nats = a factor of 20)."
    shown = note if any("nats" in step for step in steps) else ""
    return HtmlTable("To measure next", ["proposal"], rows, shown) if rows else None


def sigmas(rows: Sequence[Row]) -> HtmlTable | None:
    """Every sigma that was used and where it is from."""
    cells = [[s["kind"], s["file"], s["sigma"], s["words"], s["source"]] for s in rows]
    note = "One sigma of each reading. A state named in several files has the pose sigmas of the first file."
    columns = ["kind", "file", "sigma", "size", "source"]
    return HtmlTable("Sigmas of the sensors", columns, cells, note, prose=frozenset({1, 2, 4})) if cells else None


def default_sigmas(rows: Sequence[Row]) -> str:
    """One line for a terminal about sigmas that nobody gave."""
    files: dict[str, list[str]] = {}
    for s in rows:
        if s["source"] == "default":
            files.setdefault(f"{s['sigma']} {s['words']}", []).append(s["file"])
    given = [f"{sigma} ({', '.join(names)})" for sigma, names in files.items()]
    return f"Sigmas not given, defaults used: {', '.join(given)}." if given else ""


def not_shown(result: Row) -> HtmlTable:
    """What these data cannot show."""
    why = [[name.replace("_", " "), reason] for name, reason in sorted(result["why_not_testable"].items())]
    return HtmlTable("What these data cannot show", ["cause", "why"], why, prose=frozenset({1}))


def detectable(result: Row) -> HtmlTable:
    """The smallest sizes that would be found, of every pattern of occurrence."""
    rows = [
        [name.replace("_", " "), *(_sizes_of(found, kind) for kind in _PATTERNS), str(found[0]["unit"])]
        for name, found in result["detectable_by_pattern"].items()
    ]
    columns = ["cause", *_PATTERNS.values(), "unit"]
    note = (
        "With the tolerances and sigmas that were used. Of several numbers their rms; of one alone the best and worst."
    )
    title = "Smallest detectable size (found in 4 of 5 cases)"
    return HtmlTable(title, columns, rows, note, prose=frozenset({len(columns) - 1}))


_PATTERNS = {"all alike": "all alike", "each its own": "each its own", " alone": "one alone", "": "as a whole"}
"""Ends of a pattern's label, and its column."""


def _sizes_of(found: Sequence[Row], kind: str) -> str:
    """Sizes of the patterns of a kind, the smallest and the largest."""
    ends = [end for end in _PATTERNS if end]
    own = [
        row["value"] for row in found
        if (kind in row["pattern"] if kind else not any(end in row["pattern"] for end in ends))
    ]  # fmt: skip
    if not own:
        return ""
    least, most = f"{min(own):.2g}", f"{max(own):.2g}"
    return least if least == most else f"{least} to {most}"


def assumed(result: Row) -> str:
    """One line for a terminal about sigmas and tolerances that nobody gave."""
    return " ".join(filter(None, [default_sigmas(result["sigmas"]), defaults_used(result["tolerances"])]))


def tolerances(result: Row) -> HtmlTable:
    """Tolerances that were taken into account."""
    rows = [
        [n, f"{v['value']:g}", tolerance_unit(n) or "of its value", "stated" if v["stated"] else "default"]
        for n, v in result["tolerances"].items()
    ]
    columns = ["tolerance", "size", "unit", "source"]
    return HtmlTable("Tolerances taken into account, one sigma", columns, rows, prose=frozenset({2, 3}))
