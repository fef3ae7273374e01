"""What all commands share: options for where results go, and examples at the end of their help."""

import functools
import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Annotated

import typer

from cdpr_struct.cli.options import directory
from cdpr_struct.cli.output import TABLE_FORMS, Output, TableForm, repeating
from cdpr_struct.errors import InputError

_OUT = Annotated[
    Path | None,
    typer.Option(
        "--out", parser=directory, metavar="DIR", help="Write result.json, tables, figures and report.html here."
    ),
]
_JSON = Annotated[bool, typer.Option("--json", help="Print result.json to stdout, nothing else.")]
_QUIET = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bar and no text; with --json the JSON only.")]
_OVERWRITE = Annotated[bool, typer.Option("--overwrite", help="Replace files in DIR that this program did not write.")]
_TABLES = Annotated[
    str | None,
    typer.Option("--tables", metavar="FORM", help="Write each CSV table once more: md, latex or parquet."),
]
_SHARED = {
    "out": (_OUT, None), "json": (_JSON, False), "quiet": (_QUIET, False), "overwrite": (_OVERWRITE, False),
    "tables": (_TABLES, None),
}  # fmt: skip
_OF_RESULTS = ("out", "tables")  # a command that declares --out for itself writes no directory of results


def register(app: typer.Typer, command: ModuleType) -> None:
    """Add a command module (NAME, EXAMPLES, run) to the program."""
    app.command(name=command.NAME, epilog=examples(command.EXAMPLES))(with_output(command.run))


def with_output(run: Callable[..., int]) -> Callable[..., int]:
    """The command with options in place of its parameter `output`, an `Output`.

    A command that writes no directory of results declares some of these options itself; one that has no parameter
    `output` has none of them.
    """
    own = [p for p in inspect.signature(run, eval_str=True).parameters.values() if p.name != "output"]
    delivers = "output" in inspect.signature(run).parameters
    declared = {p.name for p in own}
    left_out = declared | set(_OF_RESULTS) if "out" in declared else declared
    added = {name: pair for name, pair in _SHARED.items() if delivers and name not in left_out}
    keyword = inspect.Parameter.KEYWORD_ONLY

    @functools.wraps(run)
    def command(context: typer.Context, **given: object) -> int:
        if not delivers:
            return _asked(run, given, own)
        where = {name: given.pop(name) if name in added else given.get(name) for name in _SHARED}
        tables = _table_form(where["tables"])
        out = where["out"] if "out" in added else None
        assert out is None or isinstance(out, Path)
        flags = (bool(where["json"]), bool(where["quiet"]), bool(where["overwrite"]))
        output = Output(out, *flags, repeating(context.obj or ()), tables)
        output.check()
        return _asked(run, {**given, "output": output}, own)

    shown = [inspect.Parameter("context", keyword, annotation=typer.Context)]
    shown += [p.replace(kind=keyword) for p in own]
    shown += [inspect.Parameter(n, keyword, default=d, annotation=a) for n, (a, d) in added.items()]
    command.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in shown}
    return command


def _table_form(given: object) -> TableForm | None:
    """The form that --tables names, if what writes it is installed."""
    form = next((one for one in TABLE_FORMS if one == given), None)
    if form is None and given is not None:
        raise InputError("--tables", "", given, f"one of: {', '.join(TABLE_FORMS)}")
    if form == "parquet" and find_spec("pyarrow") is None:
        raise InputError("--tables", "", form, "Parquet needs the extra: pip install 'cdpr-struct[parquet]'")
    return form


def _asked(run: Callable[..., int], given: Mapping[str, object], own: Sequence[inspect.Parameter]) -> int:
    """What the command returns; complaints about arguments name options."""
    try:
        return run(**given)
    except InputError as error:
        raise _of_option(error, own) from error


def _of_option(error: InputError, own: Sequence[inspect.Parameter]) -> InputError:
    """A complaint about an argument as one about the option, or the word, that it was given by."""
    options = {parameter.name: _shown(parameter) for parameter in own}
    known = options | {option.removeprefix("--").replace("-", "_"): option for option in options.values()}
    if error.source not in known:
        return error
    expected = re.sub(r"`(\w+)`", lambda name: known.get(name[1], name[0]), error.expected)
    return InputError(known[error.source], error.field, error.value, expected)


def _shown(parameter: inspect.Parameter) -> str:
    """An option as it is typed, or the word that the help has for an argument."""
    declared = parameter.annotation.__metadata__[0]
    words = [word for word in (declared.default, *(declared.param_decls or ())) if str(word).startswith("--")]
    return words[0] if words else (declared.metavar or parameter.name.upper()).strip("[").split(".")[0].strip()


def examples(lines: Sequence[str]) -> str:
    """Examples as the help shows them, a line each."""
    return "\n".join(["\b", "Examples:", *(f"  {line}" for line in lines)])
