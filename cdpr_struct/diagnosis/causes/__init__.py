"""The library of causes: what may be wrong, with parameters, units, priors, and one function each.

| file         | causes                                                                                |
|--------------|---------------------------------------------------------------------------------------|
| cause.py     | what a cause is, and the patterns in which its parameters may occur                   |
| stiffness.py | what gives way: cables, joints, cable behind the pulley, masts, nonlinear and creeping |
| geometry.py  | where things are: anchors, lengths, drums, temperature, pulleys, tracker, level        |
| platform.py  | what hangs on the cables: mass, joints, centre, inertia, forces, hoses                 |
| cables.py    | what a cable is besides stiff: heavy, bending, carrying a sensor                       |
| sensors.py   | what the readings do: gains, biases, friction, slip, internal force                    |
| accelerometers.py | what they do to the size of a vibration                                          |
| handling.py  | what people do to data and models: units, signs, swaps, wrong poses, shortcuts         |
| registry.py  | all of them by name, those that these data kinds can never show included               |
"""
