"""Exact tangents of solved contacts."""

from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.sensitivity import loaded_states


def torque_rate(shared, bending=None):
    """Of the torque of a shared load over the rotation [N mm/rad]."""
    grids = [LoadedGrid.of(one.tooth_pair.pair, one.loaded) for one in shared.shares]
    return loaded_states([grids], bending).stiffness[0]


def stiffness(loaded):
    """Of the force of one contact over its deflection [N/mm]."""
    (rate,) = loaded_states([[LoadedGrid.of(0, loaded)]]).stiffness
    return rate / (loaded.contact.pinion_lever * loaded.contact.wheel_lever)
