"""Datasets as studies give them, with figures that formulas make: what is shown of them is known."""

import itertools

import numpy as np
import xarray

from loaded_tca.cli import DEMO_SCENE
from loaded_tca.scene import parse_scene

SCENE = parse_scene(DEMO_SCENE.read_text(encoding="utf-8"))
LEAD, TIP = "pinion.modifications.lead_crowning_um", "pinion.modifications.tip_relief_um"
MISALIGNMENT = "mounting.misalignment_um"


def dataset(keys, figures, status=None, torques=(80.0,), sampling="factor"):
    """Keys -> values over the samples, figures -> values over samples and torques."""
    count = len(next(iter(keys.values())))
    status = ["ok"] * count if status is None else status
    ok = np.array([one == "ok" for one in status])[:, None]
    shape = count, len(torques)
    values = {"pinion_torque_Nm": np.broadcast_to(torques, shape), **figures}
    texts = {
        "status": status,
        "reason": ["" if one == "ok" else f"it is {one}" for one in status],
        "warnings": [""] * count,
    }
    return xarray.Dataset(
        {
            **{
                name: (("sample", "torque"), np.where(ok, np.reshape(one, shape), np.nan))
                for name, one in values.items()
            },
            **{name: ("sample", np.array(column)) for name, column in texts.items()},
            "seconds": ("sample", np.ones(count)),
        },
        {key: ("sample", np.array(column), {"sampling": sampling}) for key, column in keys.items()},
        {"scene_toml": SCENE.to_toml(), "kind": "study"},
    )


def grid(status=None, torques=(80.0,), leads=(0.0, 3.0, 6.0), tips=(0.0, 10.0)):
    """Lead crowning x tip relief; the transmission error is least at 3 um and 10 um, the pressure grows with both."""
    lead, tip = (np.array(column) for column in zip(*itertools.product(leads, tips), strict=True))
    factor = np.asarray(torques) / 80.0
    return dataset(
        {LEAD: lead, TIP: tip},
        {
            "transmission_error_span_um": np.multiply.outer(1.0 + (lead - 3.0) ** 2 + (tip - 10.0) ** 2, factor),
            "peak_pressure_MPa": np.multiply.outer(500.0 + 10.0 * lead + tip, factor),
        },
        status,
        torques,
    )


def sampled(count=101, torques=(40.0, 80.0), status=None):
    """Misalignments evenly from -50 to 50 um; the transmission error in um is how far along it stands, per 80 N m."""
    along = np.linspace(0.0, 100.0, count)
    factor = np.asarray(torques) / 80.0
    return dataset(
        {MISALIGNMENT: along - 50.0, "mounting.out_of_plane_deg": 1e-3 * along[::-1]},
        {"transmission_error_span_um": np.multiply.outer(along, factor)},
        status,
        torques,
        "distribution",
    )
