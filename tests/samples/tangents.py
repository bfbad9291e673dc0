"""Exact tangents of solved contacts."""

from loaded_tca.loaded.sensitivity import LoadedGrid, torque_rates


def torque_rate(shared, bending=None):
    """Of the torque of a shared load over the rotation [N mm/rad]."""
    (rate,) = torque_rates([[LoadedGrid.of(one.tooth_pair.pair, one.loaded) for one in shared.shares]], bending)
    return rate


def stiffness(loaded):
    """Of the force of one contact over its deflection [N/mm]."""
    (rate,) = torque_rates([[LoadedGrid.of(0, loaded)]])
    return rate / (loaded.contact.pinion_lever * loaded.contact.wheel_lever)
