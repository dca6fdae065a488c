"""The layered anatomical face: muscles in layers on a skull move the skin."""
