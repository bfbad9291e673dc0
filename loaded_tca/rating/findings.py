"""What a rating says in sentences: which failure and place decide, and what local stresses add to the standard."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.plain import apart, plain
from loaded_tca.rating.lives import COAST, FLANK, ROOT

if TYPE_CHECKING:
    from loaded_tca.rating.rating import OfCases, Rating

FAILURES = {FLANK: "pitting", ROOT: "tooth breakage"}
"""What decides of the flanks that are analysed, and of roots."""
ALL_FAILURES = {**FAILURES, COAST[FLANK]: "pitting of the coast flank"}


def torque_factors(rating: OfCases, mode: str, safeties: Array) -> Array:
    """Safeties against a kind of failure over that required, on the scale of the torque, for all kinds the same.

    The stress of flanks grows with the root of the torque, and that of roots with the torque: of flanks that is
    (S_H/S_Hmin)^2, of roots S_F/S_Fmin. Load factors and lives change with the torque, too, and are held.
    """
    part = safeties / rating.required.required_safety(mode)
    return np.asarray(part ** (1.0 / rating.endurances[mode][0].power))


def _factor_in_words(mode: str, factor: float) -> str:
    """Torque factor with its formula."""
    formula = "(S_F/S_Fmin)" if _kind(mode) == ROOT else "(S_H/S_Hmin)^2"
    return f"torque factor {formula} = {plain(factor)}"


class Worst(NamedTuple):
    """The safety of a rating with the least torque factor: its kind, case and gear by index, and all three numbers."""

    mode: str
    case: int
    gear: int
    safety: float
    required: float
    factor: float

    @property
    def kind(self) -> str:
        """Flank or root."""
        return _kind(self.mode)

    def words(self, rating: Rating) -> str:
        """Gear, failure, torque, and how far the safety is from that required."""
        part = self.safety / self.required - 1.0
        distance = f"{abs(part):.1%} {'above' if part >= 0.0 else 'below'}".replace("%", " %")
        torque = rating.inputs.torque_in_words(float(rating.torque[self.case]))
        failure = f"{FAILURES[self.kind]} of the {GEARS[self.gear]} under {torque}"
        safety, _ = apart([self.safety, self.required], 4)
        return (
            f"{failure}: safety {safety}, {distance} the required {plain(self.required, 6)}, "
            f"{_factor_in_words(self.mode, self.factor)}"
        )


def worst_of(rating: Rating, prefix: str = "") -> Worst:
    """The safety with the least torque factor, of the standard or, with "local_", of the local ones."""
    every = []
    for kind in FAILURES:
        mode = f"{prefix}{kind}"
        if rating.has(name := f"{mode}_safety") and np.isfinite(values := rating.values(name)).any():
            at = case, gear = tuple(int(place) for place in np.unravel_index(np.nanargmin(values), values.shape))
            required, factors = rating.required.required_safety(kind), torque_factors(rating, mode, values)
            every.append(Worst(mode, case, gear, float(values[at]), required, float(factors[at])))
    return min(every, key=lambda worst: worst.factor)


def findings(rating: Rating) -> tuple[str, ...]:
    """Sentences on what decides, and on what the local rating has that the standard does not."""
    if rating.inputs.cases.is_spectrum:
        return tuple(of_all_bins(rating))
    local = worst_of(rating, "local_")
    of_local = f"by local stresses the critical failure is {local.words(rating)}, at {_place(rating, local)}"
    sentences = [
        f"after {rating.standard} the critical failure is {worst_of(rating).words(rating)}",
        of_local,
        _pressures(rating),
    ]
    if rating.has("local_root_safety"):
        sentences.append(_tensions(rating))
    return tuple(sentences)


def of_all_bins(rating: OfCases) -> Iterator[str]:
    """What decides under a spectrum, after the standard and by local stresses, and the bin that does most of it."""
    safeties = rating.safeties_and_lives()[0][0]
    factors = np.stack([torque_factors(rating, mode, safeties[:, n]) for n, mode in enumerate(rating.modes)], axis=-1)
    for words, local in ((f"after {rating.standard}", False), ("by local stresses", True)):
        of = [n for n, mode in enumerate(rating.modes) if mode.startswith("local_") == local]
        part = factors[:, of]
        if not np.isfinite(part).any():
            continue
        gear, place = (int(n) for n in np.unravel_index(np.nanargmin(part), part.shape))
        n = of[place]
        damage = rating.values("damage")[:, gear, n]
        required = rating.required.required_safety(rating.modes[n])
        safety, _ = apart([float(safeties[gear, n]), required], 4)
        sentence = (
            f"{words} the critical failure is {ALL_FAILURES[_kind(rating.modes[n])]} of the {rating.MEMBERS[gear]}: "
            f"safety {safety} in {plain(rating.life_required, 6)} h, required {plain(required, 6)}, "
            f"{_factor_in_words(rating.modes[n], float(factors[gear, n]))}"
        )
        if np.isfinite(damage).all() and damage.sum() > 0.0:
            case = int(damage.argmax())
            torque, most = plain(1e-3 * float(rating.torque[case]), 6), damage[case] / damage.sum()
            sentence += f"; bin {case + 1} ({torque} N m) does {100.0 * most:.0f} % of the damage"
        yield sentence


def _kind(mode: str) -> str:
    """Flank or root of a kind of failure."""
    return mode.removeprefix("local_")


def _place(rating: Rating, worst: Worst) -> str:
    at = worst.case, worst.gear
    if worst.kind == FLANK:
        radius, axial = rating.local_flank_radius[at], rating.local_flank_axial[at]
        if worst.gear and rating.result.scene.rack_radius is not None:
            return f"{plain(radius)} mm above the reference line, axial {axial:z.1f} mm"
        return f"diameter {plain(2.0 * radius)} mm, axial {axial:z.1f} mm"
    angle, axial = np.degrees(rating.local_root_angle[at]), rating.local_root_axial[at]
    return f"tangent angle {angle:.0f} deg, axial {axial:z.1f} mm"


def _pressures(rating: Rating) -> str:
    """The largest local pressure beside sigma_H, with and without the factors that even a contact out."""
    case = int(rating.local_flank_safety.min(axis=1).argmin())
    pressure, standard = float(rating.local_flank_stress[case]), float(rating.sigma_H[case].max())
    if not rating.has("Z_beta"):
        return f"the largest local pressure is {pressure:.0f} MPa, sigma_H is {standard:.0f} MPa"
    uneven = standard / float(rating.Z_eps[case] * rating.Z_beta[case])
    beyond = (
        "above this, since relief, edges and the place of the load on the flank add to it"
        if pressure > uneven
        else "below this"
    )
    return (
        f"the largest local pressure is {pressure:.0f} MPa, sigma_H is {standard:.0f} MPa; without Z_eps and Z_beta, "
        f"which local stresses do not have, sigma_H is {uneven:.0f} MPa, and the local pressure is {beyond}"
    )


def _tensions(rating: Rating) -> str:
    """The local tension beside sigma_F of the gear whose root decides."""
    case, gear = (
        int(place) for place in np.unravel_index(rating.local_root_safety.argmin(), rating.local_root_safety.shape)
    )
    tension, standard = float(rating.local_root_stress[case, gear]), float(rating.sigma_F[case, gear])
    mean = float(rating.local_Y_M[case, gear])
    return (
        f"the local root tension of the {GEARS[gear]} is {tension:.0f} MPa, sigma_F is {standard:.0f} MPa; the "
        f"local stress ratio R = {rating.local_stress_ratio[case, gear]:.2f} lowers the strength by "
        f"{100.0 * (1.0 - mean):.1f} %"
    )
