"""Prints all formulas as one compilable LaTeX article: print, derivation, status, note."""

from __future__ import annotations

from itertools import groupby

from cdpr_struct.derivations.records import FormulaRecord

_PREAMBLE = r"""% GENERATED FILE - do not edit. Regenerate: python -m cdpr_struct.derivations
\documentclass[a4paper,10pt]{article}
\usepackage[margin=20mm]{geometry}
\usepackage{amsmath}
\usepackage{adjustbox}
\setcounter{MaxMatrixCols}{12}
\newcommand{\formula}[1]{\par\smallskip\noindent
  \begin{adjustbox}{max width=\linewidth}$\displaystyle #1$\end{adjustbox}\par\smallskip}
\title{Formula sheet: what the thesis prints, and what the derivations arrive at}
\date{}
\begin{document}
\maketitle
\noindent Static axes: $z$ up, cable from the fixed end $B$ (origin) to the moving end $C$.
Dynamic axes: $x$ along the chord from $B$ to $C$, $z$ across it and up.
$H = |f_{Cx}| > 0$, $V$ is the vertical force,
$y = \Omega_c/2$.
\emph{verified}: the derivation reproduces the print. \emph{corrected}: it does not, and the note says why.

"""

_ESCAPES = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"$<$",
    ">": r"$>$",
}


def escaped(text: str) -> str:
    """Plain text as LaTeX text."""
    return "".join(_ESCAPES.get(character, character) for character in text)


def _summary(formulas: tuple[FormulaRecord, ...]) -> str:
    rows = [f"{escaped(r.id)} & {escaped(r.thesis_equation)} & {r.status} \\\\" for r in formulas]
    head = r"\section*{Summary}" + "\n" + r"\begin{center}\small\begin{tabular}{lll}" + "\n"
    return head + "formula & equation & status \\\\ \\hline\n" + "\n".join(rows) + "\n\\end{tabular}\\end{center}\n"


def _entry(record: FormulaRecord) -> str:
    equation = f"eq.~({escaped(record.thesis_equation)})"
    lines = [
        rf"\subsection*{{{escaped(record.id)} \hfill {equation}, {record.status}}}",
        rf"\noindent printed:\formula{{{record.printed_latex}}}",
        rf"\noindent derived:\formula{{{record.derived_latex}}}",
    ]
    if record.note:
        lines.append(rf"\noindent\textit{{{escaped(record.note)}}}")
    return "\n".join(lines) + "\n"


def formula_sheet(formulas: tuple[FormulaRecord, ...]) -> str:
    """The whole document."""
    parts = [_PREAMBLE, _summary(formulas)]
    for sheet, records in groupby(formulas, key=lambda record: record.id.split(".")[0]):
        parts.append(rf"\section*{{{escaped(sheet)}}}" + "\n")
        parts += [_entry(record) for record in records]
    return "\n".join(parts) + "\n\\end{document}\n"
