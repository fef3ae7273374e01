"""What every sensor should read of a robot: measured states, residuals, modes, and their rates."""
