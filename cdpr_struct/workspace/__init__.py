"""What a quantity is all over a grid of poses.

| file              | answers                                                        | may import              |
|-------------------|----------------------------------------------------------------|-------------------------|
| grid.py           | which poses?                                                   | numpy                   |
| quantities.py     | what can be mapped, and how is it computed for a batch of poses? | statics, dynamics     |
| sweep.py          | how is a grid worked off in chunks, on any Executor?           | grid, quantities        |
| pose_error_map.py | means and flags of a map of pose errors                        | grid                    |
"""
