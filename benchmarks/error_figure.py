"""The picture: error over processor time, one curve a code."""

from pathlib import Path


def draw_curves(path: Path, curves: dict[str, list[tuple[float, float]]], quantity: str) -> None:
    """Write curves of (seconds, error) as SVG, both axes logarithmic; the same input gives the same file."""
    import matplotlib

    with matplotlib.rc_context({"svg.hashsalt": path.name, "svg.fonttype": "path"}):
        from matplotlib.figure import Figure

        figure = Figure(figsize=(7.0, 4.6), layout="constrained")
        axes = figure.add_subplot()
        for marker, (name, points) in zip("osD^vPX", curves.items(), strict=False):
            ordered = sorted(points, key=lambda point: -point[1])
            axes.loglog(*zip(*((1e3 * t, e) for t, e in ordered), strict=True), marker=marker, markersize=4, label=name)
        axes.set(xlabel="processor time [ms]", ylabel=quantity)
        axes.grid(True, which="major", alpha=0.3)
        axes.legend(frameon=False, fontsize=8)
        figure.savefig(path, format="svg", metadata={"Date": None})
