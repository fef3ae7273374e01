"""docs/published_cases.md: every published case beside what the model and the referee say of it."""

from pathlib import Path

from tests.published import hanging_cables, pendulums, strings_and_chains
from tests.published.case import Case

PAGE = Path(__file__).parents[2] / "docs" / "published_cases.md"
CASES: tuple[Case, ...] = (*hanging_cables.CASES, *strings_and_chains.CASES, *pendulums.CASES)

_HEAD = """# Published cases

Numbers that others have printed, computed by the model (`cdpr_struct.statics`, `cdpr_struct.dynamics`) and by the
independent finite elements (`cdpr_struct.fem_reference`, extrapolated to infinitely many bars). Each row is a test
(`pytest tests/published`); it fails where model or finite elements lie further from the print than "accepted" says.
`python -m tests.published` writes this page. More rows: [the thesis](thesis.md), [blind tests](blind_tests.md),
[benchmarks](benchmarks.md).

| case | source | quantity | unit | printed | model | finite elements | model off by | accepted | because |
|---|---|---|---|---|---|---|---|---|---|
"""
_FOOT = """
Data behind the rows:

- Jayaraman and Knudson, Computers and Structures 14 (1981): span 304.8 m, EA = 131.0 kN/mm2 x 548.4 mm2, 46.12 N/m,
  35.586 kN at a node that hangs at (121.92, -29.276) m under the cable's own weight. The two unstrained lengths follow
  from that place; the rounded lengths in circulation (125.88 m and 186.85 m) move the answer by 5 mm.
- Code_Aster V6.02.114: 325 m, 227.83 mm2, 57 GPa, 2844.23 kg/m3, 2.3e-5 per kelvin. V5.02.138: 1 m, 50.26 mm2,
  210 GPa, 7800 kg/m3, tensions of 6171.05 and 12345.30 N.
- ANSYS Mechanical APDL Verification Manual, VM53: 500 lb, 100 in, 0.00306796 in2, 0.00073 lb s2/in4.
- Irvine and Caughey, Proceedings of the Royal Society A 341 (1974): parabolas. Ours are catenaries with w L / T = 0.01.
- MoorPy's own tests of its catenary function; rows without contact with the sea bed. The slack line is buoyant there,
  and mirrored here.
- Pendulums: twist m g R^2 / (I L), swing g / L, and the double pendulum of a body on two parallel links.
"""


def row(case: Case) -> str:
    """One line of the table."""
    model, referee = case.model(), case.referee()
    deviation = model / case.published - 1.0
    told = "below 1e-6" if abs(deviation) < 1e-6 else f"{deviation:+.0e}"
    numbers = f"{case.published:.8g} | {model:.6g} | {referee:.6g} | {told} | {case.accepted:.0e}"
    return f"| {case.title} | {case.source} | {case.quantity} | {case.unit} | {numbers} | {case.because} |"


def page() -> str:
    """The whole page."""
    return _HEAD + "\n".join(row(case) for case in CASES) + "\n" + _FOOT
