"""Do the everyday tests notice a small change in the formulas? `docs/mutation_testing.md` has the answers.

python -m benchmarks.mutation map tests/laws tests/convergence ...      which test runs which line (once)
python -m benchmarks.mutation run --seed 1 --each 100                   draw and try mutants; continues when stopped
python -m benchmarks.mutation table --seed 1                            scores by room
"""
