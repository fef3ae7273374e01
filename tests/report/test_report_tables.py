"""CSV tables read back as the numbers of the result; tables of the page keep to the digits that are known."""

import csv
import io

import numpy as np
import pytest

from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.verification_tables import uncertain


def read(text: str) -> dict[str, list[str]]:
    rows = list(csv.reader(io.StringIO(text)))
    return dict(zip(rows[0], (list(column) for column in zip(*rows[1:], strict=True)), strict=True))


def numbers(column: list[str]) -> np.ndarray:
    return np.array([float(field) if field else np.nan for field in column])


def test_eigenfrequencies_read_back(trial, files, same):
    table = read(files["eigenfrequencies.csv"])
    assert table["kind"] == list(trial.kinds)
    for column, values in (
        ("mode", np.arange(1, 21)),
        ("fem_hz", trial.fem_limit_hertz),
        ("fem_uncertainty_hz", trial.fem_uncertainty_hertz),
        ("dsm_hz", trial.dsm_hertz),
        ("relative_error", trial.relative_error),
        ("exact_hz", trial.exact_hertz),
        ("static_hz", trial.static_hertz),
        ("determinant_minimum_hz", trial.determinant_hertz),
        ("shape_share", trial.assurance),
        ("observed_order", trial.observed_order),
    ):
        assert same(numbers(table[column]), values), column


def test_convergence_reads_back(trial, files, same):
    table = read(files["convergence.csv"])
    assert same(numbers(table["fem_hz"]).reshape(-1, 20), trial.fem_hertz)
    assert same(numbers(table["relative_error"]).reshape(-1, 20), trial.mesh_error)
    assert same(np.unique(numbers(table["elements"])), trial.elements)


def test_cables_read_back(trial, files, same):
    table, cables, limits = read(files["cables.csv"]), trial.point.cables, trial.limits
    assert same(numbers(table["tension_at_platform_N"]), cables.tension_at_platform)
    assert same(numbers(table["length_m"]), cables.length)
    assert same(numbers(table["sag_m"]), cables.sag)
    assert same(numbers(table["lambda2"]), limits.lambda_squared)
    assert same(numbers(table["epsilon"]), limits.epsilon)
    assert same(numbers(table["inclination_deg"]), limits.inclination_deg)


def test_determinant_scan_reads_back(trial, files, same):
    table = read(files["determinant_scan.csv"])
    hertz = numbers(table["frequency_hz"])
    assert same(hertz, trial.scan.hertz)
    assert same(numbers(table["log10_det_dynamic_per_s12"]), trial.scan.log_dynamic)
    assert same(hertz[numbers(table["is_minimum"]) == 1.0], trial.scan.minima_hertz)


def test_cable_profile_runs_from_b_to_c(cable, cable_report):
    table = read(cable_report["profile.csv"])
    x, z, below = (numbers(table[name]) for name in ("x_m", "z_m", "below_chord_m"))
    assert [x[0], z[0]] == [0.0, 0.0]
    assert [x[-1], z[-1]] == pytest.approx([cable["x_m"], cable["z_m"]], rel=1e-12)
    assert below.max() == pytest.approx(cable["sag_m"], rel=1e-4)  # 201 points: a parabola's top is missed by less


def test_cable_trace_starts_at_the_static_stiffness(cable_report):
    table = read(cable_report["stiffness_trace.csv"])
    dynamic, static = (numbers(table[name]) for name in ("dynamic_N_per_m", "static_N_per_m"))
    assert dynamic[0] == pytest.approx(static[0], rel=0.02)  # the closed form's small-sag error
    assert np.abs(dynamic / static - 1.0).max() > 0.5


def test_csv_keeps_all_digits_and_leaves_nan_empty():
    assert csv_text({"a": [1, 2], "b_m": np.array([0.1 + 0.2, np.nan])}) == "a,b_m\n1,0.30000000000000004\n2,\n"


def test_csv_refuses_columns_of_different_lengths():
    with pytest.raises(ValueError, match="argument 2"):
        csv_text({"a": [1, 2], "b": [1]})


@pytest.mark.parametrize(
    ("value", "spread", "text"),
    [(2.4831234, 3e-3, "2.483"), (2.4831234, 1e-7, "2.483123"), (12.3, 2.0, "12"), (1.5, np.nan, "1.500000")],
)
def test_no_more_digits_than_are_known(value, spread, text):
    assert uncertain(value, spread) == text
