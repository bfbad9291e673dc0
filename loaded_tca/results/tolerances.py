"""Tolerances of the keys of a scene, and what keys do to the key figures of a result, to first order."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING

from loaded_tca.arrays import GEARS, Array
from loaded_tca.results.figures import FIGURES
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.results.slope_limits import USUAL, usual_tolerance
from loaded_tca.scene.section import values_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from loaded_tca.results.sensitivities import Sensitivities
    from loaded_tca.scene import Scene

OF_THE_TORQUE = 0.01
"""Standard deviation of the torque, as a part of the largest."""
APEX = "pair.apex_offset_mm"
"""Of double helical pairs."""
TWICE = "misalignment_um"
"""Mounting error that adds to another one, which would count twice with it."""


def default_tolerances(scene: Scene, keys: Iterable[str] | None = None) -> dict[str, float]:
    """Return standard deviations that are usual for keys of a scene.

    1 um; 0.01 mm and 0.01 deg, ten times as much where a relief starts or how long it is; of the torque a hundredth of
    the largest.

    Parameters
    ----------
    scene : Scene
    keys : iterable of str, optional
        As of ``scene.with_changes``. Default: all modifications that the gears have, with the starts and lengths of
        reliefs, all mounting errors, of double helical pairs those of half b too and the apex offset, and the torque.
        Of those that add to each other (``mounting.misalignment_um`` to ``mounting.out_of_plane_deg``) only one is
        among them.

    Returns
    -------
    dict of str to float
        In the unit of the key.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> default_tolerances(read_scene("examples/scenes/helical.toml"), ["mounting.in_plane_deg"])
    {'mounting.in_plane_deg': 0.01}
    """
    return {key: _usual(scene, key) for key in (_varied(scene) if keys is None else keys)}


def _varied(scene: Scene) -> list[str]:
    """Modifications that the gears have, mounting errors and the torque."""
    keys = []
    for gear in GEARS:
        for name, value in values_of(getattr(scene, gear)).items():
            of_flanks = "modifications" in name.split(".")
            if of_flanks and isinstance(value, Real) and value and name.rpartition("_")[2] in USUAL:
                keys.append(f"{gear}.{name}")
    errors = values_of(scene.mounting)  # those of half b of a double helical wheel, too
    keys += [
        f"mounting.{name}" for name in errors if isinstance(errors[name], Real) and name.rpartition(".")[2] != TWICE
    ]
    keys += [APEX] if hasattr(scene.geometry, "apex_offset_mm") else []
    return [*keys, TORQUE]


def _usual(scene: Scene, key: str) -> float:
    if key == TORQUE:
        return OF_THE_TORQUE * 1e-3 * max(scene.torques)
    return usual_tolerance(key)


def key_figure_slopes(sensitivities: Sensitivities) -> dict[str, Array]:
    """Return derivatives of key figures with respect to the keys, by the names of ``MeshCycle.key_figures``.

    Parameters
    ----------
    sensitivities : Sensitivities

    Returns
    -------
    dict of str to (torque, key) array
        In the unit at the end of the name per unit of the key; NaN where the figure is not known or nothing is loaded.
        The peak pressure is that of the place which has the highest one, the root tension, where the scene asks for
        it, that of the position.
    """
    with_slopes = {name: figure.slope for name, figure in FIGURES.items() if figure.slope is not None}
    return {
        name: slope.of(sensitivities)
        for name, slope in sorted(with_slopes.items(), key=lambda entry: entry[1].place)
        if sensitivities.result.has_root_stress or not FIGURES[name].is_of_roots
    }
