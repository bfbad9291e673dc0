"""What the reduced-TCA dissertation says of Figures 42 to 53, the spiral bevel pair, and whether a computation agrees.

Delta E and Delta H have no sign in the source: both are computed, and a statement holds if it does for one of them; the
numbers say which. ``sign_table`` tells which statements hold together.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from loaded_tca.unloaded import relative_curvature, trace_contact
from validation.bevel.effects import Effect, first_order_error, spiral_curve, spiral_effect, spiral_mounting
from validation.bevel.pairs import SPIRAL, spiral_modifications
from validation.unloaded.mounting_error_pairs import ARCSEC
from validation.unloaded.mounting_error_trends import Trend

Array = NDArray[np.float64]
STEPS = (0.02, 0.04, 0.06, 0.08, 0.1)
"""Delta E and Delta H [modules]."""
FULL = (0.02, 0.08)
"""c1 and c_t of the transmission errors."""
SIGNS = (1.0, -1.0)
CONSTANT = 0.1
"""Change of the pressure over a pitch up to which it is relatively constant."""


@dataclass(frozen=True, eq=False)
class ErrorMap:
    """Delta E (rows) and Delta H (columns) together, contacts of one tooth pair over a pitch.

    Attributes
    ----------
    e, h : (n,) array [mm]
    pressure : (n, n) array [MPa]
        Largest along the path.
    deviation : (n, n) array [mm]
        Mean of R - R_m, against that of the aligned pair.
    """

    e: Array
    h: Array
    pressure: Array
    deviation: Array

    @property
    def ratio(self) -> Array:
        """Pressure over that of the aligned pair."""
        middle = len(self.e) // 2
        return self.pressure / self.pressure[middle, middle]


def error_map(count: int = 11, positions: int = 9) -> ErrorMap:
    """Figure 53: c1 = 0.005, c_t = 0.08, both errors from -0.1 to 0.1."""
    errors = np.linspace(-0.1, 0.1, count)
    found = np.array([[_map_point(e, h, positions) for h in errors] for e in errors])
    aligned = found[count // 2, count // 2, 1]
    return ErrorMap(errors, errors, found[..., 0], found[..., 1] - aligned)


def _map_point(e: float, h: float, positions: int) -> tuple[float, float]:
    pair = SPIRAL.pair(spiral_mounting(e, h), spiral_modifications(0.005, 0.08))
    path = trace_contact(pair, np.linspace(-0.5, 0.5, positions) * pair.pitch, warn=False)
    return float(np.nanmax(SPIRAL.pressures(pair, path))), float(SPIRAL.path_on_pinion(path)[0].mean())


def trends(errors: ErrorMap) -> list[Trend]:
    """Every statement on the spiral pair that a computation can judge."""
    return [
        *_angular(),
        *_path_of_offset(),
        _continuity(),
        *_amplitudes(),
        *_pressure_along_the_path(),
        *_path_of_axial_error(),
        _asymmetry(),
        *_more_crowning(),
        *_map_trends(errors),
    ]


def _angular() -> list[Trend]:
    aligned = spiral_effect(0.002, 0.0)
    tilted = {g: spiral_effect(0.002, 0.0, gamma_deg=g) for g in (0.1, 0.2)}
    up = tilted[0.2].place[1] - aligned.place[1]
    along = tilted[0.2].place[0] - aligned.place[0]
    worst = max(spiral_effect(c1, 0.0, gamma_deg=0.2).peak_to_peak for c1 in (0.002, 0.02))
    constant = first_order_error(SPIRAL, spiral_mounting(gamma_deg=0.2)) * ARCSEC
    pressure = tilted[0.2].pressure
    change = float(pressure.max() / pressure.min() - 1.0)
    return [
        Trend(
            "42",
            "Δγ leaves the path where it is, but for a small move to the tip",
            bool(0.0 < abs(up) < 0.05 and abs(along) < 1e-6),
            f"shaft angle 0.2 deg less: {up:+.3f} mm in height, to the tip of the wheel, the root of the pinion; more: "
            f"the other way; {abs(along):.3f} mm lengthwise",
        ),
        Trend(
            "42",
            "Δγ gives no transmission error, from peak to peak",
            worst < 1e-6,
            f"0.2 deg, c1 = 0.002 and 0.02: {abs(worst):.1f} arcsec, but a constant {constant:.0f}: spherical "
            "involutes stay conjugate about one apex",
        ),
        Trend(
            "43",
            "Δγ = 0.2 deg, c1 = 0.002: the stress stays relatively constant",
            change < CONSTANT,
            f"{pressure.min():.0f} to {pressure.max():.0f} MPa over a pitch ({change:+.0%})",
        ),
    ]


def _places(error: str, c1: float, ct: float, sign: float = 1.0) -> Array:
    """Mean place (R - R_m, height) of the path for each of ``STEPS``: (5, 2)."""
    return np.array([spiral_effect(c1, ct, **{error: sign * step}).place for step in STEPS])


def _path_of_offset() -> list[Trend]:
    moved = {sign: _places("e", *FULL, sign)[:, 0] for sign in SIGNS}
    grows = all(bool((np.diff(np.abs(part)) > 0.0).all()) for part in moved.values())
    listed = ", ".join(f"{value:+.2f}" for value in moved[1.0])
    return [
        Trend(
            "44",
            "ΔE moves the path markedly, a greater ΔE farther",
            grows,
            f"ΔE 0.02 to 0.1, c1 = 0.02: mean R - R_m {listed} mm; -0.1: {moved[-1.0][-1]:+.2f} mm",
        )
    ]


def _continuity() -> Trend:
    smooth = {sign: [step for step in STEPS if spiral_effect(*FULL, e=sign * step).continuous] for sign in SIGNS}
    listed = "; ".join(f"ΔE {'+' if sign > 0 else '-'}: continuous at {part}" for sign, part in smooth.items())
    return Trend(
        "45",
        "ΔE = 0.04 with c1 = 0.02, c_t = 0.08 is continuous, a higher ΔE is not",
        any(part == [0.02, 0.04] for part in smooth.values()),
        listed,
    )


def _amplitudes() -> list[Trend]:
    cases = {"ΔE": {"e": 0.04}, "ΔH": {"h": 0.04}, "both": {"e": 0.04, "h": 0.04}}
    printed = {"ΔE": 920, "ΔH": 820, "both": 1500}
    found, heights, falls = [], {}, {}
    for name, error in cases.items():
        signed = [{key: sign * value for key, value in error.items()} for sign in SIGNS]
        effects = [spiral_effect(*FULL, **one) for one in signed]
        heights[name] = [one.peak_to_peak for one in effects]
        falls[name] = [spiral_curve(*FULL, **one).fall for one in signed]
        constant = abs(first_order_error(SPIRAL, spiral_mounting(**error))) * ARCSEC
        found.append(
            f"{name} (printed {printed[name]}): +{heights[name][0]:.0f}/-{heights[name][1]:.0f} peak to peak, "
            f"+{falls[name][0]:.0f}/-{falls[name][1]:.0f} one curve, {constant:.0f} constant"
        )
    aligned = spiral_curve(*FULL).fall
    return [
        Trend(
            "45, 48, 51",
            "amplitudes at 0.04: 920 arcsec for ΔE, 820 for ΔH, 1500 for both together",
            all(abs(max(heights[name]) / printed[name] - 1.0) < 0.1 for name in cases),
            "; ".join(found) + f" arcsec. Of one tooth pair's whole curve, aligned {aligned:.0f}: the order of the "
            "print, which is no amplitude of the gears",
        ),
        Trend(
            "48",
            "ΔH gives a smaller amplitude than ΔE",
            max(falls["ΔH"]) < max(falls["ΔE"]),
            f"one curve: {max(falls['ΔH']):.0f} below {max(falls['ΔE']):.0f} arcsec (larger sign); peak to peak of the "
            f"gears: {max(heights['ΔH']):.0f} and {max(heights['ΔE']):.0f}",
        ),
        _opposed(heights, falls),
    ]


def _opposed(heights: dict[str, list[float]], falls: dict[str, list[float]]) -> Trend:
    opposite = max(spiral_effect(*FULL, e=s * 0.04, h=-s * 0.04).peak_to_peak for s in SIGNS)
    curve = max(spiral_curve(*FULL, e=s * 0.04, h=-s * 0.04).fall for s in SIGNS)
    single = max(max(heights["ΔE"]), max(heights["ΔH"]))
    return Trend(
        "51",
        "both errors together raise the amplitude",
        opposite > single,
        f"of opposite signs {opposite:.0f} arcsec peak to peak, one curve {curve:.0f}; of equal signs "
        f"{max(heights['both']):.0f} and {max(falls['both']):.0f}: with equal signs their slopes cancel, with opposite "
        "ones they add up",
    )


def _along(one: Effect) -> tuple[float, float, float]:
    """Pressures [MPa] at the top of the path, next to the middle of its height, and at its bottom."""
    order = np.argsort(one.height)
    order = order[np.isfinite(one.pressure[order])]
    height, pressure = one.height[order], one.pressure[order]
    middle = np.abs(height - 0.5 * (height[0] + height[-1])).argmin()
    return float(pressure[-1]), float(pressure[middle]), float(pressure[0])


def closest_fit(errors: dict[str, float]) -> tuple[Array, Array, Array]:
    """Height [mm], relative curvature across the contact [1/mm] and pressure [MPa] along the path of one tooth pair.

    Of the positions of surface contact the lowest, the one of the smallest curvature, and the highest: each (3,).
    """
    pair = SPIRAL.pair(spiral_mounting(**errors), spiral_modifications(0.005, 0.04))
    path = trace_contact(pair, np.linspace(-0.8, 0.8, 33) * pair.pitch, warn=False)
    path = path[np.flatnonzero(path.in_contact & ~path.on_edge)]
    height, pressure = SPIRAL.path_on_pinion(path)[1], SPIRAL.pressures(pair, path)
    across = np.array([relative_curvature(pair, path[i]).across for i in range(len(path))])
    chosen = [height.argmin(), across.argmin(), height.argmax()]
    return height[chosen], across[chosen], pressure[chosen]


def _pressure_along_the_path() -> list[Trend]:
    found = []
    for figure, error, name in (("46", "e", "ΔE"), ("49", "h", "ΔH")):
        parts = {sign: _along(spiral_effect(0.005, 0.04, **{error: sign * 0.08})) for sign in SIGNS}
        listed = "; ".join(
            f"{name} {sign * 0.08:+.2f}: {tip:.0f}, {middle:.0f}, {root:.0f} MPa"
            for sign, (tip, middle, root) in parts.items()
        )
        height, across, pressure = closest_fit({error: 0.08})
        share = (pressure[1] / pressure[[0, 2]]) ** 3
        reason = (
            f"the profiles fit each other best next to the pitch cone: relative curvature {across[2]:.2f} at the top, "
            f"{across[1]:.2f} at {height[1]:+.2f} mm, {across[0]:.2f} 1/mm at the bottom of one tooth pair's whole "
            f"path ({name} +0.08), so that the one load of the source presses least there; highest there needs less "
            f"than {share[1]:.0%} of the load at the top and {share[0]:.0%} at the bottom"
        )
        found.append(
            Trend(
                figure,
                f"{name} = 0.08: the stress is highest between tip and root",
                any(middle > max(tip, root) for tip, middle, root in parts.values()),
                f"top, middle, bottom of the path: {listed}: {reason}",
            )
        )
    return found


@cache
def sign_table(errors: ErrorMap) -> dict[str, dict[tuple[float, float], bool]]:
    """Statements that depend on the signs of (Delta E, Delta H), and with which of them each holds."""
    both = [(e, h) for e in SIGNS for h in SIGNS]
    largest = tuple(np.sign([errors.e, errors.h][k][place]) for k, place in enumerate(_worst(errors)))
    smooth = {s: [step for step in STEPS if spiral_effect(*FULL, e=s * step).continuous] for s in SIGNS}
    aligned = spiral_effect(*FULL).place[1]
    rootwards = {s: spiral_effect(*FULL, h=s * 0.04).place[1] < aligned for s in SIGNS}
    alone = {(key, s): spiral_effect(*FULL, **{key: s * 0.04}).peak_to_peak for key in ("e", "h") for s in SIGNS}
    raised = {
        (e, h): spiral_effect(*FULL, e=e * 0.04, h=h * 0.04).peak_to_peak > max(alone["e", e], alone["h", h])
        for e, h in both
    }
    return {
        "45: continuous up to ΔE = 0.04, not above": {(e, h): smooth[e] == [0.02, 0.04] for e, h in both},
        "47: ΔH moves the path towards the root of the pinion": {(e, h): rootwards[h] for e, h in both},
        "47: ΔH moves the path towards the root of the wheel": {(e, h): not rootwards[h] for e, h in both},
        "51: both together raise the amplitude": raised,
        "53: the stress is highest at ΔE = ΔH = 0.1": {signs: signs == largest for signs in both},
    }


def _worst(errors: ErrorMap) -> tuple[int, int]:
    row, column = np.unravel_index(errors.ratio.argmax(), errors.ratio.shape)
    return int(row), int(column)


def _path_of_axial_error() -> list[Trend]:
    aligned = spiral_effect(*FULL).place
    shifts = {error: _places(error, *FULL) - aligned for error in ("e", "h")}
    below = shifts["h"][1, 1]
    against = _places("h", *FULL, -1.0)[1, 1] - aligned[1]
    return [
        Trend(
            "47",
            "ΔH moves the path towards the root",
            bool(min(below, against) < 0.0),
            f"ΔH +0.04: {below:+.3f} mm, -0.04: {against:+.3f} mm in height against the aligned path",
        ),
        Trend(
            "47",
            "ΔH moves the path less than ΔE",
            bool((np.abs(shifts["h"][:, 0]) < np.abs(shifts["e"][:, 0])).all()),
            f"0.1: {shifts['h'][-1, 0]:+.2f} against {shifts['e'][-1, 0]:+.2f} mm lengthwise",
        ),
    ]


def _asymmetry() -> Trend:
    curves = {name: spiral_curve(*FULL, **error) for name, error in (("aligned", {}), ("ΔH +0.04", {"h": 0.04}))}
    curves["ΔH -0.04"] = spiral_curve(*FULL, h=-0.04)
    listed = "; ".join(f"{name} {one.before:.0f}/{one.after:.0f}" for name, one in curves.items())
    uneven = [max(one.before, one.after) / min(one.before, one.after) for one in curves.values()]
    return Trend(
        "48",
        "the function is asymmetric",
        min(uneven) > 1.1,
        f"fall before/after the top: {listed} arcsec; so it is without any error",
    )


def _more_crowning() -> list[Trend]:
    both = {c1: spiral_effect(c1, 0.08, e=0.04, h=0.04).place[0] for c1 in (0.005, 0.02)}
    raised = []
    for sign in SIGNS:
        low, high = (spiral_effect(c1, 0.08, e=sign * 0.08, h=sign * 0.08) for c1 in (0.005, 0.02))
        raised.append(high.largest_pressure / low.largest_pressure)
    return [
        Trend(
            "50",
            "c1 from 0.005 to 0.02 brings the path nearer to the middle",
            abs(both[0.02]) < abs(both[0.005]),
            f"ΔE = ΔH = 0.04: {both[0.005]:+.2f} and {both[0.02]:+.2f} mm",
        ),
        Trend(
            "52",
            "and raises the stress 1.2 to 1.4 times (ΔE = ΔH = 0.08)",
            all(1.15 < value < 1.45 for value in raised),
            f"{raised[0]:.2f} times (both positive), {raised[1]:.2f} times (both negative)",
        ),
    ]


def _map_trends(errors: ErrorMap) -> list[Trend]:
    middle = len(errors.e) // 2
    offset, axial = np.abs(errors.deviation[:, middle]), np.abs(errors.deviation[middle])
    rises = [np.abs(part - 1.0).max() for part in (errors.ratio[:, middle], errors.ratio[middle])]
    row, column = _worst(errors)
    corners = {(float(errors.e[i]), float(errors.h[j])): float(errors.ratio[i, j]) for i in (0, -1) for j in (0, -1)}
    listed = ", ".join(f"({e:+.1f}, {h:+.1f}) {ratio:.2f}" for (e, h), ratio in corners.items())
    return [
        Trend(
            "53",
            "ΔE has a greater effect than ΔH on the deviation from the middle",
            bool(offset.max() > axial.max()),
            f"alone, at most {offset.max():.2f} and {axial.max():.2f} mm",
        ),
        Trend(
            "53",
            "ΔE has a greater effect than ΔH on the stress",
            bool(rises[0] > rises[1]),
            f"alone, at most {rises[0]:+.0%} and {rises[1]:+.0%}",
        ),
        Trend(
            "53",
            "the stress is highest where both errors are largest",
            {abs(float(errors.e[row])), abs(float(errors.h[column]))} == {float(errors.e[-1])},
            f"highest {errors.ratio.max():.2f} times at ({errors.e[row]:+.2f}, {errors.h[column]:+.2f}); corners "
            f"{listed}",
        ),
    ]
