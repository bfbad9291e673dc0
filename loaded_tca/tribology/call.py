"""The call of tribology on a result, and what it warns of."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.tribology.conditions import Lubricant, conditions_of
from loaded_tca.tribology.slices import cylindrical_mesh
from loaded_tca.tribology.tribology import Tribology


@checked
def tribology_of(
    result: CycleNumbers,
    *,
    pinion_speed_rpm: ArrayLike | None = None,
    lubricant: Lubricant | None = None,
    roughness_um: Sequence[float | None] | None = None,
    application_factor: float | None = None,
    dynamic_factor: float | None = None,
    friction: str | float | None = None,
    bulk_temperature_C: float | None = None,
    scuffing_load_stage: float | None = None,
    permissible_film_ratio: float | None = None,
    supply: str | None = None,
    warn: bool = True,
) -> Tribology:
    """Tribology of a result; see :meth:`loaded_tca.MeshCycle.tribology`, whose arguments are these.

    Parameters
    ----------
    result : MeshCycle
    pinion_speed_rpm, lubricant, roughness_um, application_factor, dynamic_factor, friction, bulk_temperature_C,\
 scuffing_load_stage, permissible_film_ratio, supply
        As there.
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    Tribology
    """
    conditions = conditions_of(
        result.scene,
        cylindrical=cylindrical_mesh(result) is not None,
        pinion_speed_rpm=pinion_speed_rpm,
        lubricant=lubricant,
        roughness_um=roughness_um,
        application_factor=application_factor,
        dynamic_factor=dynamic_factor,
        friction=friction,
        bulk_temperature_C=bulk_temperature_C,
        scuffing_load_stage=scuffing_load_stage,
        permissible_film_ratio=permissible_film_ratio,
        supply=supply,
    )
    tribology = Tribology(result, conditions)
    for sentence in tribology.warnings if warn else ():
        give_accuracy_warning(sentence)
    return tribology
