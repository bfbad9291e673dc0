"""Accuracy warnings: where an analysis is at a limit of its model or its grid."""

from __future__ import annotations

import math
import warnings

import numpy as np

from loaded_tca.errors import AccuracyWarning
from loaded_tca.loaded.cycle import Carried
from loaded_tca.loaded.free_edges import oblique_ends
from loaded_tca.loaded.tooth_contact import GridChoice, LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.tooth_cycle import REACH

THICKEST_CONTACT = 0.25
"""Half width of a contact, over the module, above which a tooth is no half-space: it is 1.6 modules thick."""


def warn_of_accuracy(pair: GearPair, grid: GridChoice, carried: Carried, *, load_sharing: bool) -> None:
    """Give one AccuracyWarning, for the caller's caller, for each reason, with the number of pressure maps it concerns and the first.

    Parameters
    ----------
    pair : GearPair
    grid : GridChoice
    carried : Carried
    load_sharing : bool
        Whether the pairs that were looked for depend on how far the load turns the wheel.
    """
    places: dict[str, list[str]] = {}
    solved = 0
    for torque, rows in zip(carried.torque.tolist(), carried.contacts, strict=True):
        for angle, row in zip(carried.path.pinion_angle.tolist(), rows, strict=True):
            for number, loaded in zip(carried.pairs.tolist(), row, strict=True):
                if loaded is not None:
                    solved += 1
                    place = f"{1e-3 * torque:g} N m, pinion angle {math.degrees(angle):.4g} deg, tooth pair {number:+d}"
                    for reason in _reasons(pair, grid, loaded):
                        places.setdefault(reason, []).append(place)
    told = [f"{reason} (at {len(at)} of {solved} pressure maps; the first: {at[0]})" for reason, at in places.items()]
    for torque, rows in zip(carried.torque.tolist(), carried.contacts, strict=True):
        if torque > 0.0 and not any(loaded is not None and loaded.solution.load > 0.0 for row in rows for loaded in row):
            told.append(f"{1e-3 * torque:g} N m is next to no torque, the gaps it closes are rounding: taken for no load")
    deflection = float(np.nanmax(carried.rotation, initial=0.0)) * pair.base_radii[1]
    if load_sharing and deflection > REACH * pair.module:
        told.append(
            f"the deflection under load is up to {deflection:.3g} mm, more than {REACH:g} modules: tooth pairs with a "
            "larger initial separation are not looked for"
        )
    for sentence in told:
        warnings.warn(sentence, AccuracyWarning, stacklevel=3)


def _reasons(pair: GearPair, grid: GridChoice, loaded: LoadedContact) -> list[str]:
    solution = loaded.solution
    found = []
    if loaded.at_edge:
        edge = "the contact reaches an edge of a flank: Hertz does not hold, and pressure there is mesh-dependent"
        found.append(edge + ("" if grid.free_edges else "; the free edge is left out (analysis.free_edges)"))
        oblique = oblique_ends(pair, loaded.contact, loaded.separation) if grid.free_edges else ()
        found += [f"the {end} is oblique to the contact and taken for that of a half-space" for end in oblique]
    if loaded.at_relief_start:
        found.append("the contact lies across the start of a linear relief: its peak pressure is mesh-dependent")
    smooth = not (loaded.at_edge or loaded.at_relief_start)
    if grid.cells is None and smooth and solution.error_estimate.peak_pressure > grid.accuracy:
        found.append(f"the estimated error stays above the accuracy of {grid.accuracy:g}")
    if solution.reaches_border:
        found.append("the contact reaches the box of its grid")
    if solution.load > 0.0 and solution.cells_across[0] < 8:
        found.append("fewer than 8 cells lie across the contact")
    if 0.5 * loaded.extent[0] > THICKEST_CONTACT * pair.module:
        found.append("the contact is so wide that the tooth is no half-space")
    return found
