"""Cable-driven parallel robots: predict deflection and vibration, check the prediction, diagnose measurements."""

from typing import Any

__all__ = ["__version__"]


def __getattr__(name: str) -> Any:
    """`__version__`, looked up when it is asked for."""
    if name == "__version__":
        from importlib.metadata import version

        return version("cdpr-struct")
    raise AttributeError(f"module 'cdpr_struct' has no attribute {name!r}")
