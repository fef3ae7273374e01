"""`cdpr-struct view`: the robot in a browser window, with sliders."""

import sys
import webbrowser
from typing import Annotated

import typer

from cdpr_struct.cli.options import (
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    UpperBound,
    whole_number,
)

NAME = "view"
EXAMPLES = (
    "cdpr-struct view thesis-3-1",
    "cdpr-struct view cogiro --campaign examples/table-4-4/campaign.toml --no-browser --port 8090",
)


def run(
    robot: RobotName,
    pose: PoseText = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    campaign: Annotated[
        str | None, typer.Option("--campaign", metavar="CAMPAIGN.toml", help="Measured states to step through.")
    ] = None,
    count: Annotated[int, typer.Option("--count", parser=whole_number, help="How many modes.")] = 12,
    port: Annotated[int, typer.Option("--port", parser=whole_number, help="Where the window is served.")] = 8080,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only.")] = False,
) -> int:
    """Show the robot live in a browser window on this machine, with sliders for pose, payload and lengths."""
    from cdpr_struct.interface.view import open_window

    server, window = open_window(
        robot, pose, lower_bound=lower_bound, upper_bound=upper_bound, payload=payload, mass=mass, campaign=campaign,
        count=count, port=port,
    )  # fmt: skip
    address = f"http://localhost:{server.get_port()}"
    print(f"{window.robot.name}: {address} (end with Ctrl-C)", file=sys.stdout, flush=True)
    if not no_browser:
        webbrowser.open(address)
    try:
        window.run()
    except KeyboardInterrupt:
        return 0
    finally:
        server.stop()
