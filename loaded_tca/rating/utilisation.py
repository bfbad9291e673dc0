"""How much of the strength a pressure or a root tension uses, at the safety that is required: below 1 it is met."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError
from loaded_tca.rating.evaluate import strength_of_flanks
from loaded_tca.rating.inputs import inputs_of
from loaded_tca.rating.loads import load_factors
from loaded_tca.rating.roots import local_root_factors

if TYPE_CHECKING:
    from loaded_tca.scene import Scene


@dataclass(frozen=True)
class Utilisation:
    """Utilisation per unit of stress, of a scene under a torque.

    Attributes
    ----------
    flank : float [1/MPa]
        Of the weaker flank, by the pressure: required safety times the root of K_A K_v over sigma_HG.
    roots : (float, float) [1/MPa]
        Of pinion and wheel, by the root tension: required safety times K_A K_v over sigma_FG, with Y_M of
        ``root_stress_ratio`` of the scene.
    """

    flank: float
    roots: tuple[float, float]


def utilisation_of(scene: Scene, torque: float) -> Utilisation:
    """Utilisation per unit of stress under a torque.

    Parameters
    ----------
    scene : Scene
        With strengths, [rating], [operation] and [lubricant].
    torque : float [N mm]

    Raises
    ------
    InputError
        As :meth:`loaded_tca.MeshCycle.rating`, and of load spectra.
    """
    if scene.load.case is not None:
        raise InputError(
            "load.case: a load spectrum; give load.pinion_torque_Nm, under which a design uses its strength"
        )
    one = np.ones(1)
    result: Any = SimpleNamespace(
        scene=scene,
        torque=torque * one,
        path=range(scene.analysis.positions),
        face_load_factor=one,
        transverse_load_factor=one,
    )
    inputs = inputs_of(result)
    factors, _ = load_factors(inputs)
    load, wanted = float((factors["K_A"] * factors["K_v"])[0]), inputs.rating
    flank = wanted.required_flank_safety * load**0.5 / float(np.min(strength_of_flanks(inputs).strength))
    pulsating = np.zeros(1)
    pinion, wheel = (
        wanted.required_root_safety * load / float(local_root_factors(inputs, gear, pulsating, 0)[1].strength[0])
        for gear in range(len(GEARS))
    )
    return Utilisation(flank, (pinion, wheel))
