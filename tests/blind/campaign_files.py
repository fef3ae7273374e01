"""What is handed to the diagnosis, and what is sealed away from it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from tests.blind.case_drawing import Case
from tests.blind.controller import lower_bound
from tests.blind.deviations import TOLERANCES
from tests.blind.entered_robot import plain_name
from tests.blind.sensors import CABLE_HZ, ROBOT_HZ, SIGMA
from tests.blind.spoiled_signals import DECAY, FRF, MOTION, SIGNAL_HZ

MODEL = "exact"
POSE_SIGMA = ("position_m", "rotation_deg")
SCALE = 0.02  # kg, 1 sigma of the scale a platform is weighed on


def write_case(case: Case, name: str, seed: tuple[int, ...], campaigns: Path, sealed: Path) -> Path:
    """Write the campaign to `campaigns/name` and its truth to `sealed/name.json`; returns the campaign file."""
    folder = campaigns / name
    folder.mkdir(parents=True, exist_ok=True)
    sealed.mkdir(parents=True, exist_ok=True)
    text = robot_text(case)
    if text is not None:
        (folder / "robot.toml").write_text(text, "utf-8")
    for kind, table in case.tables.items():
        table.to_csv(folder / f"{kind}.csv", index=False, float_format="%.9g", lineterminator="\n")
    (folder / "campaign.toml").write_text(campaign_text(case), "utf-8")
    record = sealed_record(case.truth | {"case": name, "seed": list(seed)})
    (sealed / f"{name}.json").write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", "utf-8")
    manifest = json.dumps({"truth_sha256": fingerprint(record)}) + "\n"
    (folder / "manifest.json").write_text(manifest, "utf-8")
    return folder / "campaign.toml"


def sealed_record(truth: dict[str, Any]) -> dict[str, Any]:
    """Truth with the salt that keeps its hash from being found by trying truths."""
    salt = hashlib.sha256(json.dumps(["salt", truth["seed"], truth["case"]]).encode()).hexdigest()
    return {"salt": salt, "truth": truth}


def fingerprint(record: dict[str, Any]) -> str:
    """sha256 of salt and truth."""
    return hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()


def opened_truth(name: str, campaigns: Path, sealed: Path) -> dict[str, Any]:
    """Truth of a case, after checking that it is the one that was sealed when the campaign was written."""
    record = json.loads((sealed / f"{name}.json").read_text("utf-8"))
    expected = json.loads((campaigns / name / "manifest.json").read_text("utf-8"))["truth_sha256"]
    if fingerprint(record) != expected:
        raise ValueError(f"{name}: the sealed truth does not match the hash in its campaign's manifest.json")
    return dict(record["truth"])


def robot_text(case: Case) -> str | None:
    """The robot file that belongs to the campaign; None if it is one of the program's own."""
    if case.check is not None and case.check.robot_text is not None:
        return case.check.robot_text
    return case.robot.text if case.robot.own else None


def campaign_text(case: Case) -> str:
    """The campaign file (TOML)."""
    pulleys = "pulley" in case.robot.text
    file = plain_name(case.robot.name) if robot_text(case) is None else "robot.toml"
    lines = [f'robot = "{file}"', f'model = "{MODEL}"', 'tension_distribution = "minimum_norm"']
    lines += [f"lower_bound_N = {lower_bound(case.robot)}", ""]
    tolerances = {key: value for key, value in TOLERANCES.items() if pulleys or key != "pulley_radius_m"}
    if case.weighed is not None:
        lines += ["[nominal]", f"platform_mass = {case.weighed}", ""]
        tolerances["platform_mass_kg"] = SCALE
    lines += ["[tolerances]", *(f"{key} = {value}" for key, value in tolerances.items())]
    if case.check is not None:
        lines += ["", "[checked]", *(f"{cause} = {sigma:g}" for cause, sigma in case.check.left.items())]
    for kind, table in case.tables.items():
        lines += ["", "[[measurement]]", *measurement_lines(kind, table, case.sigma)]
    return "\n".join(lines) + "\n"


def measurement_lines(kind: str, table: pd.DataFrame, sigma: Mapping[str, float] = SIGMA) -> list[str]:
    """Kind, file and sigmas of one file."""
    if kind in (FRF, DECAY, MOTION):
        return [f'kind = "{kind}"', f'file = "{kind}.csv"', f"sigma = {{ frequency_hz = {SIGNAL_HZ} }}"]
    names = [*POSE_SIGMA]
    names += [key for key in ("tension_N",) if key in table]
    names += [key for key in ("length_m",) if key in table or "length_1_m" in table]
    pairs = [f"{key} = {float(f'{sigma[key]:.6g}')}" for key in names]
    relative = {"cable_frequency": CABLE_HZ, "robot_frequency": ROBOT_HZ}.get(kind)
    if relative is not None:
        pairs.append(f"frequency_hz = {relative * table['frequency_hz'].median():.4g}")
    return [f'kind = "{kind}"', f'file = "{kind}.csv"', f"sigma = {{ {', '.join(pairs)} }}"]
