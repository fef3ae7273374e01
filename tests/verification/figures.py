"""Figures of the verification page, read from the pages on which they were measured."""

import re
from pathlib import Path

from tests.verification.row import Figure

DOCS = Path(__file__).parents[2] / "docs"


def table(page: str, *heading: str) -> list[list[str]]:
    """Cells of the table on a page whose first columns have these headings."""
    lines = (DOCS / page).read_text("utf-8").splitlines()
    start = next((i for i, line in enumerate(lines) if tuple(_cells(line)[: len(heading)]) == heading), None)
    if start is None:
        raise LookupError(f"docs/{page} has no table with the columns {heading}")
    found = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        found.append(_cells(line))
    return found


def sentence(page: str, pattern: str) -> tuple[str, ...]:
    """Groups of a pattern in the text of a page, line breaks taken as spaces."""
    text = " ".join((DOCS / page).read_text("utf-8").split())
    found = re.search(pattern, text)
    if found is None:
        raise LookupError(f"docs/{page} does not say {pattern!r}")
    return found.groups()


def number(text: str) -> float:
    """The first number in a cell; per cent as a share."""
    found = re.search(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?", text)
    if found is None:
        raise LookupError(f"no number in {text!r}")
    return float(found[0]) * (0.01 if "%" in text else 1.0)


def exact_beside_fem() -> Figure:
    """Robots of the table of verified robots."""
    rows = table("benchmarks.md", "robot", "force bound [N]")
    largest, holding = max(number(row[3]) for row in rows), sum(row[2] == "HOLDS" for row in rows)
    return Figure(
        f"{holding} of {len(rows)} robots, largest deviation {largest:.1e}",
        holding == len(rows) >= 20 and largest < 1e-5,
    )


def closed_form_beside_fem() -> Figure:
    """Closed form: robots that hold, and those whose cause is named."""
    rows = table("benchmarks.md", "robot", "force bound [N]")
    failing = [row for row in rows if row[6] != "HOLDS"]
    named = sum(row[8] != "-" for row in failing)
    return Figure(
        f"{len(rows) - len(failing)} of {len(rows)} robots hold; of {len(failing)} that do not, {named} have a cause",
        named == len(failing),
    )


def printed_limits() -> Figure:
    """Errors of the closed form for cables within the printed limits."""
    rows = {row[0]: row[1] for row in table("limits.md", "quantity", "largest error")}
    alone, loaded = rows["frequencies in plane"], rows["frequencies with a mass at the end"]
    return Figure(f"{alone} alone, {loaded} with a mass at the end", max(number(alone), number(loaded)) < 0.01)


def own_limits() -> Figure:
    """Random cables that keep the four numbers of docs/limits.md."""
    drawn, off = sentence(
        "limits.md", r"Of (\d+) random cables that keep these.*? (none|\d+) has a frequency that is off by 1 %"
    )
    return Figure(f"{off} of {drawn} cables off by more than 1 %", off == "none")


def published_cases() -> Figure:
    """Largest deviation over what is accepted, of model from print."""
    rows = table("published_cases.md", "case", "source")
    shares = [0.0 if "below" in row[7] else abs(number(row[7])) / number(row[8]) for row in rows]
    sources = len({row[1] for row in rows})
    return Figure(
        f"{len(rows)} numbers of {sources} sources, largest deviation {max(shares):.0%} of what is accepted",
        max(shares) <= 1.0,
    )


def random_robots() -> Figure:
    """The last line of the table of random robots, and what was explained since."""
    last = table("benchmarks.md", "robots", "seeds")[-1]
    count, worst, violations = last[1], last[8], last[9]
    return Figure(f"{count} robots, worst balance {worst}, {violations} violations", int(violations) == 0)


def band_coverage() -> Figure:
    """Counts inside the bands, each beside what chance allows in the last row."""
    *rows, allowed = table("benchmarks.md", "chosen", "in 50 %")
    spans = [tuple(map(int, cell.split(" to "))) for cell in allowed[1:4]]
    inside = [least <= int(n) <= most for row in rows for n, (least, most) in zip(row[1:4], spans, strict=True)]
    uniform = [number(row[4]) >= number(allowed[4]) for row in rows]
    (robots,) = sentence("benchmarks.md", r"(\d+) robots with bands that the program does not doubt")
    counts = "; ".join(f"{row[0]} {', '.join(row[1:4])}" for row in rows)
    return Figure(f"of {robots}: {counts}; p {min(row[4] for row in rows)} or more", all(inside + uniform))


def after_unknown() -> Figure:
    """Percentages inside 50, 90 and 99 % bands, none below nominal by more than five."""
    rows = [row for row in table("benchmarks.md", "effect outside the library") if row[0].endswith(", unknown")]
    shares = [[tuple(map(int, cell.split(" / "))) for cell in row[2:5]] for row in rows]
    met = all(
        own >= nominal - 5 for row in shares for cell in row for own, nominal in zip(cell, (50, 90, 99), strict=True)
    )
    return Figure("; ".join(f"{row[0].split(',')[0]} {', '.join(row[2:5])} %" for row in rows), met)


def virtual_sensors() -> Figure:
    """Shares of true tensions in 90 % bands, each beside the standard error of its mean over robots."""
    rows = table("virtual_sensors.md", "robot", "read", "one sigma")
    shares = [tuple(float(part) for part in row[4].split(" ± ")) for row in rows]
    told = ", ".join(f"{row[4]} %" for row in rows)
    return Figure(told, all(abs(share - 90.0) <= 2.0 * error for share, error in shares))


def one_cable() -> Figure:
    """Smallest error of twenty frequencies of a cable."""
    row = table("benchmarks.md", "code", "20 frequencies within 1e-03")[0]
    return Figure(f"{row[4]}", number(row[4]) < 1e-10)


def geometric_term() -> Figure:
    """Distance of the consistent assembly from the FEM."""
    rows = {row[0]: row[1] for row in table("benchmarks.md", "code and joint", "from the converged FEM")}
    ours = next(value for name, value in rows.items() if "`consistent`" in name)
    without = next(value for name, value in rows.items() if "`thesis`" in name)
    return Figure(f"{ours} with the term, {without} without", number(ours) < 1e-6)


def blind(figure: str) -> Figure:
    """A figure of the blind tests, with its band and what was to be reached."""
    row = next(row for row in table("blind_tests.md", "figure", "reached") if row[0] == figure)
    bound = number(row[4])
    met = number(row[1]) <= bound if "<" in row[4] else number(row[1]) >= bound
    return Figure(f"{row[1]} ({row[2]}) of {row[3]} cases", met)


def recordings() -> Figure:
    """Frequencies of recorded free motions beside the model."""
    found, of, off, most = sentence(
        "signal_records.md",
        r"(\d+) of (\d+) modes are identified\. The deviation from the model is ([\d.]+) % in the median of its size,"
        r".*? ([\d.]+) % at most",
    )
    return Figure(f"{found} of {of} modes, {off} % in the median, {most} % at most", float(off) < 1.0)


def mutation() -> Figure:
    """Scores of the latest sample of mutants: of all rooms, and of the weakest."""
    scores = {row[0]: row[5] for row in table("mutation_testing.md", "room", "mutants")}
    weakest = min(scores, key=lambda room: number(scores[room]))
    return Figure(f"{scores['all']}; weakest: {weakest}, {scores[weakest]}", number(scores["all"]) >= 0.9)


def recorded_motion() -> Figure:
    """Errors of lengths that were not fitted, after over before, of the best and the worst cable."""
    rows = table("recorded_motion.md", "cable", "robot as entered")
    shares = [float(row[3]) / float(row[1]) for row in rows]
    return Figure(f"{min(shares):.2f} to {max(shares):.2f}", max(shares) <= 1.0 / 3.0)


def delays() -> Figure:
    """Share of cases in which the delay was named alone, and in which both were named beside another effect."""
    rows = {row[0]: row for row in table("blind_delays.md", "figure", "reached")}
    alone, both = rows["delay or drift alone, named"], rows["both named, with a second effect"]
    shown = "; ".join(f"{row[1]} of {row[3]} cases" for row in (alone, both))
    return Figure(shown, number(alone[1]) >= 0.95 and number(both[1]) >= 0.85)


def pythons() -> Figure:
    """Versions of Python on which tests were run."""
    rows = table("install.md", "Python", "packages")
    failed = sum(int(row[4]) for row in rows if row[1].startswith("newest"))
    told = ", ".join(f"{row[0]} ({row[3]} pass)" for row in rows if row[1].startswith("newest"))
    return Figure(f"{told}, {failed} fail", failed == 0 and all(int(row[3]) for row in rows))


def lowest() -> Figure:
    """Tests with the lowest versions."""
    row = next(row for row in table("install.md", "Python", "packages") if row[1].startswith("lowest"))
    return Figure(f"{row[3]} tests pass, {row[4]} fail", int(row[3]) > 0 and int(row[4]) == 0)


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def fuzzed_files() -> Figure:
    """Executions of the fuzzer since the last correction of each reader, and failures among them."""
    rows = table("robustness.md", "target", "executions")
    since = [re.match(r"(\d+), \d+, (\d+)$", row[4]) for row in rows]
    fails = sum(int(found[2]) for found in since if found)
    runs = sum(int(found[1]) for found in since if found)
    text = f"{runs} inputs since the last correction, {fails} failures"
    untried = [row[0].split()[0] for row, found in zip(rows, since, strict=True) if not found]
    return Figure(
        text + (f"; none run since then: {', '.join(untried)}" if untried else ""), fails == 0 and not untried
    )


def surroundings() -> Figure:
    """Attacks on the surroundings: those that hold, or hold since a correction."""
    rows = table("robustness.md", "attack", "tried")
    good = sum(row[3].startswith(("holds", "corrected")) for row in rows)
    corrected = sum(row[3].startswith("corrected") for row in rows)
    return Figure(f"{good} of {len(rows)} kinds hold, {corrected} of them since a correction", good == len(rows))
