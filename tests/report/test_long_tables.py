"""A long table is the same text as a short one, in parts, and is written whole or not at all."""

import hashlib

import numpy as np
import pytest

from cdpr_struct.cli.written_files import replace_files
from cdpr_struct.reports.csv_table import LongTable, csv_text

COLUMNS = {
    "x_m": np.linspace(0.0, 1.0, 10_001),
    "value": np.where(np.arange(10_001) % 7, 0.1, np.nan),
    "held": [1] * 10_001,
}


def test_a_long_table_in_parts_is_the_text_in_one():
    table = LongTable(COLUMNS)
    parts = list(table)
    assert len(parts) == 4  # heading, 4096 rows, 4096 rows, the rest
    assert b"".join(parts) == csv_text(COLUMNS).encode("utf-8")
    assert list(table) == parts  # as often as it is asked for


def test_columns_of_different_lengths_are_refused():
    with pytest.raises(ValueError, match="shorter"):
        list(LongTable({**COLUMNS, "held": [1]}))


def test_a_long_file_is_written_with_its_digest(tmp_path):
    replace_files(tmp_path, {}, {"map.csv": LongTable(COLUMNS)}, overwrite=False)
    written = (tmp_path / "map.csv").read_bytes()
    assert written == csv_text(COLUMNS).encode("utf-8")
    assert hashlib.sha256(written).hexdigest() in (tmp_path / "result.json").read_text("utf-8")


def test_a_file_that_fails_half_way_leaves_nothing(tmp_path):
    with pytest.raises(ValueError, match="shorter"):
        replace_files(tmp_path, {}, {"map.csv": LongTable({**COLUMNS, "held": [1]})}, overwrite=False)
    assert not list(tmp_path.iterdir())
