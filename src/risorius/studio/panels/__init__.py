"""The panels beside the viewport, one file each."""

__all__: list[str] = []
