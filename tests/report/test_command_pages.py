"""Pages of modes, spectrogram, plan, derive and robots: tables equal the result, pages are whole and load nothing."""

import dataclasses
import io
import json
import re

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.interface.modes import ModesResult
from cdpr_struct.planning.campaign_plan import Confusion, Plan
from cdpr_struct.planning.measurements import Measurement
from cdpr_struct.planning.separations import Gain, Separation
from cdpr_struct.reports.derive_page import derive_files
from cdpr_struct.reports.figures.plan import confused_causes
from cdpr_struct.reports.modes_page import modes_files
from cdpr_struct.reports.plan.page import plan_files
from cdpr_struct.reports.plan.result import plan_json
from cdpr_struct.reports.robots_page import robots_files
from cdpr_struct.reports.transient_measured import measured_files, measured_json
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot_file import load_robot

NAMES = ("thesis-3-1", "thesis-5")


def record(hertz=3.4, seconds=4.0):
    """Time [s] and accelerations (n, 3): one decaying tone, strongest along x."""
    time = np.arange(int(seconds * 100) + 1) / 100.0
    tone = np.exp(-0.2 * time) * np.sin(2.0 * np.pi * hertz * time)
    return time, np.column_stack([tone, 0.5 * tone, 0.1 * tone])


def plan_result() -> dict:
    sizes = {
        "axial_stiffness": {"value": 0.0812345678901, "unit": "relative", "pattern": "all alike"},
        "hose_stiffness": {"value": 9.1, "unit": "N/m", "pattern": "as a whole"},
    }
    pairs = [
        Confusion("gravity_tilt", "hose_stiffness", 0.3),
        Confusion("joint_mass", "platform_mass", 1.4),
        Confusion("external_force", "gravity_tilt", 2.9),
    ]
    separations = (
        Separation("gravity_tilt", "hose_stiffness", 0.3, 900.5),
        Separation("joint_mass", "platform_mass", 1.4, 1.4),
    )
    checks = [Measurement("check", (), name) for name in ("tilt", "platform_mass")]
    gains = [Gain(checks[0], 4.7, separations), Gain(checks[1], 0.2, separations)]
    return plan_json(Plan(sizes, pairs, gains, {"creep": "needs time_s, over minutes", "cable_sag": "has sag"}))


def derive_result(diff="", value_errors=()) -> dict:
    formulas = [
        {"id": "catenary.sag", "thesis_equation": "2.22", "status": "verified", "note": ""},
        {"id": "cable_dsm.k_xz", "thesis_equation": "2.33", "status": "corrected", "note": "sign, with z <up>"},
    ]
    return {"formulas": formulas, "diff": diff, "value_errors": list(value_errors), "seconds": 1.0}


@pytest.fixture(scope="module")
def modes_found() -> ModesResult:
    return cs.modes("thesis-3-1", count=24)


@pytest.fixture(scope="module")
def modes_of(modes_found) -> dict:
    return modes_found.answer


@pytest.fixture(scope="module")
def measured_of(thesis_point) -> dict:
    return measured_json(*record(), thesis_point, "exact", 12.0)


def robots_of():
    robots = [load_robot(name) for name in NAMES]
    return robots, [{"name": r.name, "cables": len(r.cables), "description": r.description} for r in robots]


@pytest.fixture(scope="module")
def make(modes_found, measured_of):
    """Per command, a function that makes its files."""
    return {
        "modes": modes_found.files,
        "spectrogram": lambda: measured_files(*record(), measured_of, None),
        "plan": lambda: plan_files(plan_result()),
        "derive": lambda: derive_files(derive_result()),
        "robots": lambda: robots_files(*robots_of()),
    }


@pytest.fixture(scope="module")
def made(make) -> dict:
    return {name: function() for name, function in make.items()}


FIGURES = {
    "modes": ["modes", "mode_shapes", "robot"],
    "spectrogram": ["spectrogram"],
    "plan": ["confusions", "gains"],
    "derive": [],
    "robots": ["robot_thesis_3_1", "robot_thesis_5"],
}
TABLES = {
    "modes": {"modes.csv", "platform_motion.csv", "cables.csv"},
    "spectrogram": {"modes.csv", "spectrogram.csv"},
    "plan": {"detectable.csv", "confusable.csv", "not_testable.csv", "next.csv", "separates.csv"},
    "derive": {"formulas.csv"},
    "robots": {"robots.csv"},
}


