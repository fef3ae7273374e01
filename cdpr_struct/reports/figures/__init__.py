"""Every figure of the reports, one module per theme; the only room that knows matplotlib and plotly.

| file                | shows                                                                  |
|---------------------|------------------------------------------------------------------------|
| style.py            | the common look, and deterministic SVG with text as text               |
| drawing.py          | one figure in every form: SVG and PDF for papers, SVG for narrow screens |
| narrow.py           | panels, legends and letters on narrow screens                          |
| mode_stacks.py      | which frequencies sit so close that a plot must stack them             |
| determinant.py      | what the thesis's scan sees of the eigenfrequencies, and what it misses |
| convergence.py      | how fine the FEM mesh must be to judge the model                       |
| mac.py              | which mode of the FEM has the shape of which mode of a model           |
| mode_errors.py      | how far each DSM frequency is from the FEM's                           |
| limits.py           | cable parameters against the printed validity limits                   |
| robot_geometry.py   | points, curves and faces of the robot's picture                        |
| robot_drawing.py    | the robot with its sagging cables                                      |
| footprints.py       | frames of several robots from above                                    |
| single_cable.py     | profile and dynamic stiffness of one cable                             |
| mode_ladder.py      | eigenfrequencies by kind, how close they lie, and the tensions         |
| mode_shapes.py      | the robot in its first modes, at rest and at the end of a swing        |
| plan.py             | what a test plan would confuse, and what to measure next               |
| workspace_map.py    | a quantity over one or two axes of the workspace                       |
| workspace_slices.py | the same over three axes, as slices                                    |
| pose_error.py       | static pose error over the workspace, and over the load                |
| shown.py            | a figure on the screen, in a notebook or a window of its own           |
| interactive.py      | the same data as plotly figures                                        |
| plotly_source.py    | plotly.js itself, as a page carries it                                 |
"""
