"""Generator of the default anatomy: skull, head, eyes, teeth, tongue and their landmarks.

Run ``python -m tools.anatomy`` from the root of the repository.
"""
