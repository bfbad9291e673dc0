"""The hypoid pair 13/42 of annex F of ISO 23509 that tests share: its blanks, and gears with synthesised settings."""

import math
from functools import cache

from loaded_tca.flanks import Mismatch, synthesised_gears
from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
from loaded_tca.pairs.bevel import face_milled_pair
from tests.samples.shared import made_once


@cache
def annex_f3_cones():
    return pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, math.radians(50.0), 63.5)


def hypoid_blank(**changes):
    """With a duplex taper, which fits a pinion both of whose flanks are cut at once."""
    values = {"profile_shift": 0.3, "thickness_modification": 0.05, "backlash": 0.2}
    return HypoidBlank((13, 42), annex_f3_cones(), 30.0, 63.5, **(values | changes))


@made_once
def hypoid_gears(hand="left", mismatch=Mismatch(), wheel="generated"):
    return synthesised_gears(hypoid_blank(), hand, mismatch, wheel=wheel, edge_radii=(0.4, 0.5))


def hypoid_pair(hand="left", **options):
    return face_milled_pair(*hypoid_gears(hand), offset=15.0, **options)
