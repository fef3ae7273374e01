"""Blind tests: the referee's FEM makes measurements with a hidden effect, `cdpr-struct diagnose` must find it."""
