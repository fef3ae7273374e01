"""The browser window: sliders, the robot in 3-D, tables. The one file that knows viser; it computes nothing itself."""

import time
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from io import StringIO
from typing import Any, NoReturn

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.live import colours, panel
from cdpr_struct.live.controls import Controls, Ranges, slider_ranges
from cdpr_struct.live.measured_state import MeasuredState, measured_state, shown_states
from cdpr_struct.live.scene_lines import arrows, linear, quaternion, segments
from cdpr_struct.live.view_modes import NoModes, ViewModes, view_modes
from cdpr_struct.live.view_state import Refusal, ViewState, view_state
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot import Robot

INSTALL = "install the extra: pip install 'cdpr-struct[view]'"
_POSE = ("x [m]", "y [m]", "z [m]", "rx [deg]", "ry [deg]", "rz [deg]")
_BY_POSE, _BY_LENGTHS, _NO_STATE = "pose", "lengths", "none"
_CYCLE, _PAUSE = 1.5, 0.03  # s of one swing as shown, and between two pictures
_NOTHING = np.zeros((0, 2, 3))


@dataclass(frozen=True, slots=True)
class Shown:
    """What the window shows: the state of rest, its modes, and what was measured there (None: no campaign state)."""

    state: ViewState | Refusal
    modes: ViewModes | NoModes
    measured: MeasuredState | None


def open_server(port: int, label: str) -> Any:
    """A server for this machine's browsers alone; the next free port if this one is taken.

    Raises
    ------
    InputError : viser is not installed.
    """
    try:
        import viser
    except ImportError as error:
        raise InputError("view", "", "no package `viser`", INSTALL) from error
    with redirect_stdout(StringIO()):  # its banner: the caller prints the address
        return viser.ViserServer(host="127.0.0.1", port=port, label=label, verbose=False)


