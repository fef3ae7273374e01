"""Labels of robot peaks: read from two columns, and what they make of the assignment."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.errors import InputError
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.measurement.campaign import NOT_SAID, PLATFORM
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded

THESIS = Path(__file__).parents[2] / "examples" / "section-4-3-3"


def labelled(folder: Path, *labels: str) -> str:
    """The campaign of section 4.3.3 with a label, "body,mode", behind each of its five peaks."""
    lines = [
        row for row in (THESIS / "measured.csv").read_text("utf-8").splitlines() if row and not row.startswith("#")
    ]
    more = [f"{lines[0]},body,mode", *(f"{row},{label}" for row, label in zip(lines[1:], labels, strict=True))]
    (folder / "measured.csv").write_text("\n".join(more) + "\n", "utf-8")
    (folder / "campaign.toml").write_text((THESIS / "campaign.toml").read_text("utf-8"), "utf-8")
    return str(folder / "campaign.toml")


def test_labels_are_read(tmp_path):
    found = load_campaign(labelled(tmp_path, "platform,1", "platform,", "cable 3,", "8,", ",")).robot_frequencies
    assert found.body.tolist() == [PLATFORM, PLATFORM, 2, 7, NOT_SAID]
    assert found.mode.tolist() == [1, *[NOT_SAID] * 4]


@pytest.mark.parametrize(
    ("label", "expected"),
    [
        ("cable 9,", "cable 1 to 8"),
        ("mast,", "platform, cable"),
        ("platform,1.5", "whole number"),
        (",2", "the body platform beside it"),
    ],
)
def test_a_label_that_means_nothing_is_refused(tmp_path, label, expected):
    with pytest.raises(InputError, match=expected):
        load_campaign(labelled(tmp_path, *[label] * 5))


def test_labels_hold_peaks_at_their_modes_however_far(tmp_path):
    """Mode 1 of the platform at 2.8 Hz keeps the peak at 4.6 Hz, which else goes to the mode at 4.4 Hz."""
    campaign = load_campaign(labelled(tmp_path, *(f"platform,{i}" for i in range(1, 6))))
    pairs = []
    for robot in (campaign.robot_frequencies, replace(campaign.robot_frequencies, body=np.zeros(0), mode=np.zeros(0))):
        data = recorded(replace(campaign, robot_frequencies=robot))
        found = judged(data, layout(data), Hypothesis())
        pair, modes = found.lists.association.assignment.matching.pair[0], found.lists.association.modes
        pairs.append((np.exp(modes.ln_frequency[0][pair.argmax(axis=-1)]), pair.max(axis=-1)))
    (held, sure), (free, _) = pairs
    assert (np.diff(held) > 0.0).all()
    assert held[0] < 3.0 < free[0]
    assert (sure > 0.9).all()  # of no mode only one time in a thousand as often as a peak without a label