@pytest.mark.parametrize("command", FIGURES)
def test_files_are_those_promised(command, made):
    figures = {f"{name}.{form}" for name in FIGURES[command] for form in ("svg", "pdf")}
    assert set(made[command]) == {"report.html"} | figures | TABLES[command]


@pytest.mark.parametrize("command", FIGURES)
def test_page_is_whole_and_loads_nothing(command, made, read_page, inlined):
    files = made[command]
    page = read_page(files["report.html"])
    assert page.foreign == []
    assert page.values("figure", "id") == FIGURES[command]
    for name in FIGURES[command]:
        assert inlined(files[f"{name}.svg"]) in files["report.html"]
    captions = re.findall(r"<figcaption>(.*?)</figcaption>", files["report.html"], re.DOTALL)
    assert [len(caption) > 100 for caption in captions] == [True] * len(FIGURES[command])
    ids = [value for _, name, value in page.attributes if name == "id"]
    assert len(ids) == len(set(ids))


@pytest.mark.parametrize("command", FIGURES)
def test_equal_results_give_equal_bytes(command, make, made):
    again = make[command]()
    assert [name for name in again if again[name] != made[command][name]] == []


@pytest.mark.parametrize("command", FIGURES)
def test_every_cell_is_a_plain_number_or_words(command, made):
    """No cell shows how Python writes a value: np.float64(2.48), ['a'], None, True."""
    for name in TABLES[command]:
        table = pd.read_csv(io.StringIO(made[command][name]), keep_default_na=False)
        assert len(table)
        cells = [cell for column in table for cell in table[column] if isinstance(cell, str)]
        assert [c for c in cells if re.search(r"np\.|array\(|[\[\]{}]|^(None|nan|inf|True|False)$", c)] == [], name


def test_the_page_of_modes_has_one_robot_to_turn_and_needs_no_plotly(made):
    page = made["modes"]["report.html"]
    assert "plotly" not in page.lower()
    assert page.count("<canvas") == 1


def test_a_map_of_an_audit_can_be_zoomed_and_shows_the_frame():
    found = cs.audit("thesis-3-1", grid="-1:1:2,-1:1:2,0.5")
    files = found.files
    assert "broken limits, all cables" in files["report.html"]
    assert "worst cable: value over limit" in files["report.html"]
    assert "in the frame" in files["map.svg"]


def test_modes_csv_holds_the_result(made, modes_of):
    written = as_json(modes_of)
    table = pd.read_csv(io.StringIO(made["modes"]["modes.csv"]))
    assert table["mode"].tolist() == list(range(1, 25))
    assert table["frequency_hz"].tolist() == digits(written["frequencies_hz"])
    assert table["platform_energy"].tolist() == digits(written["platform_energy"])
    assert table["kind"].tolist() == written["kinds"]
    cables = pd.read_csv(io.StringIO(made["modes"]["cables.csv"]))
    assert cables["cable"].tolist() == list(range(1, 9))
    assert cables["length_m"].tolist() == digits(written["lengths_m"])
    assert cables["tension_N"].tolist() == digits(written["tensions_N"])


def test_spectrogram_csv_holds_the_result(made, measured_of):
    written = as_json(measured_of)
    table = pd.read_csv(io.StringIO(made["spectrogram"]["modes.csv"]))
    assert table["frequency_hz"].tolist() == digits(written["natural_frequencies_hz"])
    assert table["kind"].tolist() == written["kinds"]
    density = pd.read_csv(io.StringIO(made["spectrogram"]["spectrogram.csv"]))
    strongest = density["frequency_hz"][density["density"].idxmax()]
    assert strongest == pytest.approx(written["dominant_hz"], abs=0.5)  # a window of 0.67 s resolves no better


