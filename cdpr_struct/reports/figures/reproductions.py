"""The thesis's figures, drawn from the columns of their reproductions."""

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.figures import force_reproductions as forces
from cdpr_struct.reports.figures import vibration_reproductions as vibration
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILLION
from cdpr_struct.reports.figures.workspace_map import Layer, draw_heat, legend_handles
from cdpr_struct.thesis.reproduction import Cell, Reproduction
from cdpr_struct.workspace.grid import Grid

Draw = Callable[[Figure, Reproduction], None]
_FORCE_COLOURS = (BLUE, ORANGE, VERMILLION)


def draw_profiles(figure: Figure, item: Reproduction) -> None:
    """Fig. 2.4: cables solid, chords dashed, printed end points as crosses."""
    axes = figure.subplots()
    columns = item.columns
    for force, colour in zip(np.unique(columns["force_N"]), _FORCE_COLOURS, strict=True):
        mine = columns["force_N"] == force
        x, z = columns["x_m"][mine], columns["z_m"][mine]
        axes.plot(x, z, color=colour, linewidth=1.8, label=f"[{force:g}  −{force:g}] N")
        axes.plot([0.0, x[-1]], [0.0, z[-1]], color=colour, linestyle="--", linewidth=0.9)
    ends = [[float(c.printed) for c in item.cells if c.column == name] for name in ("xC_m", "zC_m")]
    axes.plot(*ends, "x", color=BLACK, markersize=7, linestyle="none", label="end points as printed")
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("z [m]")
    axes.legend(loc="upper right")


def draw_pose_errors(figure: Figure, item: Reproduction) -> None:
    """Figs 3.4-3.7: maps of the global error, of what sag adds and of what stretch adds."""
    columns = item.columns
    grid = Grid(np.unique(columns["x_m"]), np.unique(columns["y_m"]), np.zeros(1), np.zeros(3))
    marked = columns["more_stable_pose"].astype(bool)
    titles = {"global": "a) global", "sag": "b) from sag", "axial": "c) from axial elasticity"}
    layers = [Layer(title, "mm", columns[f"{part}_mm"], marked, signed=True) for part, title in titles.items()]
    for axes, layer in zip(figure.subplots(1, 3, sharey=True), layers, strict=True):
        draw_heat(figure, axes, grid, layer, 5)
        axes.label_outer()
    handles = legend_handles(layers)
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=2)


def draw_loads(figure: Figure, item: Reproduction) -> None:
    """Fig. 4.4: three models over the load, printed and found threshold."""
    panels = figure.subplots(1, 2)
    diameters = np.unique(item.columns["diameter_mm"])
    for axes, diameter, cell in zip(panels, diameters, item.cells, strict=True):
        mine = item.columns["diameter_mm"] == diameter
        mass = item.columns["mass_kg"][mine]
        axes.plot(mass, item.columns["sagging_mm"][mine], color=VERMILLION, linewidth=1.8, label="sagging model")
        axes.plot(mass, item.columns["spring_mm"][mine], color=BLACK, linestyle="-.", label="spring model")
        axes.axhline(0.0, color=BLUE, linestyle="--", label="ideal model (reference)")
        marks = ((float(cell.printed), GREY, 0.95, "printed"), (cell.ours, GREEN, 0.88, "ours"))
        for mass_kg, colour, height, who in marks:
            axes.axvline(mass_kg, color=colour, linewidth=1.2)
            left = mass_kg == max(float(cell.printed), cell.ours)
            axes.annotate(f"{who}: {mass_kg:.0f} kg", (mass_kg, height), (4 if left else -4, 0),
                          xycoords=("data", "axes fraction"), textcoords="offset points",
                          ha="left" if left else "right", color=colour)  # fmt: skip
        axes.set_title(cell.row)
        axes.set_xlabel("mass of the platform with its load [kg]")
    panels[0].set_ylabel("pose error along z [mm]")
    figure.legend(handles=panels[0].get_lines()[:3], loc="outside lower center", ncols=3)


def _profiles_caption(item: Reproduction) -> str:
    return "The free end is pulled right and down; solid: cable, dashed: chord, crosses: end points of Table 2.2."


def _maps_caption(item: Reproduction) -> str:
    means = ", ".join(f"{_signed(c)} mm {c.column} ({c.printed} printed)" for c in item.cells)
    return f"{item.title}, z = 0.5 m. Averages over 7 x 7 poses: {means}. Each panel has its own scale."


def _loads_caption(item: Reproduction) -> str:
    return (
        "Pose error along z against the pose of ideal cables at the lengths of Table 4.2. Green: the load at which the "
        "part of sag has fallen to 5 % of that at 10 kg; grey: the thesis's reading. The measured points of the thesis "
        "are not printed as numbers and are left out."
    )


def _signed(cell: Cell) -> str:
    return f"{cell.ours:+.2f}"


FIGURES: dict[str, tuple[Draw, tuple[float, float], Callable[[Reproduction], str]]] = {
    "fig-2.4": (draw_profiles, (7.2, 5.6), _profiles_caption),
    **{f"fig-3.{n}": (draw_pose_errors, (9.6, 3.4), _maps_caption) for n in (4, 5, 6, 7)},
    **{f"fig-{n}": (vibration.draw_trace, (7.2, 3.6), vibration.trace_caption) for n in ("2.5", "4.7", "4.8")},
    **{
        f"fig-{n}": (vibration.draw_determinants, (9.6, 4.0), vibration.determinants_caption)
        for n in ("3.8", "4.9", "4.10")
    },
    "fig-3.9": (vibration.draw_first_frequencies, (12.0, 4.8), vibration.first_frequencies_caption),
    "fig-4.4": (draw_loads, (9.6, 4.2), _loads_caption),
    "fig-5.4": (forces.draw_panels, forces.PANELS_SIZE, forces.bounds_caption),
    "fig-5.5": (forces.draw_panels, forces.PANELS_SIZE, forces.forces_caption),
    "fig-5.6": (forces.draw_energy, forces.ENERGY_SIZE, forces.energy_caption),
}
