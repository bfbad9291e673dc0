"""Table of the laws that random scenes obey: what each is for, and how many scenes of a long run it is tried on."""

from collections.abc import Callable
from typing import Any, NamedTuple, cast
from zlib import crc32

import numpy as np

from loaded_tca.scene.double_helical import DoubleHelicalScene
from validation.invariances import (
    BEVEL,
    CYLINDRICAL,
    HALVES,
    RACK,
    Off,
    Subject,
    continuous,
    derivatives_and_differences,
    energy_kept,
    finer_grids,
    gears_exchanged,
    lengths_doubled,
    memory_and_file,
    mirror_across,
    mirror_along,
    moments_on_shafts,
    pitch_later,
    positions_among_others,
    revolution_doubled,
    stiffness_and_rotation,
    torque_balanced,
    torque_in_a_list,
    zeros_as_none,
)
from validation.rack_and_halves import (
    axial_forces_balanced,
    energy_kept_in_both_halves,
    equal_halves,
    halves_close_together,
    halves_in_each_others_place,
    pitch_later_in_both_halves,
    rack_as_wheel,
)


class Invariance(NamedTuple):
    """A law that scenes obey.

    Attributes
    ----------
    check : callable
        Its docstring says how the scene is changed.
    part : float
        Of the scenes of a long run that it is tried on: dear ones on few.
    holds_for : callable
        Subjects that it is for.
    """

    check: Callable[[Subject], Off]
    part: float
    holds_for: Callable[[Subject], bool]

    @property
    def name(self) -> str:
        """That of the function, in words."""
        return self.check.__name__.replace("_", " ")

    def is_tried_on(self, subject: Subject) -> bool:
        """Whether a long run has it for a subject."""
        coin = np.random.default_rng([subject.featured.seed, crc32(self.name.encode())]).random()
        return bool(coin < self.part * (0.5 if subject.featured.family in ("face_milled", "hypoid") else 1.0))


def _every(_: Subject) -> bool:
    return True


def _held(subject: Subject) -> bool:
    """Gears that stand where they are."""
    return not subject.scene.is_supported


def _elastic_and_held(subject: Subject) -> bool:
    return _one_pair(subject) and _held(subject) and not subject.has("pressure cap")


def _one_pair(subject: Subject) -> bool:
    """One pair of gears: two halves have laws of their own (``validation.laws``)."""
    return subject.featured.family not in HALVES


def _at_one_place(subject: Subject) -> bool:
    """A floating gear that stands at the same place under all torques, if there is one."""
    return _one_pair(subject) or not cast("Any", subject.result).notes_of_places()


def _floats_at_one_place(subject: Subject) -> bool:
    """A gear that floats freely, and elastic flanks: each half is analysed under what it carries."""
    scene = subject.scene
    assert isinstance(scene, DoubleHelicalScene)
    return scene.floats_freely and not subject.has("pressure cap")


def _of_halves(subject: Subject) -> bool:
    return subject.featured.family in HALVES


LAWS = (
    Invariance(lengths_doubled, 0.15, _every),
    Invariance(mirror_across, 0.15, _every),
    Invariance(mirror_along, 0.2, lambda subject: subject.featured.family in (*CYLINDRICAL, *RACK)),
    Invariance(
        gears_exchanged, 0.5,
        lambda subject: (
            _held(subject)
            and subject.featured.family in ("spur", "helical", *BEVEL)
            and not subject.has("one pair carries", "blank")
        ),
    ),
    Invariance(pitch_later, 1.0, lambda subject: _one_pair(subject) and not subject.has("one pair carries")),
    Invariance(torque_in_a_list, 0.15, _every),
    Invariance(positions_among_others, 0.15, _every),
    Invariance(zeros_as_none, 0.15, _every),
    Invariance(memory_and_file, 0.2, _at_one_place),
    Invariance(finer_grids, 0.2, _every),
    Invariance(revolution_doubled, 0.5, lambda subject: subject.has("pitch deviations", "runout", "odd tooth")
               and not subject.has("one pair carries")),
    Invariance(torque_balanced, 1.0, lambda subject: _one_pair(subject) and _held(subject)),
    Invariance(energy_kept, 0.3, _elastic_and_held),
    Invariance(
        moments_on_shafts, 1.0,
        lambda subject: not _held(subject) and subject.featured.family in (*CYLINDRICAL, *RACK),
    ),
    Invariance(stiffness_and_rotation, 0.2, lambda subject: not subject.has("pressure cap")),
    Invariance(derivatives_and_differences, 0.2, _at_one_place),
    Invariance(continuous, 0.05, _every),
    Invariance(rack_as_wheel, 0.3, lambda subject: subject.featured.family in RACK
                       and not subject.has("fitted flank")),
    Invariance(equal_halves, 0.3, _of_halves),
    Invariance(halves_in_each_others_place, 0.4, lambda subject: _of_halves(subject)
               and not subject.has("errors of half b")),
    Invariance(pitch_later_in_both_halves, 1.0, _of_halves),
    Invariance(axial_forces_balanced, 1.0, _of_halves),
    Invariance(halves_close_together, 0.3, lambda subject: _of_halves(subject)
               and not subject.has("axis error across the plane", "misalignment", "errors of half b")),
    Invariance(energy_kept_in_both_halves, 0.3, lambda subject: _of_halves(subject) and _floats_at_one_place(subject)),
)  # fmt: skip
"""In this order, by which logs know them."""
