"""A browser, and a page of every command, for the tests that look at pages as a reader does."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

COMMANDS = {
    "cable": "cable --force 100,-100 --length 20 --EA 251327.4123 --rho 0.067",
    "inverse": "inverse thesis-3-1 --pose 0.5,-1,0.8,2,0,5",
    "forward": "forward thesis-3-1 --lengths 10.78,10.38,10.78,10.38,10.24,10.64,10.24,10.64",
    "pose-error": "pose-error thesis-3-1 --grid=-3:3:5,-3:3:5,0.5 --mass 30",
    "map": "map thesis-3-1 --grid=-3:3:5,-3:3:5,0.5 --quantity first-frequency",
    "map-of-three-axes": "map cogiro --grid=-5:5:4,-4:4:4,0.5:4:3 --quantity first-frequency",
    "map-of-one-axis": "map thesis-3-1 --grid=-3:3:9,0,0.5 --quantity first-frequency",
    "modes": "modes thesis-3-1 --count 12",
    "verify": "verify thesis-3-1 --elements 8,16,32 --modes 12",
    "frf": "frf thesis-3-1 --pose 0.5,-1,0.8 --excite fz --respond x,z --band 0.5:6:0.05",
    "audit": "audit thesis-3-1 --grid=-3:3:5,-3:3:5,0.5",
    "audit-of-a-pose": "audit thesis-3-1 --pose 0.5,-1,0.8",
    "distribute": "distribute thesis-5 --trajectory helix --bound frequency",
    "transient": "transient thesis-3-1 --initial-velocity 0.3,0,0 --duration 3",
    "spectrogram": "spectrogram examples/stop/acceleration.csv --robot thesis-3-1",
    "ambient": "ambient examples/ambient/campaign.toml",
    "diagnose": "diagnose examples/table-4-4/campaign.toml",
    "plan": "plan examples/table-4-4/campaign.toml",
    "robots": "robots",
    "reproduce": "reproduce fig-3.4 fig-5.5",
}


def browser_path() -> str | None:
    """The system's Chromium, if there is one."""
    return next(filter(None, map(shutil.which, BROWSERS)), None)


@pytest.fixture(scope="session")
def browser():
    driver = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (extra [browser])")
    if browser_path() is None:
        pytest.skip(f"no browser: none of {', '.join(BROWSERS)} is on the path")
    with driver.sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=browser_path(), args=FLAGS)
        yield running
        running.close()


class Folders:
    """The folder of each command's files, made by the command line as a user runs it, when it is first asked for."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def __getitem__(self, name: str) -> Path:
        folder = self.root / name
        if not folder.exists():
            environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
            words = [sys.executable, "-m", "cdpr_struct", *COMMANDS[name].split(), f"--out={folder}", "--quiet"]
            done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
            assert (folder / "result.json").exists(), done.stderr
        return folder


@pytest.fixture(scope="session")
def folders(browser, tmp_path_factory) -> Folders:
    return Folders(tmp_path_factory.mktemp("pages"))


@pytest.fixture
def written(folders):
    """Names of the files that a command lists in its result.json."""
    return lambda name: set(json.loads((folders[name] / "result.json").read_text("utf-8"))["files"])
