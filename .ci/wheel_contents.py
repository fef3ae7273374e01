"""wheel_contents.py WHEEL SOURCE: the wheel holds every file of the packages, and nothing beside them.

Top-level names are those of [tool.setuptools.packages.find]; a package's README.md is for those who read the source.
"""

import os
import sys
import tomllib
import zipfile
from pathlib import Path

NOT_SHIPPED = {"README.md"}


def main(wheel: str, source: str) -> int:
    """Print what is missing and what does not belong there; 1 if there is any."""
    root = Path(source)
    settings = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))
    packages = [name.rstrip("*") for name in settings["tool"]["setuptools"]["packages"]["find"]["include"]]
    expected = {
        (Path(folder) / name).relative_to(root).as_posix()
        for package in packages
        for folder, _, names in os.walk(root / package, followlinks=True)
        for name in names
        if name not in NOT_SHIPPED and "__pycache__" not in folder
    }
    with zipfile.ZipFile(wheel) as archive:
        held = {name for name in archive.namelist() if not name.split("/")[0].endswith(".dist-info")}
    for name in sorted(expected - held):
        print(f"missing in the wheel: {name}")
    for name in sorted(held - expected):
        print(f"in the wheel, not in the packages: {name}")
    print(f"{len(held)} files of {', '.join(packages)}")
    return int(held != expected)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
