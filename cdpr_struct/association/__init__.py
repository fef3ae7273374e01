"""Which measured peak is which mode of the model, and how surely?"""
