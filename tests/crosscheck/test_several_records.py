"""Records of one campaign that are identified by several processes give what they give one by one."""

import numpy as np
import pandas as pd
import pytest

from cdpr_struct.measurement import signal_cases
from cdpr_struct.measurement.campaign_file import load_campaign

CAMPAIGN = 'robot = "thesis-3-1"\n[[measurement]]\nkind = "free_decay"\nfile = "signal.csv"\n'


def decays(cases: int) -> pd.DataFrame:
    """Two modes each, at poses of their own."""
    time, tables = np.arange(400) * 0.01, []
    for k in range(cases):
        ring = np.exp(-0.3 * time) * (np.sin((21.0 + k) * time) + 0.5 * np.sin((47.0 + k) * time))
        noise = np.random.default_rng(k).normal(size=(len(time), 3))
        signal = ring[:, None] * [1.0, 0.3, 0.2] + 0.01 * noise
        where = {"case": f"s{k}", "time_s": time, "x_m": 0.1 * k, "y_m": 0.0, "z_m": 1.0}
        tables.append(pd.DataFrame(where).assign(**dict(zip(("ax", "ay", "az"), signal.T, strict=True))))
    return pd.concat(tables)


@pytest.mark.parametrize("few", [3, 100])
def test_modes_do_not_depend_on_where_they_were_identified(tmp_path, monkeypatch, few):
    decays(4).to_csv(tmp_path / "signal.csv", index=False)
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    started = []
    real = signal_cases.Parallel
    monkeypatch.setattr(signal_cases, "Parallel", lambda n_jobs: started.append(n_jobs) or real(n_jobs=n_jobs))
    monkeypatch.setattr(signal_cases, "_FEW", few)
    found = load_campaign(tmp_path / "campaign.toml").identified
    assert started == [-1 if few < 4 else 1]
    assert [item.record.case for item in found] == ["s0", "s1", "s2", "s3"]
    for k, item in enumerate(found):
        hertz = np.array([21.0 + k, 47.0 + k]) / (2.0 * np.pi)
        assert np.abs(item.modes.hertz[:, None] - hertz).min(axis=0) == pytest.approx(0.0, abs=0.01)
