"""Two gears in space: frames, mounting errors, senses of rotation, complete teeth in mesh."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.pairs.bevel import BevelMounting, bevel_pair, face_milled_pair
    from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair, internal_pair
    from loaded_tca.pairs.gear import Gear
    from loaded_tca.pairs.gear_pair import Driving, GearPair, MatingTeeth, Sense, mating_teeth
    from loaded_tca.pairs.mean_point import MeanContact
    from loaded_tca.pairs.rack import rack_pair
    from loaded_tca.pairs.synthesis import local_synthesis, mean_contact
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "BevelMounting",
    "Driving",
    "Gear",
    "GearPair",
    "MatingTeeth",
    "MeanContact",
    "Mounting",
    "Sense",
    "bevel_pair",
    "cylindrical_pair",
    "face_milled_pair",
    "internal_pair",
    "local_synthesis",
    "mating_teeth",
    "mean_contact",
    "rack_pair",
]
