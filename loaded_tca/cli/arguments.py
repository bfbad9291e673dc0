"""The command line: what each command takes, and its help."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import NoReturn

from loaded_tca.cli import commands as run_by
from loaded_tca.cli.terminal import flush
from loaded_tca.errors import InputError
from loaded_tca.input_files import is_place, number_in, whole_in

DESCRIPTION = "Loaded tooth contact analysis of gears."
FILES = """files in DIR:
  result.nc                 everything, to be read by loaded_tca.load_result, xarray or 'loaded-tca plot'
  summary.json              the key figures
  positions.csv             one row per torque and position
  contacts.csv              one row per torque, position and tooth pair, only where pairs share the load
{pictures}
Older pictures of these names are removed if the result does not have them; docs/reference/files.md says more.
A scene with pair.double_helical gives double_helical.nc, .json and .csv, half_a.nc and half_b.nc, each the result of a
pair, and halves_*.png; docs/guide/double_helical.md says more."""
TEETH = """files in DIR:
  pinion.vtk, wheel.vtk     the teeth in contact, in the fixed frame; "patch" tells flanks, fillets and lands apart
  pressure.vtk              the cells under pressure on the pinion's flank, in MPa
  pinion.stl, wheel.stl     closed solids, each in its gear's own frame; a rack from its reference line
  teeth.png                 a picture of the teeth with this pressure
All lengths are in mm. Of half a and half b of a double helical pair the surfaces have the true hands, with z = 0 in the
middle of the groove; the picture shows half b as its mirror image, as all pictures of this half."""
COMPARE = """files in DIR:
  comparison.csv            one row per common torque and key figure: values, differences from the first result
  comparison.json           the same numbers, and the keys in which the scenes differ
{pictures}
The pictures show one torque; 'loaded-tca report DIR DIR --out FILE' writes a page with them;
docs/guide/comparing.md says more."""
EASE_OFF = """The command prints the values at the corners, and the angles, crownings and twist of second order.

files in DIR:
  ease_off.csv              the map: radius and axial coordinate, place on the flank, ease-off of every point
  ease_off.png              material that the flank lacks against the conjugate of its mating flank, in um, with the
                            values at the corners of the flank, and its angles, crownings and twist"""
SETTINGS = """SCENE has bevel gears with a section [pair.blank] and the radius of its cutter. FILE is a scene of type
face_milled with the same blanks, and with all machine settings and cutters. The settings are those of closed formulas:
a first design, to be improved by what its contact shows ('loaded-tca run', 'vh', 'ease-off'). Or the settings of the
pinion come from local synthesis, which gives the contact at the mean point that [pair.settings] of a scene of type
face_milled asks for, or a usual one.

With --measured SCENE has face-milled gears, and FILE is the scene with settings that bring the deviations of measured
flanks to zero in least squares, as far as the chosen settings can. The file of a measured flank has the columns of
docs/guide/measured_flank.md, and a column weight. Comments "# gear = wheel" and "# flank = convex" in the file say
which flank it is, or the name of the flank before the file: wheel.convex=FILE. LIMIT is the largest change of a setting
in its unit. Default settings: radial, root angle and ratio of roll of each measured gear; cradle angle instead of the
ratio of roll for a gear that is cut without roll.

files beside FILE (out.toml):
  out_corrections.csv       one row per setting: its correction, standard deviation and limit, in its unit
  out_deviations.csv        one row per measured point: deviation before and after
  out_deviations.png        these deviations over the flanks
docs/guide/measured_settings.md says more."""
MEASURED = """The command shows slopes, crownings and twist, found by least squares over the measured points, their
standard deviations, and the form deviations that remain. It reads points, profile and helix lines as
docs/guide/measured_flank.md says. FILE of --out is the scene with these modifications on the flank by its equations
instead of the measured flank."""
CHECK = """files in DIR:
  first_look.png            teeth in mesh at the pitch point with the path of contact, or both blanks of bevel pairs;
                            modifications along profile and face; the path of contact without load on both flanks
and for stages first_look_sun.png and first_look_ring.png.

--quiet alone only checks: it prints warnings and errors to standard error; with --json it prints the JSON."""
SHAFT = """SCENE has a section [pinion.shaft] or [wheel.shaft]. The whole normal force acts where the unloaded flanks
touch. Axes are those of each gear's own frame, which does not turn with the gear: z is the axis of the gear, x points
to the pitch point, and rotations are right-handed.

