"""All kinds of pictures of results
================================

Every kind, with what one reads from it; ``loaded-tca plot DIR --all`` draws some, those of studies have their own page.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from loaded_tca import analyse, analyse_revolution, plots, read_scene, shaft_lines
from loaded_tca.flank_maps import ease_off_map, fit_settings, read_measured_flank, vh_check
from loaded_tca.results import stress_below
from loaded_tca.stages import analyse_stage, read_stage
from loaded_tca.studies import run_study, vh_study
from loaded_tca.tribology import Lubricant

SCENES, STAGE = Path(__file__).parent / "scenes", Path(__file__).parent / "stages" / "helical_automotive.toml"
COARSE = {"analysis.positions": 7, "analysis.cells": (16, 24), "analysis.accuracy": None}  # seconds, not minutes
FEW = COARSE | {"analysis.positions": 5, "analysis.compliance": "contact", "analysis.free_edges": False}
LEAD, TIP = "pinion.modifications.lead_crowning_um", "wheel.modifications.tip_relief_um"
RELIEF = {TIP: 10.0, "wheel.modifications.tip_relief_start_mm": 179.0, "analysis.torques_Nm": [60.0, 130.0]}
HELICAL = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(COARSE | RELIEF)
BEVEL = read_scene(SCENES / "mesh_cycle_bevel.toml").with_changes(FEW | {"analysis.torques_Nm": [0.8]})
OIL = Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)
CUT, CONVEX = read_scene(SCENES / "duplex_30x20_mended.toml"), read_measured_flank(SCENES / "duplex_wheel_convex.csv")
(V, H), STEPS = BEVEL.vh_keys, (-0.01, 0.0, 0.01)


def main() -> None:
    """Draw those of results, a bevel pair, a revolution, a stage and an oil."""
    result, other = (analyse(HELICAL.with_changes({"analysis.root_stress": True, LEAD: um})) for um in (5.0, 10.0))
    drawn = plots.result_figures(result, more=True) | {"teeth_in_mesh": plots.plot_teeth_in_mesh(HELICAL)}
    drawn["first_look"] = plots.plot_first_look(HELICAL)
    drawn |= {"teeth": plots.plot_teeth(result), "stress_below": plots.plot_stress_below(stress_below(result))}
    drawn |= plots.comparison_figures({"crowning 5 µm": result, "crowning 10 µm": other})
    check = vh_check(lambda v, h: BEVEL.with_changes({V: v, H: h}).pair(), STEPS, STEPS)
    drawn |= {"ease_off": plots.plot_ease_off(ease_off_map(BEVEL.pair())), "vh_check": plots.plot_vh_check(check)}
    drawn["measured_settings"] = plots.plot_measured_settings(fit_settings(CUT, [CONVEX], ["wheel.machine.radial_mm"]))
    drawn["shafts"] = plots.plot_shafts(shaft_lines(read_scene(SCENES / "helical_on_shafts.toml")))
    on = read_scene(SCENES / "helical_on_rolling_bearings.toml").with_changes(FEW | {"analysis.torques_Nm": [40, 130]})
    on_bearings = analyse(on)
    drawn |= {kind: getattr(plots, f"plot_{kind}")(on_bearings) for kind in ("misalignment", "bearing_loads")}
    drawn["face_load_on_supports"] = plots.plot_face_load_on_supports(on_bearings, analyse(on.on_rigid_supports()))
    turn = analyse_revolution(HELICAL.with_changes(FEW | {"revolution.pitches": 8, "pinion.pitch.runout_um": 9.0}))
    drawn |= {name: draw(turn) for name, draw in plots.REVOLUTION_PICTURES.items()}
    drawn |= plots.stage_figures(analyse_stage(read_stage(STAGE).with_changes(FEW)))
    oiled = result.tribology([500.0, 1500.0], OIL, (0.6, 0.6), permissible_film_ratio=0.3)
    drawn |= {name: one for name, one in plots.tribology_figures(oiled).items() if not name.startswith("flank_")}
    drawn["over_flank"] = plots.plot_over_flank(oiled, "film_ratio")
    with TemporaryDirectory() as folder:
        loaded = run_study(vh_study(BEVEL, STEPS, STEPS), out=Path(folder, "vh.nc"), keep_maps=range(9))
        drawn["loaded_vh_check"] = plots.plot_loaded_vh_check(loaded, Path(folder, "vh_maps"))
    for name, figure in drawn.items():
        plots.save_figure(figure, f"{name}.png")


if __name__ == "__main__":
    main()
