"""Hide an effect, require finding it: twelve campaigns, and no wrong name said with confidence."""

from tests.blind.__main__ import main
from tests.blind.scoring import case_rows, figures, scored_cases


def test_no_wrong_confident_name_in_the_mini_suite(tmp_path):
    out = tmp_path / "ci"
    assert main(["make", "--set", "ci", "--out", str(out)]) == 0
    assert main(["run", "--out", str(out), "--budget", "small"]) == 0
    cases = scored_cases(out / "campaigns", out / "answers", tmp_path / "ci-sealed")
    found = figures(cases)
    assert len(cases) == 12
    assert found["failed_runs"]["successes"] == 0, case_rows(cases)
    assert found["wrong_confident_name"]["successes"] == 0, case_rows(cases)
