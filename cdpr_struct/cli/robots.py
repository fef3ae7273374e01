"""`cdpr-struct robots`: the robots that come with the package."""

import cdpr_struct as cs
from cdpr_struct.cli.output import Output

NAME = "robots"
EXAMPLES = ("cdpr-struct robots", "cdpr-struct robots --out results/robots")


def run(*, output: Output) -> int:
    """List the built-in robots."""
    output.give(cs.robots())
    return 0
