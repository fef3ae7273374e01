"""Other codes, each in a file of its own; absent ones are told, not missed."""

import importlib
from importlib.metadata import PackageNotFoundError, version
from types import ModuleType

PACKAGES = {"OpenSeesPy": "openseespy.opensees", "Exudyn": "exudyn", "MoorPy": "moorpy", "CasADi": "casadi"}
"""Name of a peer, and what is imported of it. The extra [bench] installs them."""


class PeerAbsentError(Exception):
    """A peer is not installed."""


def load(peer: str) -> ModuleType:
    """The module of a peer.

    Raises
    ------
    PeerAbsentError : it is not installed, or cannot run here.
    """
    try:
        return importlib.import_module(PACKAGES[peer])
    except (ImportError, RuntimeError, OSError) as error:
        raise PeerAbsentError(f"{peer} is skipped: {error}. `pip install -e .[bench]` brings it.") from None


def present(peers: tuple[str, ...]) -> tuple[list[str], list[str]]:
    """Those of the peers that can run here, and a sentence on each other one."""
    found, sentences = [], []
    for peer in peers:
        try:
            load(peer)
        except PeerAbsentError as error:
            sentences.append(str(error))
        else:
            found.append(peer)
    return found, sentences


def versions() -> dict[str, str]:
    """Versions of the packages that are installed."""
    found = {}
    for name in ("numpy", "scipy", "openseespy", "exudyn", "moorpy", "moordyn", "casadi"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
