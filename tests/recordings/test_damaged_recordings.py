"""Recordings of every form with bytes changed, cut off or repeated: read, or refused in one sentence, no traceback.

python -m pytest -m slow tests/recordings/test_damaged_recordings.py      # 60 changes a form
python -m tests.recordings.test_damaged_recordings FORM SEED COUNT        # more of them; findings are printed
"""

import json
import random
import shutil
import sys
import tempfile
from collections import Counter
from pathlib import Path

import pytest

import cdpr_struct as cs
from tests.fuzz.judging import judged
from tests.fuzz.mutating import changed
from tests.recordings.written import FORMS

FEW, MANY = 1, 60
_LARGE = (b"\xff\xff\xff\xff", b"\0\0\0\0", b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", b"nan", b",,", b"\r\n", b"1e999")


def damaged(data: bytes, rng: random.Random) -> bytes:
    """The file with one to four changes."""
    for _ in range(rng.choice((1, 1, 2, 4))):
        place, length = rng.randrange(len(data)), rng.choice((1, 1, 4, 16, 200))
        if rng.random() < 0.5:  # heads and ends decide most
            place = (
                min(rng.randrange(600), len(data) - 1)
                if rng.random() < 0.7
                else max(0, len(data) - 1 - rng.randrange(300))
            )
        kind = rng.randrange(5)
        if kind == 0:
            data = data[:place] + bytes([data[place] ^ (1 << rng.randrange(8))]) + data[place + 1 :]
        elif kind == 1:
            word = rng.choice(_LARGE)
            data = data[:place] + word + data[place + len(word) :]
        elif kind == 2:
            data = data[:place] + data[place + length :]
        elif kind == 3:
            data = data[: place + length] + data[place : place + length] + data[place + length :]
        else:
            data = data[: max(place, 1)]
        data = data or b"\0"
    return data


def outcomes(form: str, seed: int, count: int, folder: Path) -> tuple[Counter[str], list[str]]:
    """What came of so many damaged files, and why where it is a finding."""
    rng, counts, findings = random.Random(f"{form} {seed}"), Counter[str](), []
    whole, mapping = FORMS[form](folder)
    parts = [path for path in whole.rglob("*") if path.is_file()] if whole.is_dir() else [whole]
    kept = {path: path.read_bytes() for path in parts}

    def read(data: bytes) -> None:
        target.write_bytes(data)
        cs.recording_channels(whole)
        cs.import_recording(whole, mapping)

    for _ in range(count):
        target = rng.choice(parts)
        outcome, why = judged(read, damaged(kept[target], rng))
        target.write_bytes(kept[target])
        counts[outcome] += 1
        findings += [why] if why else []
    return counts, findings


@pytest.mark.parametrize("form", FORMS)
def test_a_few_damaged_files(form, tmp_path, capsys):
    counts, findings = outcomes(form, 1, FEW, tmp_path)
    assert findings == []
    assert sum(counts.values()) == FEW
    captured = capsys.readouterr()
    assert captured.out + captured.err == ""


def changed_mappings(count: int, seed: int, folder: Path) -> tuple[Counter[str], list[str]]:
    """What came of so many mapping files with words exchanged, and why where it is a finding."""
    whole, mapping = FORMS["decimal_commas"](folder)
    listed = cs.recording_channels(whole).template.replace('robot = "?"', 'robot = "cogiro"').replace("# ", "")
    seeds = [text.encode() for text in (listed, _toml(mapping), _toml(mapping).replace("motion", "still"))]
    rng, counts, findings = random.Random(f"mapping {seed}"), Counter[str](), []

    def read(data: bytes) -> None:
        (folder / "map.toml").write_bytes(data)
        cs.import_recording(whole, folder / "map.toml")

    for _ in range(count):
        outcome, why = judged(read, changed(rng.choice(seeds), rng))
        counts[outcome] += 1
        findings += [why] if why else []
    return counts, findings


def _toml(mapping: dict) -> str:
    """A mapping as text, with every key that it may have."""
    more = {
        "position": 'factor = [1.0, 1.0, 1.0]\ndelay_s = 0.01\n', "rotation": "inverse = false\n",
        "lengths": "offset = 0.001\n", "time": 'unit = "ms"\n',
        "sampling": 'span = [1.0, 9.0]\nrate_hz = 5.0\nevery = 2\nlargest_gap_s = 0.5\nfaulty = "leave_out"\n',
    }  # fmt: skip
    tables = [f'robot = "{mapping["robot"]}"']
    for name, table in mapping.items():
        if isinstance(table, dict):
            tables += [
                f"[{name}]",
                *(f"{key} = {json.dumps(value)}" for key, value in table.items()),
                more.get(name, ""),
            ]
    return "\n".join(tables)


@pytest.mark.parametrize("count", [40, pytest.param(1000, marks=pytest.mark.slow)])
def test_changed_mappings(count, tmp_path):
    counts, findings = changed_mappings(count, 1, tmp_path)
    assert findings == []
    assert counts["loaded"] > 0
    assert counts["refused"] > 0


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
def test_many_damaged_files(form, tmp_path, capsys):
    counts, findings = outcomes(form, 2, MANY, tmp_path)
    assert findings == []
    assert counts["refused"] > 0
    captured = capsys.readouterr()
    assert captured.out + captured.err == ""


def main() -> None:
    """Damage many files of a form, or of all."""
    forms = list(FORMS) if sys.argv[1] == "all" else [sys.argv[1]]
    for form in forms:
        folder = Path(tempfile.mkdtemp())
        counts, findings = outcomes(form, int(sys.argv[2]), int(sys.argv[3]), folder)
        shutil.rmtree(folder)
        print(form, dict(counts), flush=True)
        for why in sorted({one.partition("\n")[0]: one for one in findings}.values()):
            print("   ", why, flush=True)


if __name__ == "__main__":
    main()