files in DIR:
  shaft.csv                 motions along each shaft, one row per torque and place
  bearings.csv              forces and moments on the bearings; for rolling bearings element force, pressure and life
  shaft.png                 outlines of the shafts, their deflection in two planes"""
VH = """V and H are mounting errors: for bevel and face-milled gears the offset and the axial displacement of the pinion
[mm], for cylindrical gears the errors of the axes in their plane and out of it [deg]. The command also shows centre and
size of each pattern, and under load the highest pressure.

files in DIR:
  vh_check.png              contact patterns by a marking compound, V upwards, H to the right
  vh_check.csv              centre of each pattern, its shift and size, part of the pitch with edge contact
and with --loaded instead
  vh_under_load.png         highest pressure at each place of the flank
  vh_study.csv              key figures, one row per pair of errors and torque; the summary has the warnings
  vh_study.nc, vh_study_maps/  the study behind both files; the same command continues it"""
TRIBOLOGY = """[operation], [lubricant], roughness_Ra_um and the thermal keys of materials say how the pair runs; --set
gives or changes these. Numbers that need a missing input are left out, and the summary says which.

files in DIR:
  tribology.nc              everything, to be read by xarray
  tribology.csv             one row per speed and torque
  tribology_slices.csv      every slice of every contact, first speed, all torques
{pictures}
Only the friction of the teeth is counted; docs/guide/efficiency_and_scuffing.md says more."""
RATING = """[pinion.strength], [wheel.strength], [rating], [operation] and [lubricant] of the scene say what the gears
are made of, what is required and how they run; a stage has [sun.strength], [planet.strength] and [ring.strength]. --set
gives or changes these, and the load spectrum: load.spectrum=FILE, with torques up to the largest analysed torque.
Without a load spectrum each torque is rated by itself. Both halves of a double helical pair are rated under their
shares, and have pictures of their own: half_a_safeties.png ...

files in DIR:
  rating.json               safeties, damage, lives and every factor of each torque or bin, and of all bins together
  rating.csv                these numbers, one row per torque or bin
{pictures}
docs/guide/strong_enough.md says more."""
SUBSURFACE = """files in DIR:
  subsurface.nc             six stresses, von Mises and greatest shear, at every depth below every cell of the map
  subsurface.csv            these stresses over the depth, below the highest pressure
  subsurface_max_shear.png, subsurface_von_mises.png
Stresses in MPa, tension positive, of a half-space without friction; docs/guide/stresses_below.md says more."""
SENSITIVITIES = """KEY is a key of the scene, TOLERANCE its standard deviation, in the unit that the key ends in.
Default keys: the modifications that the gears have, with starts and lengths of reliefs, all mounting errors (except
misalignment_um, which adds to out_of_plane_deg), and the torque. Default tolerances: 1 um, 0.01 mm, 0.01 deg;
0.1 mm and 0.1 deg for starts and lengths of reliefs; a hundredth of the largest torque for the torque.

files in DIR:
  sensitivities.nc          derivatives of every position, pair and figure, all torques
  sensitivities.csv         one row per torque and key: what a unit of the key, and its tolerance, change in key figures
  tornado.png               sensitivity times tolerance, a panel for each key figure
  sensitivity_curves.png    what each tolerance changes in the transmission error over the positions
  transmission_error_band.png  transmission error with the standard deviation by all tolerances, all torques
  removal_weights.png       where on the flanks removed material changes the transmission error
Of a double helical pair sensitivities.csv alone, of both halves together; its default keys have the modifications of
half b and the apex offset, too.
All numbers are to first order; docs/guide/tolerances.md says more."""
DYNAMICS = """files:
  FILE                      over the pitch, or all pitches of a whole revolution: transmission error in m and rad, mesh
                            stiffness in N/m and N m/rad, tooth pairs under load, normal force; a row for each torque
                            and mesh phase
  FILE with _orders added   Fourier coefficients of these curves, amplitudes and phases; of a revolution with sidebands
                            and orders of rotation, each named
