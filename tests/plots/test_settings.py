"""Pictures of deviations before and after corrections of settings."""

import numpy as np

from loaded_tca import read_scene
from loaded_tca.flank_maps import FlankDeviations, MeasuredFlank, SettingsFit
from loaded_tca.flanks import MeasuredDeviations
from loaded_tca.plots.settings import plot_measured_settings
from loaded_tca.plots.style import note_of


def test_both_maps_of_a_flank_have_one_scale_and_their_numbers():
    scene = read_scene("examples/scenes/duplex_30x20_mended.toml")
    flank = scene.pair().wheel.flank
    rho, z = flank.grid(4, 5)
    before = np.outer(np.linspace(-1.0, 1.0, 4), np.linspace(-1.0, 1.0, 5)) * 0.008
    weights = np.ones_like(before)
    weights[0, 0] = 0.0
    measured = MeasuredFlank("wheel", "convex", MeasuredDeviations(rho, z, before, weights=weights))
    maps = FlankDeviations(measured, flank, before, 0.25 * before)
    one = np.ones(1)
    fit = SettingsFit(scene, ("wheel.machine.radial_mm",), 0.1 * one, one, one, (maps,), one, 1e-3)
    figure = plot_measured_settings(fit)  # rms of 19 points: 8 um times the root of (20/9 5/2 - 1)/19
    left, right, bar = figure.axes
    assert left.get_title() == "wheel, convex flank, as measured: rms 3.92, largest 8 µm"
    assert right.get_title() == "wheel, convex flank, after corrections: rms 0.979, largest 2 µm"
    assert [axes.collections[0].get_clim() for axes in (left, right)] == [(-8.0, 8.0)] * 2
    assert [len(line.get_xdata()) for line in left.lines] == [19, 1]
    assert bar.get_ylabel() == "deviation, positive: more material [µm]"
    assert scene.title in note_of(figure)
