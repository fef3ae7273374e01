"""Cases that others have published, computed by the model and by the finite-element referee."""