All in SI units; lines that begin with # say what the columns are, and whether a revolution is periodic. The result of a
pitch must have load sharing. Double helical pairs have tables of their halves."""
STUDY = """files in DIR:
  study.nc                  all figures of all variants, to be read by loaded_tca.studies.load_study or xarray
  study.csv                 these figures, one row per variant and torque: torque_Nm, or, where variants differ in
                            their torques, torque_number from 0
  ranking.csv               one row per variant, the best by --rank-by first
  shortfall.csv             for scenes with strengths: probability of safeties below the required ones
  study_*.png               pictures, depending on what varies
  study.rows.jsonl          the variants that are done; the same command continues from there
  study_maps/N.nc           whole results of the variants asked for by --keep-maps, as of 'loaded-tca run'; of a study
                            that has changed they move to the new numbers of their variants, others to
                            study_maps/others/"""
REPORT = """One HTML file that needs nothing else: what was asked, geometry, load cases, key figures, their accuracy,
pictures, accuracy warnings with what to do, and the scene file; for a stage its phases, shares and orders; for a whole
revolution its largest orders and the deviations of the teeth; for a study what varies, the ranking, best and worst
variant; for a design start and optimum; for two results or more what differs in their scenes, key figures side by side,
and pictures on one scale. It prints on A4. Needs the package jinja2.
With --interactive a page for a browser instead, whose sliders move all pictures, with the teeth in space among them;
for a study parallel coordinates and a scatter plot. The page loads nothing from elsewhere and needs the package plotly,
too."""
REVOLUTION = """files in DIR:
  revolution.nc             everything, to be read by loaded_tca.Revolution.load or xarray
  revolution.json           the key figures: single-flank deviations, orders, worst teeth
  revolution.csv            one row per torque and position
  teeth.csv                 the largest share, force and pressure of every tooth of both gears
  orders.csv                amplitudes of all orders, mesh orders and sidebands named
{pictures}
[pinion.pitch], [wheel.pitch] and [revolution] of the scene say where the teeth stand and which pitches follow each
other; docs/guide/whole_revolutions.md says more. A double helical pair gives double_helical_revolution.nc, .json, .csv,
double_helical_orders.csv, half_a_revolution.nc and half_b_revolution.nc, and halves_revolution_*.png."""
STAGE = """files in DIR:
  stage.nc, sun_mesh.nc, ring_mesh.nc
                            everything, to be read by loaded_tca.stages.StageResult.load; the meshes are results as
                            of 'loaded-tca run', for 'loaded-tca plot' and the other commands
  stage.json                phases, key figures and orders
  stage.csv                 one row per torque and position
{pictures}
and, with [rating] and its inputs, the files of 'loaded-tca rating'.
Numbers have their units in their names; docs/guide/planetary_stages.md says more."""
IMPORT = """MODEL is a REXS file of version 1.0 to 1.7: XML (.rexs), JSON (.rexsj) or zip (.rexsz). FILE is a scene of
the cylindrical stage: flanks, tools, modifications, materials, shafts, bearings, and the loads of other stages on the
same shafts. What was not taken over is listed above the scene and is shown, with the ids
of its components; docs/guide/gearbox_models.md says more."""
EXPORT = """FILE is the model with the load distribution over the face, K_Hbeta, the mesh stiffness (version 1.5 on),
deflection and torsion of the shafts and forces on their bearings; the rest of the model and its format stay."""
EXAMPLE = "Start with 'loaded-tca demo': it writes a scene file to change and to run again."
EXIT_CODES = {
    0: "done",
    1: "a fault of the program, or of processes that were to compute for it",
    2: "the input, or the place for the output, cannot be used",
    3: "no convergence",
    130: "interrupted",
}
"""Exit code of every command -> what it says."""
KEYS = """Of several sections with the same keys one section is shown, with the names of the other sections. The command
looks for WORD in names and meanings, capitals or not. WORD may also be the name that standards and other programs give
a key, such as beta or da; docs/reference/scene_keys.md says more."""


BESIDE = "beside the result; with options that choose a part of the result, in a directory named after the options"
"""Where the files of what is made of a result go by default."""
Command = Callable[..., argparse.ArgumentParser]
"""Adds a command of a name, a function to run, a text, and a text below its options."""


def command_line() -> argparse.ArgumentParser:
    """Return the parser of the command line; its namespace has the ``command`` to call with it."""
    common = _Parser(add_help=False)
    common.add_argument("--traceback", action="store_true", default=argparse.SUPPRESS, help="show where an error arose")
    text = "show no overview and no progress; errors and warnings still go to standard error"
    common.add_argument("--quiet", action="store_true", default=argparse.SUPPRESS, help=text)
    layout = argparse.RawDescriptionHelpFormatter
    epilog = f"{EXAMPLE}\n\nexit codes:\n{described_exit_codes()}"
    parser = _Parser("loaded-tca", description=DESCRIPTION, epilog=epilog, formatter_class=layout, parents=[common])
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    text = "show a script that completes commands and options in a shell, and exit; needs the package shtab"
    parser.add_argument("--print-completion", action=_Completion, choices=SHELLS, help=text)
    commands = parser.add_subparsers(metavar="COMMAND", required=True)

    def command(
        name: str, run: Callable[[argparse.Namespace], None], text: str, epilog: str | None = FILES
    ) -> argparse.ArgumentParser:
        added = commands.add_parser(
            name, help=text, description=text, epilog=epilog, formatter_class=layout, parents=[common]
        )
        added.set_defaults(command=run)
        return added

    _add_analyses(command)
    _add_readers(command)
    _add_tribology(command)
    _add_rating(command)
    _add_comparisons(command)
    _add_tables_and_maps(command)
    _add_studies(command)
    _add_exchange(command)
    text = "read a scene or a stage and show its geometry, without computing a contact"
    check = command("check", run_by.check, text, CHECK)
    check.add_argument("scene", metavar="FILE.toml", help="scene file, or stage file")
    check.add_argument("--out", metavar="DIR", type=_path, help="directory for the picture; default: none is drawn")
    check.add_argument("--json", action="store_true", help="show the table as JSON: names end in units")
    _add_changes(check)
    text = (
        "show the keys of scene and stage files with units, defaults and meanings; with WORD only the keys that have it"
    )
    command("keys", run_by.keys, text, KEYS).add_argument("word", metavar="WORD", nargs="?", help="default: all keys")
    return parser


def described_exit_codes() -> str:
    """Return a line for each exit code."""
    return "\n".join(f"  {code:<4} {meaning}" for code, meaning in EXIT_CODES.items())


def _add_analyses(command: Command) -> None:
    """Add the commands that analyse a scene."""
    demo = command("demo", run_by.demo, "analyse a helical pair; writes its scene file too")
    place = run_by.DEMO_DIRECTORY
    demo.add_argument("--out", metavar="DIR", type=_path, default=place, help=f"default: ./{place}")
    run = command("run", run_by.run, "analyse a scene; writes result.nc, summary.json, positions.csv and pictures")
    _add_scene(run)
    run.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the results")
    beside = run.add_mutually_exclusive_group()
    text = "analyse the coast side too, and compare: directories drive and coast in DIR, comparison.* beside them"
    beside.add_argument("--coast", action="store_true", help=text)
    text = "for gears on supports: analyse them held rigid, too, and compare: directories supports and rigid in DIR"
    beside.add_argument("--rigid", action="store_true", help=text)
    text = "analyse a whole revolution, each tooth at its own place"
    revolution = command("revolution", run_by.revolution, text, REVOLUTION)
    _add_scene(revolution)
    revolution.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the results")
    stage = command("stage", run_by.stage, "analyse a planetary stage: how its planets share the torque", STAGE)
    stage.add_argument("scene", metavar="STAGE.toml", help="stage file")
    _add_changes(stage)
    stage.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the results")
    text = (
        "parts of the work done at once, at most one per core; default: LOADED_TCA_JOBS, or one per core; any N gives "
        "the same results"
    )
    for analysis in (demo, run, revolution, stage):
        analysis.add_argument("--jobs", metavar="N", type=_jobs, help=text)


def _add_readers(command: Command) -> None:
    """Add the commands that show one result again."""
    peak = "default: where the summary has its peak pressure"
    plot = command("plot", run_by.plot, "draw the pictures of a result again")
    text = "write the complete teeth of a result as surfaces (VTK, STL) and as a picture"
    tooth = command("tooth", run_by.tooth, text, TEETH)
    below = command("subsurface", run_by.subsurface, "show the stresses below a pressure map of a result", SUBSURFACE)
    for reader, of_torque, of_position in (
        (plot, "pinion torque of maps and flanks", "pressure_map.png"),
        (tooth, "pinion torque of the pressure", "the teeth"),
        (below, "pinion torque", "the pressure map"),
    ):
        reader.add_argument("result", metavar="DIR|FILE", type=_path, help="result.nc, or the directory that holds it")
        reader.add_argument("--out", metavar="DIR", type=_path, help=f"directory for the files; default: {BESIDE}")
        reader.add_argument("--torque", metavar="NM", type=_float, help=f"{of_torque}; default: largest")
        reader.add_argument("--position", metavar="N", type=_int, help=f"position of {of_position}, from 1; {peak}")
    plot.add_argument("--pdf", action="store_true", help="write at_a_glance.pdf too, a sheet of A4")
    plot.add_argument("--all", action="store_true", help="draw contact_patterns.png and full_mesh.png too")
    tooth.add_argument(
        "--fillet-radius", metavar="MM", type=_float, help="radius of arcs at the root; default: by the module"
    )
    tooth.add_argument("--whole-gears", action="store_true", help="write all teeth to the STL files, not one tooth")
    below.add_argument("--pair", metavar="K", type=_int, help=f"tooth pair, as load_share.png counts; {peak}")
    below.add_argument(
        "--gear", choices=("pinion", "wheel"), default="pinion", help="gear below whose flank; default: pinion"
    )


def _add_tribology(command: Command) -> None:
    """Add the command that reads tribology off a result."""
    text = "show loss, temperatures, films, scuffing and micropitting of a result at one speed or several"
    reader = command("tribology", run_by.tribology, text, TRIBOLOGY)
    reader.add_argument("result", metavar="DIR|FILE", type=_path, help="result.nc, or the directory that holds it")
    text = "speeds of the pinion; default: operation.pinion_speed_rpm of the scene"
    reader.add_argument("--speed", metavar="RPM", nargs="+", type=_float, help=text)
    text = "another value of a key, for instance lubricant.oil_temperature_C=90; may be given again for other keys"
    reader.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], type=_change, help=text)
    reader.add_argument("--out", metavar="DIR", type=_path, help="directory for the files; default: beside the result")


COAST = "result of the coast side, whose flanks carry reversed bins; 'run --coast' writes it to DIR/coast"


def _add_rating(command: Command) -> None:
    """Add the command that rates a result."""
    text = "show safeties and lives of flanks and roots of a result, after ISO 6336 or 10300 and by its local stresses"
    reader = command("rating", run_by.rating, text, RATING)
    text = "result.nc, stage.nc of a stage or double_helical.nc, or the directory that holds it"
    reader.add_argument("result", metavar="DIR|FILE", type=_path, help=text)
    reader.add_argument("--coast", metavar="DIR|FILE", type=_path, help=COAST)
    text = "another value of a key, for instance rating.life_hours=5000; may be given again for other keys"
    reader.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], type=_change, help=text)
    reader.add_argument("--out", metavar="DIR", type=_path, help="directory for the files; default: beside the result")


def _add_comparisons(command: Command) -> None:
    """Add the commands that show what changes."""
    compare = command("compare", run_by.compare, "show how two or more results differ", COMPARE)
    compare.add_argument(
        "results", metavar="DIR|FILE", nargs="+", type=_path, help="results; the others are compared with the first"
    )
    compare.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the files")
    compare.add_argument(
        "--names", metavar="NAME", nargs="+", help="names of the results; default: from their directories"
    )
    compare.add_argument("--torque", metavar="NM", type=_float, help="pinion torque of the pictures; default: largest")
    compare.add_argument(
        "--position",
        metavar="N",
        type=_int,
        help="position of the maps, from 1 in the first result; default: where each result has its peak pressure",
    )
    slopes = command(
        "sensitivities",
        run_by.sensitivities,
        "show what keys of the scene and their tolerances change in a result",
        SENSITIVITIES,
    )
    slopes.add_argument("result", metavar="DIR|FILE", type=_path, help="result.nc, or the directory that holds it")
    text = "keys with their tolerances, for instance mounting.axial_offset_mm=0.05"
    tolerance = _key_with("tolerance", "mounting.axial_offset_mm=0.05")
    slopes.add_argument("--keys", metavar="KEY[=TOLERANCE]", nargs="+", type=tolerance, help=text)
    slopes.add_argument("--out", metavar="DIR", type=_path, help=f"directory for the files; default: {BESIDE}")
    slopes.add_argument(
        "--torque", metavar="NM", type=_float, help="pinion torque shown; default: largest, in bands all"
    )


def _add_tables_and_maps(command: Command) -> None:
    """Add the tables for gear dynamics and the ease-off."""
    dynamics = command("dynamics", run_by.dynamics, "write tables that programs of gear dynamics read", DYNAMICS)
    text = "result.nc, revolution.nc, or the directory that holds one"
    dynamics.add_argument("result", metavar="DIR|FILE", type=_path, help=text)
    dynamics.add_argument(
        "--out", metavar="FILE", type=_path, help="first table; default: dynamics.csv beside the result"
    )
    ease_off = command("ease-off", run_by.ease_off, "draw the ease-off of a scene, without load", EASE_OFF)
    _add_scene(ease_off)
    ease_off.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the picture")
    cut = command(
        "settings", run_by.settings, "write machine settings of a bevel blank, or from measured flanks", SETTINGS
    )
    _add_scene(cut)
    cut.add_argument("--out", metavar="FILE", required=True, type=_path, help="scene file to write")
    methods = "duplex_spread_blade", "spread_blade", "local_synthesis"
    text = f"how both gears are cut; default: pair.settings.method of the scene, else {methods[0]}"
    cut.add_argument("--method", choices=methods, help=text)
    text = "measured flank whose deviations the settings are to bring to zero; may be given again for other flanks"
    cut.add_argument("--measured", metavar="[GEAR.FLANK=]FILE", action="append", type=_measured, help=text)
    text = "with --measured: settings that may change, as wheel.machine.radial_mm=0.1"
    limit = _key_with("limit", "wheel.machine.radial_mm=0.1")
    cut.add_argument("--settings", metavar="KEY[=LIMIT]", nargs="+", type=limit, help=text)
    text = "with --measured: each flank may turn about the axis of its gear (default), or the tooth with both flanks"
    cut.add_argument("--turned", choices=("flank", "tooth"), help=text)
    text = "with --measured: write the scene whose settings cut the flanks as they were measured"
    cut.add_argument("--as-cut", action="store_true", help=text)
    _add_measured(command)
    shaft = command("shaft", run_by.shaft, "show how the shafts of a scene bend, without contact", SHAFT)
    _add_scene(shaft)
    shaft.add_argument("--out", metavar="DIR", type=_path, help="directory for the files; default: none is written")
    vh = command("vh", run_by.vh, "draw contact patterns over two mounting errors (V-H check)", VH)
    _add_scene(vh)
    vh.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the files")
    for name, what in (("v", "V, upwards"), ("h", "H, to the right")):
        text = (
            f"values of {what}; default: 0, and 0.01 modules to both sides (angles: 0.01 modules over the face width)"
        )
        vh.add_argument(f"--{name}", metavar=name.upper(), nargs="+", type=_float, help=text)
    for reader in (ease_off, vh):
        reader.add_argument(
            "--gear", choices=("pinion", "wheel"), default="pinion", help="gear whose flank is drawn; default: pinion"
        )
    vh.add_argument(
        "--loaded",
        action="store_true",
        help="analyse under the torques of the scene, with all that its [analysis] asks for",
    )
    _add_engine(vh)


def _add_measured(command: Command) -> None:
    """Add the modifications of a measured flank."""
    text = "show the modifications of a measured flank, beside those of its scene"
    reader = command("measured", run_by.measured, text, MEASURED)
    _add_scene(reader)
    text = "measured flank; default: that of [pinion.flank] or [wheel.flank]"
    reader.add_argument("--file", metavar="FILE", type=_path, help=text)
    text = (
        "gear of the flank; default: from the comment '# gear = wheel' of the file, or the gear measured in the scene"
    )
    reader.add_argument("--gear", choices=("pinion", "wheel"), help=text)
    text = "flank from which deviations count: the one with the modifications of the scene (default), or without them"
    kinds = "modified", "unmodified"
    reader.add_argument("--from", dest="measured_from", choices=kinds, default=kinds[0], help=text)
    reader.add_argument("--out", metavar="FILE", type=_path, help="scene with these modifications; default: none")


def _add_exchange(command: Command) -> None:
    """Add the commands that read and write models of other programs."""
    text = "write a stage of a gearbox model (REXS) as a scene; without --stage, show its stages"
    reader = command("import", run_by.import_model, text, IMPORT)
    reader.add_argument("model", metavar="MODEL", type=_path, help="REXS file")
    reader.add_argument("--stage", metavar="ID", help="id of the stage")
    reader.add_argument("--out", metavar="FILE", type=_path, help="scene file to write; default: it is shown")
    reader.add_argument("--load-case", metavar="ID", help="load case that gives torques and speeds; default: none")
    text = "torque on the pinion, instead of the torque that the loads on the shafts give"
    reader.add_argument("--torque", metavar="NM", type=_torque, help=text)
    writer = command("export", run_by.export_model, "write a gearbox model (REXS) with the numbers of a result", EXPORT)
    writer.add_argument("result", metavar="DIR|FILE", type=_path, help="result.nc, or the directory that holds it")
    writer.add_argument("--model", metavar="MODEL", required=True, type=_path, help="REXS file that the scene is from")
    writer.add_argument("--stage", metavar="ID", required=True, help="id of the stage")
    writer.add_argument("--out", metavar="FILE", required=True, type=_path, help="REXS file to write")
    writer.add_argument("--torque", metavar="NM", type=_float, help="pinion torque of the numbers; default: largest")


def _add_studies(command: Command) -> None:
    """Add studies and reports."""
    study = command(
        "study", run_by.study, "analyse the variants of a study file; run again, it goes on where it stopped", STUDY
    )
    study.add_argument("study", metavar="STUDY.toml", help="study file")
    study.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the results")
    _add_engine(study)
    study.add_argument(
        "--rank-by",
        metavar="FIGURE",
        help="figure of study.csv that ranks the variants, best first; default: peak-to-peak transmission error",
    )
    axes = "two keys with given values, for heat maps to the right and upwards; default: the first two"
    study.add_argument("--axes", metavar="KEY", nargs=2, help=axes)
    study.add_argument(
        "--keep-maps",
        metavar="N,N,...",
        type=_numbers,
        default=(),
        help="numbers of the variants, from 0, whose whole results are kept",
    )
    text = "write a report of a result, a revolution, several results, a stage, a study or a design as HTML"
    report = command("report", run_by.report, text, REPORT)
    text = "result.nc, revolution.nc, stage.nc, double_helical.nc, double_helical_revolution.nc, study.nc, the file of "
    text += "a design, or the directory that holds one"
    report.add_argument("result", metavar="DIR|FILE", type=_path, help=text)
    text = "results to compare with the first one, as 'loaded-tca compare' takes them"
    report.add_argument("others", metavar="DIR|FILE", nargs="*", type=_path, help=text)
    report.add_argument(
        "--out", metavar="FILE", type=_path, help="HTML file; default for one result: report.html beside it"
    )
    text = "for a result or a study: write a page with sliders for a browser; default of --out: interactive.html"
    report.add_argument("--interactive", action="store_true", help=text)
    text = "names of several results; default: from their directories"
    report.add_argument("--names", metavar="NAME", nargs="+", help=text)
    text = "for several results: pinion torque of the pictures; default: largest"
    report.add_argument("--torque", metavar="NM", type=_float, help=text)
    text = f"for a result with a load spectrum: {COAST}; the report then rates both sides"
    report.add_argument("--coast", metavar="DIR|FILE", type=_path, help=text)
    report.add_argument(
        "--rank-by",
        metavar="FIGURE",
        help="for a study: figure that ranks the variants, best first; default: peak-to-peak transmission error",
    )
    report.add_argument("--axes", metavar="KEY", nargs=2, help=f"for a study: {axes}")


def _add_engine(parser: argparse.ArgumentParser) -> None:
    """Add who analyses the variants of a study."""
    engine = parser.add_mutually_exclusive_group()
    engine.add_argument(
        "--workers", metavar="N", type=_int, help="processes on this machine; default: this process alone"
    )
    engine.add_argument("--scheduler", metavar="ADDRESS", help="address of a Dask cluster, such as tcp://host:8786")


class _Parser(argparse.ArgumentParser):
    """Tells a wrong command line, and help that cannot be shown, as any other bad input.

    What pictures a result has is looked up only when help is asked for.
    """

    def format_help(self) -> str:
        if self.epilog is not None and self.epilog in PICTURES_IN:
            self.epilog = self.epilog.format(pictures=_list_of_pictures(PICTURES_IN[self.epilog]))
        return super().format_help()

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; see '{self.prog} --help'")

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        flush()
        super().exit(status, message)


PICTURES_IN: dict[str, dict[str, str]] = {
    FILES: {
        "ALWAYS": "",
        "SHARED": "and where tooth pairs share the load",
        "ROOTS": "and with analysis.root_stress = true",
        "ON_SUPPORTS": "and with sections for shafts or supports",
        "ON_REQUEST": "and, only with 'plot --all'",
    },
    COMPARE: {"COMPARISON_PICTURES": ""},
    TRIBOLOGY: {"TRIBOLOGY_PICTURES": ""},
    RATING: {"RATING_PICTURES": ""},
    REVOLUTION: {"REVOLUTION_PICTURES": ""},
    STAGE: {"STAGE_PICTURES": ""},
}
"""Help -> names of the declarations of its pictures in ``loaded_tca.plots``, with the line before each."""


def _list_of_pictures(groups: Mapping[str, str]) -> str:
    """The files of all pictures with what they show."""
    import loaded_tca.plots

    lines = []
    for group, head in groups.items():
        lines += [head] if head else []
        lines += [f"  {name + '.png':<24}  {one.line}" for name, one in getattr(loaded_tca.plots, group).items()]
    return "\n".join(lines)


class _Version(argparse.Action):
    """Looks the version up only when asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        print(f"loaded-tca {version('loaded_tca')}")
        parser.exit()


