"""The benchmarks run, peers included where installed, and the page tells what they ask."""

import re
from pathlib import Path

import numpy as np
import pytest

from benchmarks import exact_cable, geometric_term, growth, pose_batch, robot_modes, single_cable
from benchmarks import statics_forward_kinematics as kinematics
from benchmarks.__main__ import QUESTIONS, main
from benchmarks.distribution import GeneralSolver, HelixDistribution
from benchmarks.frf import FrequencyResponse
from benchmarks.markdown_page import put
from benchmarks.peers import PACKAGES, PeerAbsentError, load, present
from benchmarks.robot_reference import converged_frequencies, romberg
from benchmarks.timing import medians
from benchmarks.vibration_floor import VibrationFloor

PAGE = Path(__file__).parents[2] / "docs" / "benchmarks.md"
pytestmark = pytest.mark.filterwarnings("ignore")  # of the peers


def need(peer: str) -> None:
    pytest.importorskip(PACKAGES[peer]) if peer else None


@pytest.mark.parametrize("code", single_cable.CODES, ids=lambda code: code.name)
def test_every_code_finds_the_frequencies_of_the_cable_the_better_the_finer(code):
    need(code.peer)
    errors = []
    for size in (code.sizes[0], code.sizes[2]):
        case = single_cable.SingleCable()
        case.setup((code.name, size))
        errors.append(case.track_error((code.name, size)))
    assert errors[1] < 0.3 * errors[0] < 0.1


def test_ours_reaches_ten_digits_of_the_exact_solution():
    case = single_cable.SingleCable()
    case.setup((single_cable.OURS, 30))
    assert case.track_error((single_cable.OURS, 30)) < 1e-11  # measured 3e-13


