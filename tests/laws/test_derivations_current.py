"""The committed generated text is what the derivations print, its numbers are theirs, and every verdict is complete."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from cdpr_struct import derivations
from cdpr_struct.derivations import regenerate
from cdpr_struct.derivations.__main__ import main
from cdpr_struct.derivations.records import FormulaRecord

ROOT = Path(__file__).resolve().parents[2]
CORRECTED = {
    "cable_compliance.stiffness",
    "cable_dsm.k_xz",
    "cable_dsm.limit_steep",
    "cable_dsm.omega_c",
    "cable_dsm.global_rotation",
    "platform.assembly",
    "platform.attachment",
    "platform.frame_change",
    "platform.restoring_force",
    "tension_bound.fundamental_frequency",
    "tension_bound.fundamental_frequency_2",
    "tension_bound.frequency_of_force",
    "tension_bound.lower_bound",
    "tension_bound.fixed_lower_bound",
}


@pytest.fixture(scope="module")
def rendering() -> regenerate.Rendering:
    """All derivations, run once (about 20 s)."""
    return regenerate.render()


@pytest.fixture
def copy(rendering: regenerate.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A fresh tree of everything that is printed; run() then uses the rendering at hand."""
    regenerate.write(rendering.texts, tmp_path)
    monkeypatch.setattr(regenerate, "render", lambda progress: rendering)
    return tmp_path


def _damage(root: Path, name: str, old: str, new: str) -> None:
    path = root / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_committed_text_is_current(rendering: regenerate.Rendering) -> None:
    diff = regenerate.drift(rendering.texts, ROOT)
    assert not diff, f"{diff}\nrun: python -m cdpr_struct.derivations, and review the diff"


def test_which_sympy_printed_a_file_does_not_matter_and_a_cost_does() -> None:
    text = '"""GENERATED FILE\n\nMade with  : sympy 1.14.0; 76 operations after cse\n"""\n'
    assert regenerate.same(text, text.replace("1.14.0", "1.13.0"))
    assert regenerate.same(
        text.replace("; 76 operations after cse", ""), text.replace("1.14.0; 76 operations after cse", "1.15")
    )
    assert not regenerate.same(text, text.replace("76", "77"))


def test_generated_folder_holds_nothing_else(rendering: regenerate.Rendering) -> None:
    present = {path.name for path in (ROOT / regenerate.GENERATED).glob("*.py")} - {"__init__.py"}
    assert present == {Path(name).name for name in rendering.texts if name.startswith(regenerate.GENERATED)}


def test_check_passes_on_a_fresh_tree(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = derivations.run(check=True, output=copy)
    assert report.current, report.diff + "\n".join(report.value_errors)
    assert main(["--check", "--output", str(copy)]) == 0
    assert "stale" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("catenary.py", "np.sqrt(", "1.0000001*np.sqrt("),
        ("cable_compliance.py", "/(", "*(1 - 1e-9)/("),
        ("cable_dsm.py", "1/(", "-1/("),
        ("platform.py", "np.cos(ry)", "np.cos(ry + 1e-9)"),
        ("tension_bound.py", "np.pi**2", "np.pi**2/1.001"),
        ("catenary.py", "def sag(", "def slack("),
    ],
)
def test_damaged_module_is_found_in_text_and_in_value(copy: Path, name: str, old: str, new: str) -> None:
    """The twin: a wrong model must not pass."""
    _damage(copy, f"{regenerate.GENERATED}/{name}", old, new)
    report = derivations.run(check=True, output=copy)
    assert f"+++ fresh/{regenerate.GENERATED}/{name}" in report.diff
    assert any(error.startswith(name.removesuffix(".py")) for error in report.value_errors)
    assert main(["--check", "--output", str(copy)]) == 1


def test_drift_in_latex_alone_is_found(copy: Path) -> None:
    _damage(copy, regenerate.FORMULA_SHEET, "verified", "trusted")
    report = derivations.run(check=True, output=copy)
    assert report.diff
    assert not report.value_errors
    assert not report.current


def test_writing_repairs_a_damaged_tree(copy: Path) -> None:
    name = f"{regenerate.GENERATED}/tension_bound.py"
    _damage(copy, name, "np.pi", "3.14")
    assert derivations.run(check=False, output=copy).written == (name,)
    assert derivations.run(check=True, output=copy).current


def test_every_formula_has_a_status_and_every_correction_a_reason(rendering: regenerate.Rendering) -> None:
    records = rendering.formulas
    assert len({record.id for record in records}) == len(records) == 40
    assert {record.status for record in records} == {"verified", "corrected"}
    assert {record.id for record in records if record.status == "corrected"} == CORRECTED
    for record in records:
        assert record.printed_latex, record.id
        assert record.derived_latex, record.id
        assert record.status == "verified" or len(record.note) > 40, record.id
        if record.status == "corrected":
            assert record.printed_latex != record.derived_latex, record.id


def test_correction_without_reason_is_refused() -> None:
    with pytest.raises(ValueError, match="needs a note"):
        FormulaRecord("a.b", "1", "corrected", "", "x", "y")
    with pytest.raises(ValueError, match="status must be one of"):
        FormulaRecord("a.b", "1", "assumed", "", "x", "y")


def test_formula_sheet_is_a_balanced_document(rendering: regenerate.Rendering) -> None:
    """No LaTeX is installed here: braces and environments are balanced, every formula appears."""
    text = rendering.texts[regenerate.FORMULA_SHEET]
    plain = text.replace(r"\{", "").replace(r"\}", "")
    assert plain.count("{") == plain.count("}")
    begins, ends = (re.findall(rf"\\{word}\{{(\w+)\}}", text) for word in ("begin", "end"))
    assert sorted(begins) == sorted(ends)
    assert text.count(r"\left") - text.count(r"\leftarrow") == text.count(r"\right")
    for record in rendering.formulas:
        assert record.id.replace("_", r"\_") in text


def test_import_stays_light() -> None:
    code = "import sys, cdpr_struct.derivations; sys.exit(any(m in sys.modules for m in ('sympy', 'numpy', 'mpmath')))"
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False).returncode == 0
