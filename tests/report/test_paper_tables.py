"""CSV tables as Markdown and LaTeX: units in headings, digits that can be read, nothing lost."""

import json

import pandas as pd
import pytest

from cdpr_struct.cli import command
from cdpr_struct.cli.main import run
from cdpr_struct.reports.csv_table import LongTable, csv_text
from cdpr_struct.reports.paper_table import LONGEST, heading, paper_table, paper_tables

COLUMNS = {
    "mode": [1, 2, 3],
    "frequency_hz": [2.48312345678, 10.5, 0.25],
    "residual": [1e-12, -3.25e-13, 0.0],
    "kind": ["platform", "cable 2", "50 % & more_"],
    "length_m": [1.0, float("nan"), 3.0],
}


@pytest.mark.parametrize(
    ("name", "md", "latex"),
    [
        ("frequency_hz", "frequency [Hz]", "frequency [Hz]"),
        ("x_m", "x [m]", "x [m]"),
        ("ax_m_s2", "ax [m/s²]", "ax [m/s$^2$]"),
        ("least_stiffness_N_m", "least stiffness [N/m]", "least stiffness [N/m]"),
        ("tension_3_N", "tension 3 [N]", "tension 3 [N]"),
        ("slack_cables", "slack cables", "slack cables"),
        ("m", "m", "m"),
    ],
)
def test_headings_have_units(name, md, latex):
    assert (heading(name, "md"), heading(name, "latex")) == (md, latex)


def test_markdown_has_the_digits_of_the_largest_number():
    lines = paper_table(csv_text(COLUMNS), "md").splitlines()
    assert lines[0] == "| mode | frequency [Hz] | residual | kind | length [m] |"
    assert lines[1] == "| ---: | ---: | ---: | --- | ---: |"
    assert lines[2] == "| 1 | 2.483 | 1.0000e-12 | platform | 1.0000 |"
    assert lines[3] == "| 2 | 10.500 | -3.2500e-13 | cable 2 |  |"
    assert len(lines) == 5


def test_latex_escapes_words_and_sets_powers():
    text = paper_table(csv_text(COLUMNS), "latex")
    assert "\\begin{tabular}{rrrlr}" in text
    assert "\\toprule" in text
    assert "50 \\% \\& more\\_" in text
    assert "$-3.2500 \\cdot 10^{-13}$" in text
    assert text.count("\\\\") == 4


def test_long_tables_end_with_a_count():
    columns = {"x_m": [0.5 * i for i in range(LONGEST + 7)]}
    for content in (csv_text(columns), csv_text(columns).encode(), LongTable(columns)):
        lines = paper_table(content, "md", "map.csv").splitlines()
        assert len(lines) == 2 + LONGEST + 2
        assert lines[-1] == "7 more rows: map.csv"


def test_every_table_of_a_result_is_there_once_more(tmp_path):
    words = [
        "cable",
        "--force",
        "100,-100",
        "--length",
        "20",
        "--EA",
        "251327",
        "--rho",
        "0.067",
        "--out",
        str(tmp_path),
    ]
    assert run([*words, "--quiet", "--tables", "latex"]) == 0
    tables = {path.stem for path in tmp_path.glob("*.csv")}
    assert tables == {path.stem for path in tmp_path.glob("*.tex")} != set()
    rows = len(pd.read_csv(tmp_path / "profile.csv"))
    assert (tmp_path / "profile.tex").read_text().count(" \\\\\n") == rows + 1


def test_an_unknown_form_is_refused(capsys):
    assert run(["robots", "--tables", "xls"]) == 2
    assert "--tables: got 'xls'; one of: md, latex, parquet" in capsys.readouterr().err


def test_names_follow_the_csv_files():
    assert set(paper_tables({"a.csv": "x\n1\n", "b.svg": ""}, "latex")) == {"a.tex"}
    assert set(paper_tables({"a.csv": "x\n1\n", "b.svg": ""}, "md")) == {"a.md"}


def test_parquet_has_the_numbers_of_the_csv_file(tmp_path):
    pytest.importorskip("pyarrow", reason="the extra parquet is not installed")
    words = ["modes", "thesis-3-1", "--count", "6", "--out", str(tmp_path), "--quiet", "--tables", "parquet"]
    assert run(words) == 0
    for path in tmp_path.glob("*.csv"):
        pd.testing.assert_frame_equal(pd.read_parquet(path.with_suffix(".parquet")), pd.read_csv(path))
    assert len(list(tmp_path.glob("*.parquet"))) == len(list(tmp_path.glob("*.csv"))) > 1
    told = json.loads((tmp_path / "result.json").read_text())["frequencies_hz"]
    assert pd.read_parquet(tmp_path / "modes.parquet")["frequency_hz"].tolist() == pytest.approx(told, rel=1e-15)


def test_parquet_without_its_package_is_one_sentence(capsys, monkeypatch):
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    assert run(["robots", "--tables", "parquet"]) == 2
    assert "cdpr-struct[parquet]" in capsys.readouterr().err
