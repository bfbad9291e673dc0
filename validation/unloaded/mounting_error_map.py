"""Two mounting errors together, as Figure 53 of the reduced-TCA dissertation.

In-plane and out-of-plane errors of the helical pair 40/37, 21 x 21 of them at 21 positions each.

Run from the root of the repository: ``python -m validation.unloaded.mounting_error_map``.
"""

import time
from dataclasses import dataclass, fields, replace
from math import radians

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import climb
from loaded_tca.unloaded.search import FirstTouch, first_touch
from validation.page import Page, write_page
from validation.unloaded.mounting_error_pairs import ARCSEC, HELICAL, POSITIONS, ROUNDING

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ErrorMap:
    """Two errors together: peak-to-peak transmission error, shift of the contact, Hertz pressure."""

    in_plane: Array
    out_of_plane: Array
    peak_to_peak: Array
    shift: Array
    pressure: Array
    seconds: float
    searched: int


class _Mountings(GearPair):
    """One pair at many mountings, one per row of points: wheel_origin (n, 3), wheel_axes (n, 3, 3)."""

    def to_wheel(self, point: Array) -> tuple[Array, Array, Array]:
        """Cylindrical coordinates of points (n, ..., 3), each row in its own wheel frame."""
        origin = self.wheel_origin.reshape(len(point), *(1,) * (point.ndim - 2), 3)
        x, y, z = np.moveaxis(np.einsum("n...j,nkj->n...k", point - origin, self.wheel_axes), -1, 0)
        return np.hypot(x, y), np.arctan2(y, x), z

    def wheel_basis(self, theta: Array) -> Array:
        """Basis (n, 3, 3) of each row's wheel at the azimuths (n,)."""
        return cylindrical_basis(theta) @ self.wheel_axes


class _Field(EaseOff):
    """The ease-off of one pair at many mountings."""

    def restricted(self, rows: NDArray[np.int_]) -> EaseOff:
        """The field of some rows."""
        pair = self.pair
        return _Field(replace(pair, wheel_origin=pair.wheel_origin[rows], wheel_axes=pair.wheel_axes[rows]))


def error_map(count: int = 21, largest_deg: float = 0.09) -> ErrorMap:
    """Map over in-plane and out-of-plane errors of the helical pair, crowned 5 um in both directions.

    One tooth pair at 21 positions over two pitches gives the envelope over one. All cases climb together from the
    contacts of the aligned pair; a scan of both flanks tells whether a higher point exists, and where it does the whole
    search is made.
    """
    start = time.perf_counter()
    angles = np.linspace(-1.0, 1.0, count) * radians(largest_deg)
    aligned = _map_pair(Mounting())
    phi1 = np.linspace(-1.0, 1.0, POSITIONS) * aligned.pitch
    mountings = [Mounting(gamma, delta) for gamma in angles for delta in angles]
    frames = [m.place_parallel(float(aligned.wheel_origin[0])) for m in mountings]
    origin, axes = (np.repeat(np.array(parts), POSITIONS, axis=0) for parts in zip(*frames, strict=True))
    values = {entry.name: getattr(aligned, entry.name) for entry in fields(GearPair)}
    field = _Field(_Mountings(**(values | {"wheel_origin": origin, "wheel_axes": axes})))
    peaks = _climbed(field, first_touch(aligned, phi1), np.tile(phi1, len(mountings)))
    heights = peaks[2].reshape(-1, POSITIONS)
    for case in np.flatnonzero(np.isnan(heights).any(axis=1)):
        touch = first_touch(_map_pair(mountings[case]), phi1)
        peaks[:, case * POSITIONS : (case + 1) * POSITIONS] = touch.rho, touch.z, touch.value
    middle = np.arange(len(mountings)) * POSITIONS + POSITIONS // 2
    pressure = _peak_pressures(field.restricted(middle), *peaks[:2, middle])
    shape = (count, count)
    return ErrorMap(
        in_plane=angles,
        out_of_plane=angles,
        peak_to_peak=_peak_to_peak(heights / aligned.base_radii[1] * ARCSEC).reshape(shape),
        shift=peaks[1, middle].reshape(shape),
        pressure=pressure.reshape(shape),
        seconds=time.perf_counter() - start,
        searched=int(np.isnan(heights).any(axis=1).sum()),
    )


def _map_pair(mounting: Mounting) -> GearPair:
    return HELICAL.pair(mounting, lead_crowning=0.005, profile_crowning=0.005)


