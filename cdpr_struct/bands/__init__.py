"""How far may a prediction be off, and what moves it?"""
