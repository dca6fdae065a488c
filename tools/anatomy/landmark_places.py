"""Where the landmarks lie: places on the left half of the skin and on the bones [mm].

Names are MPEG-4 feature points; sides are the character's. A right-hand name is the mirror
image of its left-hand partner.
"""

from __future__ import annotations

__all__ = ["BONE_PLACES", "EAR_PLACES", "MIRROR_NAMES", "SKIN_PLACES"]

# these become vertices of the free part of the skin
SKIN_PLACES = {
    "2.1": (0, -114, 87),
    "2.10": (0, -102, 96),
    "2.11": (17, -108.5, 88),
    "2.13": (54, -80, 14),
    "5.1": (41, -61, 72),
    "5.3": (44, -27, 77),
    "7.1": (0, -62, -64),
    "9.1": (17.5, -41.5, 95),
    "9.3": (0, -38.5, 112),
    "9.5": (12.5, -48, 95),
    "9.7": (5, 9, 93),
    "9.12": (0, -14, 99),
    "9.13": (9, -16, 93),
    "9.15": (0, -48.5, 98),
    "11.1": (0, 79, 79),
    "11.3": (46, 60, 67),
    "11.4": (0, 114, -12),
    "11.6": (0, 28, -98),
    "condyle_l": (69, -20, 14),
}

# nearest vertices of the auricle
EAR_PLACES = {
    "10.1": (82, 8, -14),
    "10.3": (86, -12, -32),
    "10.5": (73, -49, -2),
    "10.7": (68, -43, 2),
    "10.9": (73, 0, -3),
}

MIRROR_NAMES = {
    "2.4": "2.5", "2.6": "2.7", "2.8": "2.9", "2.11": "2.12", "2.13": "2.14",
    "3.1": "3.2", "3.3": "3.4", "3.5": "3.6", "3.7": "3.12", "3.9": "3.10", "3.11": "3.8",
    "3.13": "3.14", "4.1": "4.2", "4.3": "4.4", "4.5": "4.6", "5.1": "5.2", "5.3": "5.4",
    "6.3": "6.4", "8.3": "8.4", "8.5": "8.6", "8.7": "8.8", "8.10": "8.9", "9.1": "9.2",
    "9.5": "9.4", "9.7": "9.6", "9.13": "9.14", "10.1": "10.2", "10.3": "10.4",
    "10.5": "10.6", "10.7": "10.8", "10.9": "10.10", "11.3": "11.2", "condyle_l": "condyle_r",
}  # fmt: skip

BONE_PLACES = {
    "cranium": {
        "glabella": (0, 12, 91),
        "nasion": (0, 4, 90),
        "rhinion": (0, -20, 96),
        "nasospinale": (0, -48, 90),
        "prosthion": (0, -59, 90),
        "vertex": (0, 108, -12),
        "opisthocranion": (0, 28, -91),
        "orbitale_l": (31, -21, 78),
        "zygion_l": (65, -20, 28),
        "frontomalare_l": (50, 10, 70),
        "porion_l": (60, -20, 0),
    },
    "mandible": {
        "infradentale": (0, -78, 86),
        "pogonion": (0, -101, 88),
        "menton": (0, -109, 82),
        "gonion_l": (49, -80, 12),
        "condyle_l": (48.5, -16, 12.5),
        "coronoid_l": (46, -20, 40),
    },
}
