"""How many generations a user needs, by strategy."""
