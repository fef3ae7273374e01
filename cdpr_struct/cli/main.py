"""The program `cdpr-struct`: one subcommand a file, and the one place that turns errors into exit codes."""

import logging
import os
import sys
from importlib.metadata import version as installed
from typing import Annotated

import typer
from typer.exceptions import Abort

from cdpr_struct.cli import (
    accept,
    ambient,
    audit,
    cable,
    compare,
    derive,
    diagnose,
    distribute,
    export,
    forward,
    frf,
    import_caspr,
    import_recording,
    interruption,
    inverse,
    map,
    modes,
    new_campaign,
    new_robot,
    plan,
    pose_error,
    reproduce,
    rerun,
    robots,
    sensitivity,
    spectrogram,
    transient,
    verify,
    view,
)
from cdpr_struct.cli.command import examples, register
from cdpr_struct.cli.complaints import complaint
from cdpr_struct.cli.interruption import Interrupted

app = typer.Typer(
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Deflection and vibration of cable-driven parallel robots, checked against an independent FEM.",
    epilog=examples(("cdpr-struct verify thesis-3-1 --out results/verify", "cdpr-struct modes --help")),
)
COMMANDS = (
    robots,
    cable,
    inverse,
    forward,
    pose_error,
    map,
    modes,
    sensitivity,
    accept,
    verify,
    reproduce,
    import_caspr,
    derive,
    distribute,
    frf,
    transient,
    spectrogram,
    audit,
    ambient,
    compare,
    diagnose,
    plan,
    new_robot,
    new_campaign,
    import_recording,
    export,
    rerun,
    view,
)


def _version(asked: bool) -> None:
    if asked:
        print(f"cdpr-struct {installed('cdpr-struct')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Deflection and vibration of cable-driven parallel robots, checked against an independent FEM."""


for command in COMMANDS:
    register(app, command)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit: 0 done, 1 done but it does not hold, 2 unusable input."""
    code = run(arguments)
    if code == interruption.CODE:
        sys.stdout.flush()
        os._exit(code)  # without waiting for a thread that computes a part
    sys.exit(code)


def run(arguments: list[str] | None) -> int:
    """Run one command and return its exit code."""
    try:
        typed = sys.argv[1:] if arguments is None else arguments
        logging.getLogger("matplotlib").setLevel(logging.ERROR)  # which tells where it finds no home directory
        with interruption.stopped_in_order():
            code = int(app(args=typed, prog_name="cdpr-struct", standalone_mode=False, obj=tuple(typed)) or 0)
        return _fail(code, "interrupted; nothing was written") if code == interruption.CODE else code
    except Interrupted as stop:
        return _fail(interruption.CODE, str(stop))
    except (Abort, KeyboardInterrupt):
        return _fail(interruption.CODE, "interrupted; nothing was written")
    except Exception as error:
        told = complaint(error)
        if told is None:
            raise
        return _fail(*told)


def _fail(code: int, message: str) -> int:
    print(f"cdpr-struct: {message}", file=sys.stderr)
    return code


if __name__ == "__main__":
    main()