def test_plan_csv_holds_the_result(made):
    result, files = plan_result(), made["plan"]

    def rows(name):
        table = pd.read_csv(io.StringIO(files[name]))
        return [tuple(row) for row in table.itertuples(index=False)]

    least = [row["minimum_detectable"] for row in result["detectable"]]
    causes = [row["cause"] for row in result["detectable"]]
    assert rows("detectable.csv") == [
        (cause, digits(size["value"]), size["unit"], size["pattern"]) for cause, size in zip(causes, least, strict=True)
    ]
    pairs = zip(result["confusable"], result["confusable_nats"], strict=True)
    assert rows("confusable.csv") == [(a, b, digits(nats)) for (a, b), nats in pairs]
    assert rows("next.csv") == [(r["measurement"], digits(r["gain_nats"]), len(r["separates"])) for r in result["next"]]
    assert rows("not_testable.csv") == sorted(result["not_testable"].items())
    assert rows("separates.csv") == [
        (r["measurement"], s["cause"], s["from"], digits(s["nats_before"]), digits(s["nats_after"]))
        for r in result["next"]
        for s in r["separates"]
    ]


def test_derive_csv_holds_the_result(made):
    table = pd.read_csv(io.StringIO(made["derive"]["formulas.csv"]), dtype=str, keep_default_na=False)
    assert table.to_dict("records") == derive_result()["formulas"]


def test_robots_csv_holds_the_robots(made):
    table = pd.read_csv(io.StringIO(made["robots"]["robots.csv"]))
    robots, rows = robots_of()
    assert table[["name", "cables", "description"]].to_dict("records") == rows
    assert table["platform_mass_kg"].tolist() == [robot.platform.mass for robot in robots]
    assert table["axial_stiffness_N"].tolist() == [robot.cables[0].axial_stiffness for robot in robots]
    assert table["linear_density_kg_m"].tolist() == [robot.cables[0].linear_density for robot in robots]
    assert table.loc[0, ["frame_x_m", "frame_y_m", "frame_z_m"]].tolist() == [16.0, 11.0, 1.0]  # Table 3.1


def test_cables_that_differ_have_no_common_stiffness():
    robot = load_robot("thesis-3-1")
    stiffer = dataclasses.replace(robot.cables[0], axial_stiffness=3e5)
    mixed = dataclasses.replace(robot, cables=(stiffer, *robot.cables[1:]))
    _, rows = robots_of()
    files = robots_files([mixed], rows[:1])
    table = pd.read_csv(io.StringIO(files["robots.csv"]))
    assert np.isnan(table["axial_stiffness_N"][0])
    assert table["linear_density_kg_m"][0] == 0.067
    assert "251.3 to 300" in files["report.html"]


@pytest.mark.parametrize(("certified", "colour"), [(True, "holds"), (False, "fails")])
def test_modes_page_says_whether_the_count_is_certified(certified, colour, modes_found, modes_of, read_page):
    answer = {**modes_of, "count_certified": certified}
    page = read_page(modes_files(modes_found.point, answer, modes_found.motion)["report.html"])
    assert [c for c in page.values("section", "class") if c.startswith("verdict")] == [f"verdict {colour}"]
    assert ("the count is certified" in page.text) is certified
    first = next(f for f, kind in zip(modes_of["frequencies_hz"], modes_of["kinds"], strict=True) if kind == "platform")
    assert f"first platform mode (half of the energy or more) {first:.3f} Hz" in page.text


def test_ladder_shows_every_mode_in_the_colour_of_its_kind(made, modes_of):
    """The stacked marks and the stems: each mode twice."""
    picture = made["modes"]["modes.svg"]
    for colour, kinds in (("#0072b2", ["platform"]), ("#cc79a7", ["mixed"])):
        count = sum(kind in kinds for kind in modes_of["kinds"])
        marks = re.findall(rf'<use [^>]*style="fill: {colour}[^"]*"', picture)
        assert len(marks) == 2 * count + (count > 0), colour  # and one in the legend


def test_ladder_of_a_single_mode_can_be_drawn():
    files = cs.modes("thesis-3-1", count=1).files()
    assert "The first eigenfrequency is 2.483 Hz" in files["report.html"]


