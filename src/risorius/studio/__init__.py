"""The browser application: design muscles, see the face move, choose, play, export.

It stands above everything but the command line and holds no logic but that of interaction: what
it does is also possible from Python and from the command line.
"""

__all__: list[str] = []
