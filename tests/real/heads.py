"""The real heads; each is read once."""

from __future__ import annotations

import warnings
from functools import cache

from risorius.errors import RisoriusWarning
from risorius.head import Head
from tests.tools import real_data_folder

_FILES = {
    "ict": "ict_facekit/ict_neutral.obj",
    "african_female_young": "makehuman_head/african_female_young.obj",
    "asian_male_old": "makehuman_head/asian_male_old.obj",
    "caucasian_male_young": "makehuman_head/caucasian_male_young.obj",
}

REAL_HEADS = tuple(_FILES)


@cache
def real_head(name: str) -> Head:
    """Return one of `REAL_HEADS`; the test is skipped (or fails) without the data."""
    path = real_data_folder() / _FILES[name]
    with warnings.catch_warnings():
        # Two pairs of the landmark files are exchanged; the reader says so.
        warnings.simplefilter("ignore", RisoriusWarning)
        return Head.load(path, path.with_name("landmarks.json"))