def test_the_exact_solution_does_not_depend_on_its_steps(monkeypatch):
    cable = single_cable.single_cable()
    fine = exact_cable.exact_frequencies(cable, 3)
    monkeypatch.setattr(exact_cable, "_SEGMENTS", exact_cable._SEGMENTS // 2)
    np.testing.assert_allclose(exact_cable.exact_frequencies(cable, 3), fine, rtol=1e-13)


@pytest.mark.parametrize("way", [way for way in robot_modes.WAYS if 12 in way.counts], ids=lambda way: way.name)
def test_every_way_finds_the_modes_of_the_robot(way):
    need(way.peer)
    case = robot_modes.RobotModes()
    case.setup((way.name, 12))
    reference = converged_frequencies(case.data, robot_modes.POSITION, 12, (20, 40, 80))
    assert case.error(reference) < 2e-4


def test_only_ways_with_the_geometric_term_come_near_the_finite_elements():
    for peer in ("Exudyn", "OpenSeesPy"):
        need(peer)
    case = geometric_term.GeometricTerm()
    case.setup("", 12)
    reference = converged_frequencies(case.data, robot_modes.POSITION, 12).hertz
    far = {way: geometric_term.farthest(case.frequencies(way), reference) for way in geometric_term.WAYS}
    without = [far[way] for way in far if "ideal" in way or "rigidLink" in way]
    assert min(without) > 4e-5 > 1e-5 > max(far[way] for way in far if far[way] not in without)


def test_a_batch_of_poses_agrees_with_certified_modes_and_with_exudyn():
    case = pose_batch.PoseBatch()
    case.setup(3)
    exact = case.certified()
    np.testing.assert_allclose(case.modes().hertz[case.sample], exact, rtol=1e-8)
    need("Exudyn")
    np.testing.assert_allclose(case.by_exudyn(), exact, rtol=1e-4)


def test_moorpy_finds_the_poses_that_ours_finds():
    ours = kinematics.ForwardKinematics()
    ours.setup(2)
    ours.time_batched(2)
    need("MoorPy")
    peer = kinematics.MoorPyEquilibrium()
    peer.setup(2)
    peer.time_one_by_one(2)
    found = kinematics.forward(ours.robot, ours.lengths, ours.poses).position
    np.testing.assert_allclose(peer.positions, found, atol=1e-5)


def test_floor_and_frequency_response_run(monkeypatch):
    bench = VibrationFloor()
    bench.setup("thesis-3-1", 2)
    for task in (bench.time_floor, bench.time_inverse, bench.time_first, bench.time_many, bench.time_map):
        task()
    monkeypatch.setattr("benchmarks.frf.FREQUENCIES", 20)
    case = FrequencyResponse()
    case.setup("dsm", "viscous")
    case.time_solve("dsm", "viscous")
    case.time_response("dsm", "viscous")
    case.time_model("dsm", "viscous")


@pytest.mark.parametrize("solver", ["SLSQP", "IPOPT"])
def test_general_solvers_find_the_same_tensions(solver):
    if solver == "IPOPT":
        need("CasADi")
    ours, peer = HelixDistribution(), GeneralSolver()
    ours.setup("fixed")
    peer.setup("fixed", solver, 1500)
    np.testing.assert_allclose(peer.tensions(), ours.tensions("fixed")[peer.warm], rtol=1e-6)


def test_the_page_has_a_section_for_every_question_and_room_for_growth():
    page = PAGE.read_text("utf-8")
    asked = re.findall(r"<!-- ([a-z-]+) -->\n", page)
    assert [name for name in asked if name != "end"] == [question.name for question in QUESTIONS]
    assert re.findall(r"^## (.+)$", page, flags=re.MULTILINE)[-1] == "Growth"
    for question in QUESTIONS:
        section = page.partition(f"<!-- {question.name} -->")[2].partition("<!-- end -->")[0]
        assert "Measured on" in section, f"run: python -m benchmarks {question.name} --write"


def test_the_figures_of_the_page_are_there():
    for name in re.findall(r"\]\(([^)]+\.svg)\)", PAGE.read_text("utf-8")):
        assert (PAGE.parent / name).read_text("utf-8").lstrip().startswith("<?xml")


def test_romberg_removes_even_powers():
    steps = 1.0 / np.array([2.0, 4.0, 8.0])
    assert romberg(list(3.0 + 5.0 * steps**2 - 2.0 * steps**4)) == pytest.approx(3.0, abs=1e-14)


def test_an_absent_peer_is_told_in_a_sentence(monkeypatch):
    monkeypatch.setitem(PACKAGES, "Exudyn", "no_such_package")
    with pytest.raises(PeerAbsentError, match=r"Exudyn is skipped: No module named 'no_such_package'. .*\[bench\]"):
        load("Exudyn")
    found, sentences = present(("Exudyn",))
    assert not found
    assert "skipped" in sentences[0]


def test_medians_take_turns():
    order: list[str] = []
    medians({"a": lambda: order.append("a"), "b": lambda: order.append("b")}, 2)
    assert "".join(order) == "ababab"


@pytest.mark.parametrize("words", [["no-such-question"], ["frf", "--quick", "--write"]])
def test_unusable_words_are_one_sentence_and_code_two(words, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(words)
    assert stopped.value.code == 2
    assert "Traceback" not in capsys.readouterr().err


def test_one_question_prints_its_table(capsys):
    assert main(["single-cable", "--quick"]) == 0
    assert "| cdpr-struct |" in capsys.readouterr().out


def test_a_page_without_the_section_is_refused():
    with pytest.raises(ValueError, match="the page has no <!-- growth -->"):
        put("text", "growth", "table")


def test_an_exponent_is_the_slope_of_the_larger_sizes():
    sizes = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
    assert growth.exponent(sizes, 3.0 * sizes**1.5) == pytest.approx(1.5)
    assert growth.exponent(sizes, np.where(sizes < 4.0, 100.0, sizes)) == pytest.approx(1.0)


@pytest.mark.parametrize("name", [n for n in growth.GROWTHS if n not in ("map-poses", "diagnosis-readings")])
def test_the_smallest_size_of_every_task_of_growth_runs(name, monkeypatch):
    monkeypatch.setattr(growth, "REPETITIONS", 1)
    seconds, megabytes = growth.alone(name, growth.GROWTHS[name].sizes[0])
    assert 0.0 < seconds < 60.0
    assert megabytes > 10.0


def test_a_size_runs_in_a_process_of_its_own():
    seconds, megabytes = growth.measured("map-poses", 100)
    assert seconds > 0.0
    assert 20.0 < megabytes < 1000.0