SHELLS = "bash", "zsh"
"""Whose completion is written."""


class _Completion(argparse.Action):
    """Shows the script by which a shell completes the command; values that name files are completed as such."""

    def __call__(self, parser: argparse.ArgumentParser, _: object, shell: object, *__: object) -> None:
        try:
            import shtab
        except ModuleNotFoundError:
            raise InputError("--print-completion: needs the package shtab; 'pip install shtab' gets it") from None

        for each in (parser, *_commands_of(parser)):
            for action in each._actions:
                if action.type is _path or action.dest in ("scene", "study"):
                    action.complete = shtab.FILE  # type: ignore[attr-defined]
        print(shtab.complete(parser, shell=str(shell)))
        parser.exit()


def _commands_of(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    """The parsers of all commands."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield from action.choices.values()


def _path(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty; '.' means the current directory")
    return Path(text)


def _float(text: str) -> float:
    try:
        return number_in(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r:.60}: allowed a number") from None


def _int(text: str) -> int:
    try:
        return whole_in(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r:.60}: allowed a whole number") from None


def _jobs(text: str) -> int:
    if (count := _int(text)) < 1:
        raise argparse.ArgumentTypeError(f"{text!r:.60}: allowed a whole number from 1")
    return count


def _torque(text: str) -> float:
    try:
        torque = number_in(text)
    except ValueError:
        torque = math.nan
    if not 0.0 < torque < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r:.60}: allowed a torque above 0 in N m")
    return torque


def _numbers(text: str) -> tuple[int, ...]:
    if not all(is_place(part) for part in text.split(",")):
        raise argparse.ArgumentTypeError(f"{text}: allowed whole numbers with commas between them, as 0,12")
    return tuple(map(int, text.split(",")))


def _key_with(size: str, example: str) -> Callable[[str], tuple[str, float | None]]:
    """Reader of a key, and of a size above 0 behind it if that is given; the size is named as messages call it."""

    def read(text: str) -> tuple[str, float | None]:
        key, equals, value = (part.strip() for part in text.partition("="))
        try:
            number = number_in(value) if equals else None
        except ValueError:
            number = math.nan
        if not key or not (number is None or 0.0 < number < math.inf):
            allowed = f"KEY or KEY={size.upper()}, the {size} a number above 0, as {example}"
            raise argparse.ArgumentTypeError(f"{text!r:.60}: allowed {allowed}")
        return key, number

    return read


def _measured(text: str) -> tuple[str | None, str | None, Path]:
    """Gear and flank of a measured flank, where they are given, and its file."""
    names = [f"{gear}.{flank}" for gear in ("pinion", "wheel") for flank in ("concave", "convex")]
    place, _, file = text.partition("=")
    if place not in names:
        return None, None, _path(text)
    gear, flank = place.split(".")
    return gear, flank, _path(file)


def _add_scene(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE.toml", help="scene file")
    _add_changes(parser)


def _add_changes(parser: argparse.ArgumentParser) -> None:
    text = "another value of a key, for instance pinion.teeth=21; may be given again for other keys"
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], type=_change, help=text)


def _change(text: str) -> tuple[str, str]:
    """Key and value, as text, of a change of a scene."""
    key, equals, value = (part.strip() for part in text.partition("="))
    if not key or not equals:
        raise argparse.ArgumentTypeError(f"{text!r:.60} is not KEY=VALUE, for instance pinion.teeth=21")
    return key, value