def _climbed(field: EaseOff, start: FirstTouch, phi1: Array) -> Array:
    """First touches, rows rho, z and height [mm], climbed from those of the aligned pair; NaN where not certified."""
    cases = len(phi1) // POSITIONS
    peaks = climb(field, phi1, np.tile(start.rho, cases), np.tile(start.z, cases))
    rho, z = (np.broadcast_to(part, (len(phi1), *part.shape)) for part in field.pair.pinion.flank.grid(9, 9))
    heights, edges = field.heights(phi1[:, None, None], rho, z)
    scanned = np.where(edges.min(axis=-1) >= 0.0, heights, -np.inf).max(axis=(1, 2))
    certified = peaks.converged & (peaks.value >= scanned - ROUNDING)
    return np.where(certified, np.stack([peaks.rho, peaks.z, peaks.value]), np.nan)


def _peak_to_peak(curves: Array) -> Array:
    """Peak to peak (n,) of the envelope over one pitch of curves (n, POSITIONS) over two, through cubic splines."""
    spline = CubicSpline(np.linspace(-1.0, 1.0, POSITIONS), curves, axis=1)
    phase = np.linspace(0.0, 1.0, 201)
    return np.ptp(np.maximum(spline(phase), spline(phase - 1.0)), axis=1)


def _peak_pressures(field: EaseOff, rho: Array, z: Array) -> Array:
    """Hertz pressure at phi1 = 0 from the Hessian of the ease-off; NaN on a side of the tooth."""
    pair = field.pair
    station = field.station(np.zeros(len(rho)), rho, z)
    jet = pair.wheel.flank.theta(station.wheel_rho, station.wheel_z)
    lever = 1.0 / np.sqrt(jet.rho**2 + 1.0 / station.wheel_rho**2 + jet.z**2)
    metric = station.tangents @ np.swapaxes(station.tangents, -1, -2)
    bend = -field.hessian(station) * (lever / pair.base_radii[1])[:, None, None]
    to_length = np.linalg.inv(np.linalg.cholesky(metric))
    curvatures = np.linalg.eigvalsh(to_length @ bend @ np.swapaxes(to_length, -1, -2))
    _, edges = field.heights(np.zeros(len(rho)), rho, z)
    inside = edges.min(axis=-1) > ROUNDING
    modulus = pair.contact_modulus
    return np.array(
        [
            point_contact(HELICAL.load, tuple(k), modulus).max_pressure if free else np.nan
            for k, free in zip(curvatures, inside, strict=True)
        ]
    )


def draw_map(errors: ErrorMap) -> Figure:
    """Three maps over the two angles; grey where the contact lies on a side of the tooth."""
    figure = Figure(figsize=(13.5, 4.4), layout="constrained")
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    texts = (
        "transmission error, peak to peak [arcsec]",
        "contact at $\\varphi_1$ = 0: z on the pinion [mm]",
        "Hertz pressure at $\\varphi_1$ = 0 [MPa]",
    )
    gamma, delta = np.degrees(errors.in_plane), np.degrees(errors.out_of_plane)
    values = (errors.peak_to_peak, errors.shift, errors.pressure)
    for axes, text, value, colours in zip(panels, texts, values, ("viridis", "cividis", "viridis"), strict=True):
        axes.set_facecolor("0.8")
        mesh = axes.pcolormesh(gamma, delta, np.ma.masked_invalid(value.T), cmap=colours, shading="nearest")
        figure.colorbar(mesh, ax=axes, label=text)
        axes.set_xlabel("in-plane error [deg]")
    lines = panels[1].contour(gamma, delta, errors.shift.T, levels=range(-8, 9, 4), colors="white", linewidths=0.8)
    for label in panels[1].clabel(lines, fmt="%d mm"):
        label.set_path_effects([withStroke(linewidth=2.0, foreground="0.2")])
    panels[0].set_ylabel("out-of-plane error [deg]")
    panels[2].plot([], [], "s", color="0.8", label="contact on the side of the tooth")
    panels[2].legend(loc="upper right", fontsize="small")
    figure.suptitle(
        f"Helical pair 40/37, module 1 mm, lead and profile crowning 5 µm, {HELICAL.load:g} N, unloaded contact"
    )
    return figure


def page() -> Page:
    """Print the time of the map; its picture, for a page that is written by hand."""
    errors = error_map()
    print(f"{errors.shift.size} pairs of errors x {POSITIONS} positions: {errors.seconds:.2f} s")
    print(f"{errors.searched} of them searched anew")
    return Page("unloaded_contact", None, {"mounting_error_map": draw_map(errors)})


if __name__ == "__main__":
    write_page(__doc__, page)
