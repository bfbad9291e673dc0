"""Tables of settings from measured flanks: their corrections, and the deviations before and after them."""

from __future__ import annotations

import math
from typing import Any

from loaded_tca.flank_maps.settings_fit import SettingsFit
from loaded_tca.output.result_files import csv_table
from loaded_tca.units import MICROMETRES, unit_of


def corrections_csv(fit: SettingsFit) -> str:
    """Return a row for each setting: its value, correction and limit in its unit; an empty limit: none."""
    limits = ["" if math.isinf(limit) else limit for limit in fit.limits.tolist()]
    corrected = (fit.settings + fit.corrections).tolist()
    return csv_table(
        {
            "setting": [*fit.keys],
            "unit": [unit_of(key) for key in fit.keys],
            "value": fit.settings.tolist(),
            "correction": fit.corrections.tolist(),
            "standard_deviation": fit.deviation.tolist(),
            "limit": limits,
            "at_limit": fit.at_limit.astype(int).tolist(),
            "corrected": corrected,
        }
    )


def deviations_csv(fit: SettingsFit) -> str:
    """Return a row for each measured point: where it lies, its weight, and its deviation before and after."""
    columns: dict[str, list[object]] = {
        name: []
        for name in (
            "gear",
            "flank",
            "profile_index",
            "lengthwise_index",
            "radius_mm",
            "axial_mm",
            "weight",
            "before_um",
            "after_um",
        )
    }
    for one in fit.flanks:
        rows, count = one.before.shape
        topography = one.measured.topography
        places = [(i + 1, j + 1) for i in range(rows) for j in range(count)]
        parts: list[list[Any]] = [
            [one.measured.gear] * one.before.size,
            [one.measured.flank] * one.before.size,
            [i for i, _ in places],
            [j for _, j in places],
            *(values.ravel().tolist() for values in (topography.radius, topography.axial, one.measured.weights)),
            *((MICROMETRES * values).ravel().tolist() for values in (one.before, one.after)),
        ]
        for column, part in zip(columns.values(), parts, strict=True):
            column.extend(part)
    return csv_table(columns)
