"""The readers that are attacked: each takes bytes, writes them as the files that a user would give, and loads these."""

import shutil
import tempfile
from collections.abc import Mapping
from functools import partial
from importlib.resources import files
from pathlib import Path

from cdpr_struct.cli.import_caspr import read_text
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.campaign_rows import read_rows
from cdpr_struct.measurement.time_series import read_accelerations
from cdpr_struct.measurement.trajectory_file import read_trajectory
from cdpr_struct.measurement.universal_rows import universal_columns
from cdpr_struct.robot.caspr_import import Choices, import_caspr
from cdpr_struct.robot.plausibility import implausible
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from cdpr_struct.robot.robot_writing import robot_toml
from tests.fuzz.judging import Reader
from tests.fuzz.seeds import BETWEEN, CAMPAIGN, KINDS, STATES


def scratch() -> Path:
    """A directory in memory where there is one."""
    memory = Path("/dev/shm")
    return Path(tempfile.mkdtemp(prefix="cdpr-fuzz-", dir=memory if memory.is_dir() else None))


def robot(place: Path, data: bytes) -> None:
    """A robot file; what it says is doubted, written and read again."""
    (place / "robot.toml").write_bytes(data)
    loaded = load_robot(place / "robot.toml")
    implausible(loaded)
    again = robot_of_text(robot_toml(loaded, loaded.name), "written.toml")
    assert len(again.cables) == len(loaded.cables)


def campaign(place: Path, data: bytes) -> None:
    """A campaign file beside data files of every kind."""
    (place / "campaign.toml").write_bytes(data)
    load_campaign(place / "campaign.toml")


def table(place: Path, data: bytes) -> None:
    """A data file of the kind that the first byte chooses, alone and in a campaign."""
    kind = KINDS[data[0] % len(KINDS)] if data else KINDS[0]
    (place / "fuzzed.csv").write_bytes(data[1:])
    if kind == "accelerations":
        read_accelerations(place / "fuzzed.csv")
        return
    read_rows(kind, place / "fuzzed.csv", 8)
    (place / "campaign.toml").write_text(CAMPAIGN + f'[[measurement]]\nkind = "{kind}"\nfile = "fuzzed.csv"\n')
    load_campaign(place / "campaign.toml")


def caspr(place: Path, data: bytes) -> None:
    """Bodies and cables; what is made of them is a robot file."""
    bodies, _, cables = data.partition(BETWEEN)
    (place / "bodies.xml").write_bytes(bodies)
    (place / "cables.xml").write_bytes(cables)
    texts = read_text(place / "bodies.xml", "BODIES.xml"), read_text(place / "cables.xml", "CABLES.xml")
    made = import_caspr(*texts, "bodies.xml", "cables.xml", Choices())
    robot_of_text(made.text, "imported.toml")


def universal(place: Path, data: bytes) -> None:
    """A universal file, alone and as rows of a campaign."""
    (place / "fuzzed.uff").write_bytes(data)
    universal_columns(place / "fuzzed.uff")
    read_rows("frf", place / "fuzzed.uff", 8)


def trajectory(place: Path, data: bytes) -> None:
    """A trajectory in a CSV file."""
    (place / "fuzzed.csv").write_bytes(data)
    read_trajectory(place / "fuzzed.csv", 4)


TARGETS = {
    "robot": robot, "campaign": campaign, "table": table, "caspr": caspr, "universal": universal,
    "trajectory": trajectory,
}  # fmt: skip


def reader(name: str, place: Path) -> Reader:
    """The reader of a target, in a directory with the files that it needs."""
    for file, text in STATES.items():
        (place / file).write_bytes(text)
    shutil.copy(str(files("cdpr_struct.robot.builtin") / "cogiro.toml"), place / "mine.toml")
    return partial(TARGETS[name], place)


def seeds_of(name: str, seeds: Mapping[str, list[bytes]], place: Path) -> None:
    """Write the seeds of a target as the corpus of its first run."""
    place.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(seeds[name]):
        (place / f"seed-{number:03d}").write_bytes(seed)
