"""The whole story in one function: from a scene to the loaded contact over the positions of a pitch."""

from __future__ import annotations

import numpy as np

from loaded_tca.compliance import tooth_compliance
from loaded_tca.compliance.compliance import BORE
from loaded_tca.loaded.cycle import Progress, carried_by_all, carried_by_one
from loaded_tca.loaded.pair_coupling import TeethYield
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.results.collect import mesh_cycle
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.warnings import warn_of_accuracy
from loaded_tca.scene import Scene
from loaded_tca.tooth import tooth_forms


def analyse(scene: Scene, progress: Progress | None = None) -> MeshCycle:
    """Analyse a scene: at every position of a pitch one tooth pair carries the load, or all in contact share it.

    Parameters
    ----------
    scene : Scene
    progress : callable, optional
        Called as ``progress(done, total)`` after every torque and position.

    Returns
    -------
    MeshCycle

    Raises
    ------
    InputError, GeometryError
        If the scene's parts do not fit each other, or the flanks are never in contact.
    ConvergenceError
        If a contact, or the balance of the tooth pairs, is not solved to the tolerance.

    Warns
    -----
    AccuracyWarning
        If the contact reaches an edge of a flank, or the model is at another limit.
    """
    pair, wanted = scene.pair(), scene.analysis
    count = wanted.positions
    angles = np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, count) if count > 1 else np.zeros(1)
    grid = GridChoice(
        cells=None if wanted.cells is None else (wanted.cells[0], wanted.cells[1]),
        accuracy=wanted.accuracy,
        tolerance=wanted.tolerance,
        free_edges=wanted.free_edges,
    )

    def compliance(neighbours: int) -> TeethYield | None:
        """What bends beside the contacts, once it is known how far apart the loaded teeth of a position may be."""
        if wanted.compliance == "contact":
            return None
        backs = scene.pair("negative" if pair.sense > 0 else "positive")
        bores = getattr(scene.pinion, BORE), getattr(scene.wheel, BORE)
        forms = tooth_forms(scene.mesh())
        return tooth_compliance(forms, pair, backs, bore_diameters=bores, neighbours=max(neighbours, 1))

    carry = carried_by_all if wanted.load_sharing else carried_by_one
    carried = carry(pair, angles, np.asarray(scene.torques), grid, compliance, progress)
    warn_of_accuracy(pair, grid, carried, load_sharing=wanted.load_sharing)
    return mesh_cycle(scene, pair, carried)
