"""Accuracy warnings: where an analysis is at a limit of its model or its grid."""

from __future__ import annotations

import warnings
from collections import Counter

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
    """Give one AccuracyWarning, for the caller's caller, for each reason, with the number of pressure maps it concerns.

    Parameters
    ----------
    pair : GearPair
    grid : GridChoice
    carried : Carried
    load_sharing : bool
        Whether the pairs that were looked for depend on how far the load turns the wheel.
    """
    solved = [loaded for rows in carried.contacts for row in rows for loaded in row if loaded is not None]
    reasons = Counter(reason for loaded in solved for reason in _reasons(pair, grid, loaded))
    alone = carried.share.shape[0] == carried.share.shape[2] == 1
    what = "positions" if alone else "pressure maps"
    told = [f"{reason} (at {count} of {len(solved)} {what})" for reason, count in reasons.items()]
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
        edge = "the contact reaches an edge of a flank, where the pressure of the map is mesh-dependent"
        found.append(edge + ("" if grid.free_edges else "; the free edge is left out (analysis.free_edges)"))
        oblique = oblique_ends(pair, loaded.contact, loaded.separation) if grid.free_edges else ()
        found += [f"the {end} is oblique to the contact and taken for that of a half-space" for end in oblique]
    if loaded.at_relief_start:
        found.append(
            "the contact lies across the start of a linear relief, where the pressure of the map is mesh-dependent"
        )
    smooth = not (loaded.at_edge or loaded.at_relief_start)
    if grid.cells is None and smooth and solution.error_estimate.peak_pressure > grid.accuracy:
        found.append(f"the estimated error stays above the accuracy of {grid.accuracy:g}")
    if solution.reaches_border:
        found.append("the contact reaches the box")
    if solution.load > 0.0 and solution.cells_across[0] < 8:
        found.append("fewer than 8 cells lie across the contact")
    if 0.5 * loaded.extent[0] > THICKEST_CONTACT * pair.module:
        found.append("the contact is so wide that the tooth is no half-space")
    return found