def test_spectrogram_page_claims_no_more_than_the_record_resolves(thesis_point, measured_of, read_page):
    """4 s resolve 0.25 Hz: a tone at 3.4 Hz may be the mode at 3.43 Hz. The table begins with the nearest mode."""
    page = read_page(measured_files(*record(), measured_of, None)["report.html"])
    assert "closer than the record resolves (0.25 Hz)" in page.text
    hertz, kinds = np.asarray(measured_of["natural_frequencies_hz"]), measured_of["kinds"]
    nearest = int(np.abs(hertz - measured_of["dominant_hz"]).argmin())
    assert f"kind {nearest + 1} {hertz[nearest]:.4f} " in page.text
    assert kinds[nearest] == "platform"
    far = measured_json(*record(1.0), thesis_point, "exact", 12.0)
    page = read_page(measured_files(*record(1.0), far, None)["report.html"])
    assert re.search(r"2\.483 Hz \(cables\), 60 % higher\.", page.text)  # 1 - 1.0 / 2.483


def test_a_dead_record_has_no_nearest_mode(thesis_point, read_page):
    time, acceleration = record()
    dead = measured_json(time, 0.0 * acceleration, thesis_point, "exact", 12.0)
    assert np.isnan(dead["nearest_mode_hz"])
    page = read_page(measured_files(time, 0.0 * acceleration, dead, None)["report.html"])
    assert "holds no vibration" in page.text


def test_causes_that_are_confused_stand_together():
    assert confused_causes(plan_result()) == [
        "gravity_tilt", "hose_stiffness", "external_force", "joint_mass", "platform_mass",
    ]  # fmt: skip


def test_plan_page_shows_sizes_pairs_and_gains(made, read_page):
    page, files = read_page(made["plan"]["report.html"]), made["plan"]
    assert "would find 2 of 4 causes" in page.text
    assert "confuse 3 pairs of causes" in page.text
    assert "axial stiffness 0.0812 relative all alike" in page.text
    assert "gravity tilt from hose stiffness: 0.3 before, more than 50 after" in page.text
    texts = {text.strip() for text in re.findall(r"<text[^>]*>([^<]*)</text>", files["confusions.svg"])}
    assert {"0.3", "1.4", "2.9", "gravity tilt", "true cause", "would be taken for", "[nats]"} <= texts
    assert "4.7 (1 pair)" in files["gains.svg"]


def test_plan_without_confusion_has_a_page_without_figures(read_page):
    files = plan_files({**plan_result(), "confusable": [], "confusable_nats": [], "next": []})
    assert {name for name in files if name.endswith(".svg")} == set()
    assert "would confuse no two causes" in read_page(files["report.html"]).text
    assert files["confusable.csv"] == "cause,taken_for,nats\n"


def test_derive_page_shows_what_differs(read_page):
    diff = "--- committed/a.py\n+++ fresh/a.py\n@@ -1 +1 @@\n-k < 1\n+k > 1\n"
    files = derive_files(derive_result(diff, ["cable.k_xx: 1e-9"]))
    page = read_page(files["report.html"])
    assert files["changes.diff"] == diff
    assert "1 file differs from what the derivations give: a.py." in page.text
    assert "-k < 1 +k > 1" in page.text
    assert "cable.k_xx: 1e-9" in page.text
    assert "verdict fails" in page.values("section", "class")


def test_derive_page_of_current_files_counts_and_begins_with_corrections(made, read_page):
    page = read_page(made["derive"]["report.html"])
    assert "verdict holds" in page.values("section", "class")
    assert "verified: the thesis's print is right 1" in page.text
    assert "corrected: the print is wrong or incomplete 1" in page.text
    assert page.text.index("cable_dsm.k_xz") < page.text.index("catenary.sag")
    assert "Differences" not in page.text


def test_robot_that_its_cables_do_not_hold_is_drawn_without_tensions(read_page):
    robots, rows = robots_of()
    outside = dataclasses.replace(robots[0], home=Pose(np.array([20.0, 0.0, 0.5]), np.zeros(3)))
    homeless = dataclasses.replace(robots[0], home=None, name="homeless")
    files = robots_files([outside, homeless], [rows[0], {**rows[0], "name": "homeless"}])
    text = read_page(files["report.html"]).text
    assert "At its home pose, (20, 0, 0.5) m" in text
    assert "Geometry only" in text
    assert "At the middle of its frame, (0, 0, 4.5) m" in text  # Table 3.1: anchors at 4 to 5 m


def digits(values):
    """All digits: some versions of pandas round the last bit."""
    return pytest.approx(values, rel=1e-15)


def as_json(result) -> dict:
    """What result.json holds."""
    return json.loads(json.dumps(result, default=lambda value: value.tolist()))