class Window:
    """The window of one robot; `step` answers the sliders and draws the next picture."""

    def __init__(
        self, server: Any, robot: Robot, start: Controls, campaign: Campaign | None = None, count: int = 12
    ) -> None:
        self.server, self.robot, self.campaign, self.count = server, robot, campaign, count
        self._changed, self._last = True, start.placed
        first = view_state(robot, start)
        hanging = np.linalg.norm(first.geometry.frame - first.geometry.platform, axis=1)
        lengths = first.lengths if isinstance(first, ViewState) else hanging
        self._size = float(np.linalg.norm(np.ptp(first.geometry.box(), axis=0)))
        self._build_panel(start, slider_ranges(robot, start, lengths), lengths)
        self._build_scene(first)
        self.shown = Shown(first, NoModes(""), None)

    @property
    def controls(self) -> Controls:
        """What the sliders say; at locked lengths, the search for a rest begins at the last one."""
        payload = float(self.payload.value)
        if self.given.value == _BY_LENGTHS:
            return Controls(tuple(self._last.in_degrees()), payload, tuple(float(s.value) for s in self.lengths))
        return Controls(tuple(float(slider.value) for slider in self.pose), payload)

    def step(self, now: float) -> None:
        """Answer a change of the sliders; then the picture at an instant [s]."""
        if self._changed:
            self._changed = False
            self._show_state(view_state(self.robot, self.controls))
            state = self.shown.state
            self._show_modes(NoModes("") if isinstance(state, Refusal) else view_modes(state, self.count))
        self._animate(now)

    def run(self) -> NoReturn:
        """Work until the program is interrupted."""
        while True:
            self.step(time.monotonic())
            time.sleep(_PAUSE)

    def _build_panel(self, start: Controls, ranges: Ranges, lengths: np.ndarray) -> None:
        gui = self.server.gui
        gui.configure_theme(control_width="large", show_logo=False, show_share_button=False)
        self.status = gui.add_markdown("")
        self.given = gui.add_dropdown("given by", (_BY_POSE, _BY_LENGTHS), initial_value=_BY_POSE)
        self.pose_folder, self.length_folder = (
            gui.add_folder("Pose"),
            gui.add_folder("Unstrained lengths", visible=False),
        )
        with self.pose_folder:
            self.pose = [
                gui.add_slider(name, low, high, 0.001 if "m]" in name else 0.1, value)
                for name, (low, high), value in zip(_POSE, ranges.pose, start.pose, strict=True)
            ]
        with self.length_folder:
            self.lengths = [
                gui.add_slider(f"cable {i} [m]", low, high, 0.0005, float(value))
                for i, ((low, high), value) in enumerate(zip(ranges.lengths, lengths, strict=True), start=1)
            ]
        self.payload = gui.add_slider("payload [kg]", *ranges.payload, 0.1, start.payload)
        states = () if self.campaign is None else tuple(shown_states(self.campaign))
        self.chosen = gui.add_dropdown("measured state", (_NO_STATE, *states), visible=bool(states))
        self.residuals = gui.add_folder("Measured and predicted", visible=bool(states))
        with self.residuals:
            self.residual_table = gui.add_markdown("Choose a measured state.")
        with gui.add_folder("Cables"):
            self.cable_table = gui.add_markdown("")
        with gui.add_folder("Vibration"):
            self.mode = gui.add_slider("mode (0: rest)", 0, self.count, 1, 0)
            self.amplitude = gui.add_slider(
                "drawn size [m]", 0.0, *(float(f"{share * self._size:.1g}") for share in (0.1, 0.001, 0.03))
            )
            self.mode_table = gui.add_markdown("")
        gui.add_markdown(panel.LEGEND)
        self.given.on_update(self._switch)
        self.chosen.on_update(self._go_to_state)
        for slider in (*self.pose, *self.lengths, self.payload):
            slider.on_update(self._mark)

    def _build_scene(self, first: ViewState | Refusal) -> None:
        scene, size, box = self.server.scene, self._size, first.geometry.box()
        scene.set_up_direction("+z")
        middle = 0.5 * (box[0] + box[1])
        aside = middle + size * np.array([0.12, 0.05, 0.0])  # the panel stands on the right
        self.server.initial_camera.position = tuple(aside + size * np.array([0.4, -0.95, 0.35]))
        self.server.initial_camera.look_at = tuple(aside)
        self.server.initial_camera.fov = np.radians(45.0)
        scene.add_grid(
            "/floor", box[1, 0] - box[0, 0], box[1, 1] - box[0, 1], cell_size=1.0, section_size=5.0,
            position=(middle[0], middle[1], box[0, 2]),
        )  # fmt: skip
        scene.add_frame("/world", axes_length=0.06 * size, axes_radius=0.001 * size)
        feet = self.robot.frame_anchors * [1.0, 1.0, 0.0] + [0.0, 0.0, box[0, 2]]
        posts = np.stack([feet, self.robot.frame_anchors], axis=1)
        scene.add_line_segments("/posts", posts, colours.NONE, thickness=1.0, thickness_units="screen")
        for i, anchor in enumerate(self.robot.frame_anchors, start=1):
            scene.add_icosphere(f"/anchors/{i}", 0.004 * size, color=(40, 40, 40), position=anchor)
            scene.add_label(f"/anchors/{i}/number", str(i))
        self.platform = scene.add_frame("/platform", axes_length=0.04 * size, axes_radius=0.0008 * size)
        body = np.array(self.robot.platform_anchors)
        if len(first.geometry.triangles):
            scene.add_mesh_simple(
                "/platform/body", body, first.geometry.triangles, color=colours.PLATFORM, opacity=0.35, side="double"
            )
        edges = (first.geometry.edges - first.pose.position) @ first.pose.rotation
        scene.add_line_segments("/platform/edges", edges, colours.PLATFORM, thickness=2.0, thickness_units="screen")

    def _mark(self, event: object) -> None:
        self._changed = True

    def _switch(self, event: object) -> None:
        """By pose or by lengths; both begin where the robot is."""
        by_pose = self.given.value == _BY_POSE
        state = self.shown.state
        if isinstance(state, ViewState):
            chosen, values = (self.pose, state.pose.in_degrees()) if by_pose else (self.lengths, state.lengths.tolist())
            for slider, value in zip(chosen, values, strict=True):
                slider.value = float(np.clip(value, slider.min, slider.max))
        self.pose_folder.visible, self.length_folder.visible = by_pose, not by_pose
        self._changed = True

    def _go_to_state(self, event: object) -> None:
        """Sliders at the measured pose and payload of the chosen state."""
        measured = self._measured()
        if measured is not None:
            self.given.value = _BY_POSE
            sliders = zip((*self.pose, self.payload), (*measured.controls.pose, measured.controls.payload), strict=True)
            for slider, value in sliders:
                slider.min, slider.max = min(slider.min, value), max(slider.max, value)
                slider.value = value
        self._changed = True

    def _measured(self) -> MeasuredState | None:
        if self.campaign is None or self.chosen.value == _NO_STATE:
            return None
        return measured_state(self.robot, self.campaign, shown_states(self.campaign)[self.chosen.value])

    def _show_state(self, state: ViewState | Refusal) -> None:
        measured = self._measured()
        self.shown = replace(self.shown, state=state, measured=measured)
        self._last = state.pose
        self.status.content, self.cable_table.content = panel.status(state), panel.cable_table(state)
        self._colours = colours.state_colours(state, len(self.robot.cables))
        if measured is not None:
            self.residual_table.content = panel.residual_table(measured)
            self._colours = colours.residual_colours(measured.in_sigmas)
        wheels = _NOTHING if isinstance(state, Refusal) else segments(state.wheels)
        self._lines("/wheels", wheels, np.array([40, 40, 40]))
        self._draw_arrows(state, measured)

    def _draw_arrows(self, state: ViewState | Refusal, measured: MeasuredState | None) -> None:
        """At the platform ends, along the cables: how much more (towards the frame) or less is measured."""
        known = measured is not None and np.isfinite(measured.tension_residual).any()
        if measured is None or not known:
            self.server.scene.remove_by_name("/residuals")
            return
        points, own = arrows(state.geometry, measured.tension_residual, 0.12 * self._size)
        size = self._size
        self.server.scene.add_arrows(
            "/residuals", points, linear(self._colours[own]), shaft_radius=0.0025 * size,
            head_radius=0.006 * size, head_length=0.012 * size,
        )  # fmt: skip

    def _show_modes(self, modes: ViewModes | NoModes) -> None:
        self.shown = replace(self.shown, modes=modes)
        self.mode_table.content = panel.mode_table(modes)
        self._still = False

    def _animate(self, now: float) -> None:
        """The chosen mode at this instant; a robot at rest is drawn once."""
        state, modes, mode = self.shown.state, self.shown.modes, int(self.mode.value)
        moving = isinstance(modes, ViewModes) and mode > 0
        if not moving and self._still:
            return
        self._still = not moving
        curves = state.geometry.curves if isinstance(state, Refusal) else state.curves
        shift, turn = np.zeros(3), np.zeros(3)
        if isinstance(modes, ViewModes) and mode > 0:
            gain = float(self.amplitude.value) * float(np.sin(2.0 * np.pi * now / _CYCLE))
            curves, shift, turn = modes.displaced(mode - 1, gain)
        self._lines("/cables", segments(curves), np.repeat(self._colours, curves.shape[1] - 1, axis=0)[:, None, :])
        self.platform.position = state.pose.position + shift
        self.platform.wxyz = quaternion(state.pose.rotation, turn)

    def _lines(self, name: str, points: np.ndarray, colour: np.ndarray) -> None:
        if not len(points):
            self.server.scene.remove_by_name(name)
            return
        every = np.broadcast_to(linear(colour), points.shape)
        self.server.scene.add_line_segments(
            name, points.astype(np.float32), every, thickness=3.0, thickness_units="screen"
        )
