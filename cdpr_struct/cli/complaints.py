"""The exit code and the sentence that an error becomes."""

from concurrent.futures import BrokenExecutor

from typer import BadParameter
from typer.exceptions import TyperException

from cdpr_struct.errors import InputError, on_one_line, told

_LONGEST = 2400  # characters of any complaint


def complaint(error: Exception) -> tuple[int, str] | None:
    """Exit code and one line; None for what is a defect of the program."""
    code, sentence = _code_and_sentence(error)
    return None if code is None else (code, on_one_line(sentence, _LONGEST))


def _code_and_sentence(error: Exception) -> tuple[int | None, str]:
    if isinstance(error, TyperException):
        return 2, _words(error)
    if isinstance(error, InputError):
        return 2, str(error)
    if isinstance(error, BrokenExecutor):
        return 1, "a worker process was ended from outside (too little memory, for instance); give fewer --workers"
    if type(error).__module__.partition(".")[0] == "distributed":
        return 1, f"the cluster gave up ({type(error).__name__}: {error})"
    if isinstance(error, OSError) and error.strerror:
        return 2, f"{error.filename or 'standard output'}: {error.strerror}"
    known = told(error)
    return (None, "") if known is None else (1, str(known))


def _words(error: TyperException) -> str:
    """What is wrong with the words of the command line, in one line."""
    if isinstance(error, BadParameter) and error.param is not None and error.message.startswith("got "):
        return f"{error.param.opts[0]}: {error.message}"
    said = error.format_message().replace("\n", " ").rstrip(".")
    return f"{on_one_line(said, 600)}. See cdpr-struct --help."
