"""Workbooks and text tables of other programs: what they are, and the command that converts them, ready to run."""

import io
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_rows import read_rows
from tests.robustness.test_campaign_files import CAMPAIGN, HEAD, ROWS

COMMAND = re.compile(r'python -c ".*?index=False\)"')


def workbook(*sheets: str) -> bytes:
    """An .xlsx file of empty sheets, as the standard has it."""
    spaces = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    relations = 'xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"'
    listed = "".join(f'<sheet name="{name}" sheetId="{i}" r:id="rId{i}"/>' for i, name in enumerate(sheets, 1))
    members = {
        "[Content_Types].xml": '<?xml version="1.0"?><Types/>',
        "xl/workbook.xml": f'<?xml version="1.0"?><workbook {spaces} {relations}><sheets>{listed}</sheets></workbook>',
        **{f"xl/worksheets/sheet{i}.xml": "<worksheet/>" for i in range(1, len(sheets) + 1)},
    }
    return archive(members)


def archive(members: dict[str, str]) -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as file:
        for name, text in members.items():
            file.writestr(name, text)
    return held.getvalue()


def refusal(path: Path, content: bytes) -> str:
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        read_rows("static_state", path, 8)
    assert "\n" not in str(error.value)
    return str(error.value)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("states.xlsx", workbook("Poses"), ["an Excel workbook'", "pip install openpyxl", "read_excel('states.xlsx')"]),
        ("states.xlsx", workbook("Poses", "A &amp; B"),
         ["with the sheets Poses, A & B", "read_excel('states.xlsx', sheet_name='Poses').to_csv('states.csv', index="]),
        ("states.xlsx", b"", ["an Excel workbook", "pip install openpyxl"]),
        ("states.csv", workbook("Poses"), ["read_excel('states.csv').to_csv('states-converted.csv', index=False)"]),
        ("states.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(512), ["an Excel workbook", "pip install xlrd"]),
        ("states.csv", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(512), ["an Excel workbook", "pip install xlrd"]),
        ("states.ods", archive({"content.xml": '<table:table table:name="A"/><table:table table:name="B b"/>'}),
         ["an OpenDocument spreadsheet with the sheets A, B b", "pip install odfpy", "sheet_name='A'"]),
        ("states.mat", b"MATLAB 5.0 MAT-file" + bytes(200), ["a MATLAB file", "CSV", "writetable(T, 'states.csv')"]),
        ("states.mat", b"\x89HDF\r\n\x1a\n" + bytes(200), ["a MATLAB file", "CSV", "writetable"]),
        ("states.npz", archive({"x.npy": "", "y.npy": ""}), ["a numpy file", "CSV", "to_csv('states.csv', index="]),
        ("states.zip", archive({"states.csv": HEAD}), ["a zip archive", "unpack"]),
        ("states.csv", b"PK\x03\x04rubbish", ["states.csv"]),
    ],
    ids=range(12),
)  # fmt: skip
def test_files_of_other_programs(name, content, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    line = refusal(Path(name), content)
    assert all(word in line for word in words), line


def test_a_file_that_is_there_is_not_written_over(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("states.csv").write_text("mine")
    assert "to_csv('states-converted.csv'" in refusal(Path("states.xlsx"), workbook("Poses"))


def test_the_program_says_it_in_one_line(tmp_path, capsys):
    (tmp_path / "states.xlsx").write_bytes(workbook("Poses", "Log"))
    (tmp_path / "campaign.toml").write_text(CAMPAIGN.replace("states.csv", "states.xlsx"))
    assert run(["diagnose", str(tmp_path / "campaign.toml")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert f"read_excel('{(tmp_path / 'states.xlsx').as_posix()}', sheet_name='Poses')" in line


def test_a_motion_in_a_workbook(tmp_path, capsys):
    (tmp_path / "path.xlsx").write_bytes(workbook("Motion"))
    for command in (["distribute", "thesis-5"], ["transient", "thesis-3-1"], ["audit", "thesis-3-1"]):
        assert run([*command, "--trajectory", str(tmp_path / "path.xlsx")]) == 2
        assert "pandas.read_excel(" in capsys.readouterr().err


TEXT = HEAD.replace("x_m", "length_m,x_m") + ROWS.replace("a,0,0", "a,9.25,0.5,0")


@pytest.mark.parametrize(
    ("form", "words"),
    [
        (lambda t: t.replace(",", ";").replace(".", ",").encode(), ["separated by ';'", "sep=';', decimal=','"]),
        (lambda t: t.replace(",", ";").encode(), ["separated by ';'", "sep=';')"]),
        (lambda t: ("sep=;\n" + t.replace(",", ";").replace(".", ",")).encode("utf-8-sig"), ["skiprows=1"]),
        (lambda t: ("# one\n" + t.replace(",", "\t")).encode(), ["separated by tabs", "sep='\\t', comment='#'"]),
        (lambda t: t.replace(",", " ").encode(), ["separated by spaces", "sep=' '"]),
        (lambda t: t.replace("a,", "é,").encode("latin-1"), ["byte 0xe9", "UTF-8", "encoding='cp1252'"]),
        (lambda t: t.replace("a,", "é,").replace(",", ";").replace(".", ",").encode("latin-1"),
         ["UTF-8", "sep=';', decimal=',', encoding='cp1252'"]),
        (lambda t: t.replace(",", "\t").encode("utf-16"), ["UTF-16", "sep='\\t', encoding='utf-16'"]),
    ],
    ids=["semicolons", "points", "sep line", "tabs", "spaces", "latin-1", "German Excel", "Unicode text"],
)  # fmt: skip
@pytest.mark.parametrize("name", ["states.csv", "it's $HOME `a`.txt"])
def test_the_command_for_a_text_table_runs_and_keeps_the_numbers(form, words, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    line = refusal(Path(name), form(TEXT))
    assert all(word in line for word in words), line
    command = COMMAND.search(line)[0].replace("python", sys.executable, 1)
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (made,) = (path for path in tmp_path.iterdir() if path.name != name)
    assert line.endswith(f"and give {made.name}")
    Path("plain.csv").write_text(TEXT)
    found, wanted = read_rows("static_state", made, 8), read_rows("static_state", Path("plain.csv"), 8)
    assert found.numbers.keys() == wanted.numbers.keys()
    assert all(np.array_equal(found.numbers[c], wanted.numbers[c]) for c in wanted.numbers)


def test_a_text_file_called_xls_is_read_as_text(tmp_path):
    """Instruments write them."""
    (tmp_path / "states.xls").write_text(TEXT)
    assert len(read_rows("static_state", tmp_path / "states.xls", 8)) == 8
