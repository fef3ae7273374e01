"""mkdocs hook: one page a sheet of derivations/latex/formula_sheet.tex, formulas as MathML.

The pages exist in the built site only; the LaTeX is what the derivations print, so nothing is copied by hand.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import latex2mathml.converter
from mkdocs.structure.files import File

SHEET = Path(__file__).resolve().parents[2] / "derivations" / "latex" / "formula_sheet.tex"
TITLES = {
    "catenary": "elastic catenary",
    "cable_compliance": "compliance of one cable",
    "cable_dsm": "dynamic stiffness of one cable",
    "platform": "platform",
    "tension_bound": "lower bound of the tension",
}
AXES = {
    "catenary": "Static axes: z up, the cable runs from its fixed end B (origin) to its moving end C. "
    "H = |f_Cx| > 0; V is the vertical force.",
    "cable_compliance": "Static axes: z up, the cable runs from its fixed end B (origin) to its moving end C. "
    "H = |f_Cx| > 0.",
    "cable_dsm": "Dynamic axes: x along the chord from the fixed end B to the moving end C, z across it and up.",
    "platform": "The force f of a cable on the platform acts at the arm a; c is the arm of the centre of mass.",
    "tension_bound": "b is the lowest admissible first angular frequency of a cable [rad/s].",
}
EXPLAINED = {
    "catenary": "statics.md",
    "cable_compliance": "statics.md",
    "cable_dsm": "limits.md",
    "platform": "dynamics.md",
    "tension_bound": "force_distribution.md",
}
_ENTRY = re.compile(
    r"\\subsection\*\{(?P<id>.+?) \\hfill eq\.~\((?P<equation>.+?)\), (?P<status>\w+)\}\n"
    r"\\noindent printed:\\formula\{(?P<printed>.+)\}\n"
    r"\\noindent derived:\\formula\{(?P<derived>.+)\}\n"
    r"(?:\\noindent\\textit\{(?P<note>.+)\}\n)?"
)
_PLAIN = (
    (r"\textbackslash{}", "\\"), (r"\textasciicircum{}", "^"), (r"\textasciitilde{}", "~"), ("$<$", "<"),
    ("$>$", ">"), (r"\_", "_"), (r"\&", "&"), (r"\%", "%"), (r"\#", "#"), (r"\{", "{"), (r"\}", "}"),
)  # fmt: skip
_IN_MARKDOWN = {character: f"\\{character}" for character in "\\`*_[]#"} | {"<": "&lt;", ">": "&gt;", "&": "&amp;"}


@dataclass(frozen=True, slots=True)
class Formula:
    """One formula of the sheet; `printed` and `derived` are LaTeX, the other texts are plain."""

    id: str
    equation: str
    status: str
    printed: str
    derived: str
    note: str


def plain(latex: str) -> str:
    """Escaped LaTeX text as plain text."""
    for escaped, character in _PLAIN:
        latex = latex.replace(escaped, character)
    return latex


def read_sheet(text: str) -> list[Formula]:
    """All formulas of the sheet, in its order.

    Raises
    ------
    ValueError : an entry does not have the form that `derivations.print_latex` writes.
    """
    found = [
        Formula(plain(m["id"]), plain(m["equation"]), m["status"], m["printed"], m["derived"], plain(m["note"] or ""))
        for m in _ENTRY.finditer(text)
    ]
    if not len(found) == text.count(r"\subsection*{") == text.count(r"\noindent printed:") > 0:
        raise ValueError(f"{SHEET.name}: {len(found)} of {text.count('subsection')} formulas could be read")
    return found


def mathml(latex: str) -> str:
    """A display formula in a box of its own."""
    converted = latex2mathml.converter.convert(latex, display="block")
    return f'<div class="formula">{converted}</div>'


def _text(plain_text: str) -> str:
    return "".join(_IN_MARKDOWN.get(character, character) for character in plain_text)


def _entry(formula: Formula) -> list[str]:
    name = formula.id.split(".")[1]
    lines = [f"## {name.replace('_', ' ')} {{ #{name} }}", ""]
    lines += [f"`{formula.id}`, eq. ({_text(formula.equation)}), **{formula.status}**", ""]
    if formula.printed == formula.derived:
        lines += ["Printed and derived:", "", mathml(formula.derived), ""]
    else:
        lines += ["Printed:", "", mathml(formula.printed), "", "Derived:", "", mathml(formula.derived), ""]
    return lines + ([f"Note: {_text(formula.note)}", ""] if formula.note else [])


def page(sheet: str, formulas: list[Formula]) -> str:
    """The page of one sheet as Markdown."""
    others = ", ".join(f"[{name}]({other}.md)" for other, name in TITLES.items() if other != sheet)
    lines = [
        f"# Formulas: {TITLES[sheet]}", "", _text(AXES[sheet]), "",
        "Equation numbers are those of the thesis. *verified*: the derivation reproduces the print. *corrected*: it "
        "does not, and the note says why. The program evaluates the derived forms, rewritten so that no digits are "
        "lost.", "",
        "Symbols: [glossary](../glossary.md). "
        f"Use: [explanation](../{EXPLAINED[sheet]}). What the corrections change: [findings](../thesis.md). "
        f"Other sheets: {others}. All on paper: [PDF](../building_the_docs.md).", "",
    ]  # fmt: skip
    return "\n".join([*lines, *(line for formula in formulas for line in _entry(formula))])


def on_files(files: Any, config: Any) -> Any:
    """Add a page for each sheet to the site."""
    formulas = read_sheet(SHEET.read_text("utf-8"))
    for sheet in dict.fromkeys(formula.id.split(".")[0] for formula in formulas):
        own = [formula for formula in formulas if formula.id.startswith(f"{sheet}.")]
        files.append(File.generated(config, f"formulas/{sheet}.md", content=page(sheet, own)))
    return files
