"""How probable is a hypothesis? Knows no robot: it is handed residuals, noise, priors. NumPy and SciPy only."""
