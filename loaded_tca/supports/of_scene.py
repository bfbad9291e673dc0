"""The supports that a scene asks for."""

from __future__ import annotations

import numpy as np

from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.scene.sections import GearSection
from loaded_tca.supports.support import Support, SupportCompliance


def supports_of(scene: Scene) -> tuple[Support, Support]:
    """Supports of pinion and wheel; that of a gear without a section is rigid."""
    pinion, wheel = (
        _support_of(gear, middle) for gear, middle in zip((scene.pinion, scene.wheel), scene.face_middles, strict=True)
    )
    return pinion, wheel


def support_compliance(scene: Scene, pair: GearPair) -> SupportCompliance | None:
    """What the supports give way under load; None where the scene has none.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
        Of the scene, at rest.
    """
    if not scene.is_supported:
        return None
    return SupportCompliance(pair, supports_of(scene), np.stack([np.eye(3), pair.wheel_axes]))


def _support_of(gear: GearSection, middle: float) -> Support:
    return Support(middle, np.zeros((6, 6)) if gear.support is None else gear.support.matrix)
