"""Packages that read recordings: loaded when a file needs them, and their errors as sentences."""

import gc
import logging
import sys
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from cdpr_struct.errors import CdprError, InputError

_LOUD = ("asammdf", "nptdms", "rosbags")  # they log what becomes a sentence here
_LONGEST = 200  # characters of a package's own reason


def library(name: str, form: str, path: Path) -> Any:
    """The module that reads a form of recording.

    Raises
    ------
    InputError : it is not installed; which extra to install.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            module = import_module(name)
    except ImportError as error:
        expected = f"pip install 'cdpr-struct[recordings]', which brings {name.partition('.')[0]} to read it"
        raise InputError(str(path), "", form, expected) from error
    for logger in logging.root.manager.loggerDict:
        if logger.partition(".")[0] in _LOUD:
            logging.getLogger(logger).setLevel(logging.CRITICAL)
    return module


@contextmanager
def reading(path: Path, form: str) -> Iterator[None]:
    """Around calls of such a package: what it raises of a damaged file becomes one sentence, its warnings are silent.

    Raises
    ------
    InputError : the file is damaged, or of a kind that the package does not know.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except CdprError:
        raise
    except Exception as error:  # these packages raise whatever their parsing runs into
        _let_go(error)
        raise damaged(path, form, error) from error


def _let_go(error: Exception) -> None:
    """Delete what a package left half made, which may fail once more or leave a file open: that adds nothing."""
    hook, sys.unraisablehook = sys.unraisablehook, lambda _: None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            traceback.clear_frames(error.__traceback__)
            gc.collect()
    finally:
        sys.unraisablehook = hook


def damaged(path: Path, form: str, error: Exception) -> InputError:
    """The sentence on a file that cannot be read."""
    reason = " ".join(str(error).split())[:_LONGEST]
    said = f"{type(error).__name__}: {reason}" if reason else type(error).__name__
    return InputError(str(path), "", f"{form} that cannot be read", f"a whole file of that kind ({said})")
