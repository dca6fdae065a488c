"""How much of the motion of sculpted expressions the layered face can make."""
