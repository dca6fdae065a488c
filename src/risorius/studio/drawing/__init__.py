"""How muscles are shown, listed, drawn and changed: one craft for each method of a face."""

__all__: list[str] = []
