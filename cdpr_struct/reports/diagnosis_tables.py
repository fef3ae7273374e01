"""Tables of a diagnosis as text, the same on the screen and on the page."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from cdpr_struct.reports.html import HtmlTable

_DECIDED = {
    "laws": "p is that of single laws, which look in few directions; chi2/n counts all readings alike.",
    "chi2": "p is that of chi2 of all readings together.",
    "strays": "p is that of so many robot frequencies without a mode.",
}


def standing(result: Mapping[str, Any]) -> list[str]:
    """Status, probability and p-value in one line, then each class that is not told apart."""
    said = result["verdict"]
    lines = [f"status: {said['status']}; probability {said['probability']:.2f}; p = {result['p_value']:.2g}"]
    lines += [f"class: {' | '.join(names)}" for names in said["class"] if len(names) > 1]
    if said["status"] == "class" and len(lines) == 1:
        lines.append("a class, not a name: nothing that was left out confirms it")
    return lines


def next_table(text: str) -> HtmlTable | None:
    """What to measure next, one proposal a row."""
    rows = [[f"{i}. {step}"] for i, step in enumerate(filter(None, text.split("; ")), start=1)]
    note = "Nats: expected evidence between the two, if either is the true one; three are a factor of twenty."
    return HtmlTable("To measure next", ["proposal"], rows, note if "nats" in text else "") if rows else None


def sigma_table(sigmas: Sequence[Mapping[str, Any]]) -> HtmlTable | None:
    """Every sigma that was used and where it is from."""
    rows = [[s["kind"], s["file"], s["sigma"], s["words"], s["source"]] for s in sigmas]
    note = "One sigma of each reading. A state that several files name has the pose sigmas of the first."
    return HtmlTable("Sigmas of the sensors", ["kind", "file", "sigma", "size", "source"], rows, note) if rows else None


def default_sigmas(sigmas: Sequence[Mapping[str, Any]]) -> str:
    """One line for a terminal about sigmas that nobody gave."""
    files: dict[str, list[str]] = {}
    for s in sigmas:
        if s["source"] == "default":
            files.setdefault(f"{s['sigma']} {s['words']}", []).append(s["file"])
    given = [f"{sigma} ({', '.join(names)})" for sigma, names in files.items()]
    return f"Sigmas not given, defaults used: {', '.join(given)}." if given else ""


def error_table(result: Mapping[str, Any]) -> HtmlTable:
    """Simulation against measurement, kind by kind; the note says what the p-value counts instead."""
    rows = [
        [
            row["kind"],
            f"{row['rms']:.3g}",
            _expected(row),
            row["unit"],
            figure(row["chi2_per_n"], 2),
            _place(row["worst"]),
        ]
        for row in result["simulation_error"]
    ]
    note = _DECIDED[result["p_value_of"]] if result["significant"] else ""
    return HtmlTable(
        "Simulation against measurement", ["kind", "rms", "expected", "unit", "chi2/n", "worst"], rows, note
    )


def _expected(row: Mapping[str, Any]) -> str:
    return "" if row["expected"] is None else f"{row['expected']:.3g}"


def _place(worst: Mapping[str, Any]) -> str:
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
    sizes: dict[str, Mapping[str, Any]]
    words: str = ""

    @property
    def name(self) -> str:
        """Its causes, joined."""
        return " + ".join(self.causes)


def hypotheses(candidates: Sequence[Mapping[str, Any]]) -> list[Hypothesis]:
    """Candidates as they were judged: rows of one fit are one hypothesis, whose evidence counts once."""
    found: list[Hypothesis] = []
    for row in candidates:
        causes = (row["cause"], *row.get("with", ()))
        last = found[-1] if found else None
        if last and set(causes) == set(last.causes) and row["log_evidence_gain"] == last.gain:
            last.sizes.update(row["parameters"])
            continue
        sizes, words = dict(row["parameters"]), row.get("description", "")
        found.append(Hypothesis(causes, row["log_evidence_gain"], row["explained_fraction"], sizes, words))
    return found


def candidate_table(candidates: Sequence[Mapping[str, Any]], most: int, sizes: int) -> HtmlTable | None:
    """What was mended and the likeliest hypotheses, `most` in all, with the clearest few sizes of each."""
    rows = [
        [h.name, figure(h.gain), f"{100.0 * h.explained:.0f}" if h.explained else "", _first(h, sizes)]
        for h in hypotheses(candidates)[:most]
    ]
    note = "Evidence is against nothing being wrong; three nats are a factor of twenty in probability. "
    note += "Explained is the share of chi2 beyond what noise lets expect."
    if any(row.get("description") for row in candidates):
        note += " That of corrections is against the data before them; where the verdict is unknown, they stand last: "
        note += "they were tried and do not suffice."
    note += _inner_names(candidates)
    columns = ["cause", "evidence [nats]", "explains [%]", "size"]
    return HtmlTable("Candidates", columns, rows, note) if rows else None


def size_table(candidates: Sequence[Mapping[str, Any]]) -> HtmlTable | None:
    """Every number of every hypothesis."""
    rows = [
        [h.name, name, with_sigma(p["value"], p["sigma"]), p["unit"]]
        for h in hypotheses(candidates)
        for name, p in h.sizes.items()
    ]
    columns = ["candidate", "parameter", "size", "unit"]
    return HtmlTable("Sizes of all candidates", columns, rows, _inner_names(candidates).strip()) if rows else None


def _inner_names(candidates: Sequence[Mapping[str, Any]]) -> str:
    """What the numbers of internal forces mean, where there are any."""
    if not any(name.startswith("null_space_") for row in candidates for name in row["parameters"]):
        return ""
    return " null_space_j_i is how far lengths are off along the j-th internal force of the i-th state."


def _first(hypothesis: Hypothesis, count: int) -> str:
    """The sizes that are largest in sigmas, or what a correction does."""
    if not hypothesis.sizes:
        return hypothesis.words
    clearest = sorted(hypothesis.sizes, key=lambda name: -_sigmas(hypothesis.sizes[name]))[:count]
    kept = [(name, p) for name, p in hypothesis.sizes.items() if name in clearest]
    shown = [f"{name} {with_sigma(p['value'], p['sigma'])} {p['unit']}" for name, p in kept]
    more = len(hypothesis.sizes) - count
    return "; ".join(shown) + (f"; {more} more" if more > 0 else "")


def _sigmas(size: Mapping[str, Any]) -> float:
    """How many sigmas a size is off what was entered; zero without a sigma."""
    off = abs(size["value"] - (1.0 if size["unit"] == "ratio" else 0.0))
    return off / size["sigma"] if size["sigma"] and math.isfinite(size["sigma"]) and size["sigma"] > 0.0 else 0.0


def with_sigma(value: float, sigma: float) -> str:
    """A size with the digits that its sigma allows."""
    if not (sigma > 0.0 and math.isfinite(sigma)):
        return f"{value:.4g}"
    decimals = 1 - math.floor(math.log10(sigma))
    if not -3 <= decimals <= 6:
        return f"{value:.4g} ± {sigma:.2g}"
    return f"{round(value, decimals) + 0.0:.{max(decimals, 0)}f} ± {round(sigma, decimals):.{max(decimals, 0)}f}"


def gain_table(gain: Mapping[str, Any]) -> HtmlTable | None:
    """What was left out, predicted from the rest: the same readings and the same unit as the gain that is claimed."""
    if not gain["per_kind"]:
        return None
    rows = [
        [kind, f"{g['counted']} of {g['of']}", f"{g['before_sigmas']:.2f}", f"{g['after_sigmas']:.2f}",
         f"{g['ratio']:.2f}"]
        for kind, g in gain["per_kind"].items()
    ]  # fmt: skip
    together = [gain["heldout_rms_before"], gain["heldout_rms_after"], gain["ratio"]]
    rows.append(["all of these", f"{gain['counted']} of {gain['of']}", *(f"{v:.2f}" for v in together)])
    note = "Counted are the readings that the causes, fitted to the rest, change by more than one sigma. "
    note += "Sigmas are those once the causes are known; chi2/n has those before, wider where peaks were in doubt."
    if not gain["confirmed"]:
        note += " This does not confirm the causes, so nothing is claimed from it."
    title = f"Each {gain['left_out']} predicted from the others, rms error in sigmas"
    return HtmlTable(title, ["kind", "counted", "before", "after", "times smaller"], rows, note)
