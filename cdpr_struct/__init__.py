"""Cable-driven parallel robots: predict deflection and vibration, check the prediction, diagnose measurements."""
