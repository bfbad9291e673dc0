"""Which variant of a family a table describes, told by its own keys: modules of other variants are not imported."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from loaded_tca.scene.section import Section, contents

OF_HALVES = frozenset({"double_helical", "gap_mm", "apex_offset_mm", "floating", "axial_stiffness_N_per_um"})
"""Keys of [pair] that double helical pairs alone have."""


def has_halves(table: Mapping[str, Any]) -> bool:
    """Whether the section [pair] has a key of double helical pairs."""
    pair = table.get("pair")
    keys = contents(pair) if isinstance(pair, Section) else pair
    return isinstance(keys, Mapping) and any(keys.get(name) is not None for name in OF_HALVES)


def has_ring(table: Mapping[str, Any]) -> bool:
    """Whether the wheel has a negative number of teeth."""
    teeth = _entry(table, "wheel", "teeth")
    return isinstance(teeth, int | float) and teeth < 0


def has_rack(table: Mapping[str, Any]) -> bool:
    """Whether the wheel is a rack, however that is spelled: the section says how."""
    teeth = _entry(table, "wheel", "teeth")
    return isinstance(teeth, str) and teeth.casefold() == "rack"


def has_blank(table: Mapping[str, Any]) -> bool:
    """Whether the pair has a blank."""
    return _entry(table, "pair", "blank") is not None


def _entry(table: Mapping[str, Any], section: str, name: str) -> Any:
    """What a section of a table, given as a table or made already, says of a name; None: nothing."""
    part = table.get(section)
    return part.get(name) if isinstance(part, Mapping) else getattr(part, name, None)


MODULES: dict[str, tuple[str, dict[str, Callable[[Mapping[str, Any]], bool]]]] = {
    "cylindrical": ("cylindrical", {"double_helical": has_halves, "internal": has_ring, "rack": has_rack}),
    "straight_bevel": ("bevel", {}),
    "spiral_bevel": ("bevel", {}),
    "face_milled": ("face_milled", {"blank_face_milled": has_blank}),
}
"""Type of a gear pair, as files call it, in the order of messages -> the module of its scenes, and those of variants
with what their tables have: the first whose table it is."""
