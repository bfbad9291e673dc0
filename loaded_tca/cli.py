"""The command ``loaded-tca``: a scene file in; results, pictures or one line that says what is wrong out.

Exit codes: 0; 1 a fault of the program; 2 bad input; 3 no convergence; 130 interrupted.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING, NoReturn, TextIO

from loaded_tca.errors import ConvergenceError, ExecutorError, InputError, LoadedTCAError, reason_of

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.scene import Scene

# The modules that compute and draw take most of a second to import: each command imports what it needs.

OK, FAULT, BAD_INPUT, NO_CONVERGENCE, INTERRUPTED = 0, 1, 2, 3, 130
DEMO_DIRECTORY = Path("loaded-tca-demo")
DEMO_SCENE = Path(__file__).with_name("demo.toml")

DESCRIPTION = "Loaded tooth contact analysis of gears."
FILES = """files in DIR:
  result.nc                 everything, to be read by loaded_tca.load_result, xarray or 'loaded-tca plot'
  summary.json              the key figures
  positions.csv             one row per torque and position
  contacts.csv              one row per torque, position and tooth pair, only where pairs share the load
  contact_path.png          where the flanks carry pressure, under the largest torque
  transmission_error.png    over the positions, all torques
  peak_pressure.png         over the positions, all torques
  pressure_map.png          at the position of the peak pressure, under the largest torque
  pressure_map_edge.png     only if a contact at another position has the highest edge pressure
  pressure_map_hertz.png    only if Hertz holds, but not where the peak pressure is
and where tooth pairs share the load
  load_share.png            of each tooth pair, all torques
  harmonics.png             orders of the tooth mesh in the transmission error, all torques
  mesh_stiffness.png        over the positions, all torques
  line_load.png             over the positions, all torques
  line_load_distribution.png    along the contacts on the flanks, under the largest torque
  pressure_envelope.png     the highest pressure on the flanks, under the largest torque
  path_pressure.png         from the begin to the end of contact, all torques
and, only with 'plot --all'
  contact_patterns.png      the highest pressure on the flanks under each of several torques, on one scale
  full_mesh.png             all tooth pairs at the position of pressure_map.png on the flanks
Pictures of these names that the result does not have are removed; docs/results.md says more."""
TEETH = """files in DIR:
  pinion.vtk, wheel.vtk     the teeth in contact, in the fixed frame; "patch" tells flanks, fillets and lands apart
  pressure.vtk              the cells under pressure on the pinion's flank, in MPa
  pinion.stl, wheel.stl     closed solids, each in its gear's own frame
  teeth.png                 a picture of all that
All lengths are in mm."""
COMPARE = """files in DIR:
  comparison.csv            one row per shared torque and key figure: values, differences to the first result
  comparison.json           the same, and the keys in which the scenes differ
  comparison.png            transmission error, its harmonics, stiffness, pressure and load share, over each other
  compared_maps.png         pressure maps side by side on one scale
Pictures are those of one torque; docs/results.md says more."""
EASE_OFF = """files in DIR:
  ease_off.png              what the flank lacks of the conjugate of its mating flank, in um, with the values at its
                            corners, and its angles, crownings and twist"""
SUBSURFACE = """files in DIR:
  subsurface.nc             six stresses, von Mises and greatest shear, at every depth below every cell of the map
  subsurface.csv            the same over the depth, below the highest pressure
  subsurface_max_shear.png, subsurface_von_mises.png
Stresses in MPa, tension positive, of a half-space without friction; docs/results.md says more."""
STUDY = """files in DIR:
  study.nc                  all figures of all variants, to be read by loaded_tca.studies.load_study or xarray
  study.csv                 the same, one row per variant and torque
  ranking.csv               one row per variant, the best by --rank-by first
  study_*.png               pictures that fit what varies
  study.rows.jsonl          the variants that are done; the same command goes on from there
  study_maps/N.nc           whole results of the variants asked for by --keep-maps, as of 'loaded-tca run'"""
BAR = "{desc}: {percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}, {elapsed} gone, {remaining} left"
STUDY_BAR = "{desc}: {percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}, {rate_fmt}, {elapsed} gone, {remaining} left"
NOT_BY_ITSELF = 1e-9
"""Delay [s] of a bar that does not draw itself while it is made."""
REACHED_WITHIN = 10.0
"""Seconds for a scheduler to answer."""
TICK = 1.0
"""Seconds after which a bar is drawn again, also where one contact takes longer."""
WORTH_TELLING = 10.0
"""Seconds from which an estimate is told where there is no terminal, too."""
EXAMPLE = "Start with 'loaded-tca demo': it writes a scene file to change and to run again."


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Default: those of the process.

    Returns
    -------
    int
        The exit code.
    """
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):  # titles may hold characters that the terminal does not know
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        with _warnings_in_one_line_each():
            options = _parser().parse_args(arguments)
            options.command(options)
            _flush()
    except (Exception, KeyboardInterrupt) as error:  # whatever happens ends in one line
        if "--traceback" in arguments and not isinstance(error, KeyboardInterrupt | BrokenPipeError):
            traceback.print_exc()
        if isinstance(error, OSError) and error.filename is None:
            _let_go(sys.stdout)
        code, lines = _told(error)
        for line in (*lines, *getattr(error, "__notes__", ())):
            _say(f"loaded-tca: {line}")
        return code
    return OK


def _flush() -> None:
    """Write what was printed, while a failure can still be told."""
    if sys.stdout is not None:  # closed from the start
        sys.stdout.flush()


def _let_go(stream: TextIO | None) -> None:
    """Give up a stream that cannot be written: what it holds would fail again when the interpreter ends."""
    if stream is not None:
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _say(line: str) -> None:
    """Print a line on standard error, if that can be written."""
    if sys.stderr is not None:
        try:
            print(line, file=sys.stderr)
        except OSError:
            _let_go(sys.stderr)


def _told(error: BaseException) -> tuple[int, list[str]]:
    """Exit code and lines of an error."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, ["interrupted; no file is half written"]
    if isinstance(error, BrokenPipeError):  # whoever read the output has closed it
        return OK, []
    if isinstance(error, OSError):  # what the package writes tells by itself what cannot be written
        return BAD_INPUT, [f"{error.filename or 'standard output: cannot be written'}: {reason_of(error)}"]
    if isinstance(error, ExecutorError):
        return FAULT, [str(error)]
    if isinstance(error, ConvergenceError):
        return NO_CONVERGENCE, str(error).splitlines()
    if isinstance(error, LoadedTCAError):
        problems = error.problems if isinstance(error, InputError) else (str(error),)
        return BAD_INPUT, [" ".join(problem.split()) for problem in problems]
    if isinstance(error, MemoryError):
        return BAD_INPUT, [
            "out of memory; ask for fewer analysis.cells, a larger analysis.accuracy, or fewer positions"
        ]
    what = f"{type(error).__name__}: {error}".splitlines()[0]
    return FAULT, [f"a fault of the program, please report it with the output of --traceback: {what}"]


class _Parser(argparse.ArgumentParser):
    """Tells a wrong command line, and help that cannot be shown, as any other bad input."""

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; see '{self.prog} --help'")

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        _flush()
        super().exit(status, message)


def _path(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty; '.' is the directory that you are in")
    return Path(text)


def _parser() -> argparse.ArgumentParser:
    common = _Parser(add_help=False)
    common.add_argument("--traceback", action="store_true", default=argparse.SUPPRESS, help="show where an error arose")
    parser = _Parser("loaded-tca", description=DESCRIPTION, epilog=EXAMPLE, parents=[common])
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)

    def command(
        name: str, run: Callable[[argparse.Namespace], None], text: str, epilog: str | None = FILES
    ) -> argparse.ArgumentParser:
        layout = argparse.RawDescriptionHelpFormatter
        added = commands.add_parser(
            name, help=text, description=text, epilog=epilog, formatter_class=layout, parents=[common]
        )
        added.set_defaults(command=run)
        return added

    demo = command("demo", _demo, "analyse a helical pair; writes its scene file too")
    demo.add_argument("--out", metavar="DIR", type=_path, default=DEMO_DIRECTORY, help=f"default: ./{DEMO_DIRECTORY}")
    run = command("run", _run, "analyse a scene; writes result.nc, summary.json, positions.csv and pictures")
    _add_scene(run)
    run.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the results")
    own = "beside the result; with options that choose a part of it, in a directory there that these name"
    peak = "default: that of the peak pressure of the summary"
    plot = command("plot", _plot, "draw the pictures of a result again")
    told = "write the complete teeth of a result as surfaces (VTK, STL) and as a picture"
    tooth = command("tooth", _tooth, told, TEETH)
    below = command("subsurface", _subsurface, "show the stresses below a pressure map of a result", SUBSURFACE)
    for reader, of_torque, of_position in (
        (plot, "pinion torque of maps and flanks", "pressure_map.png"),
        (tooth, "pinion torque of the pressure", "the teeth"),
        (below, "pinion torque", "the pressure map"),
    ):
        reader.add_argument("result", metavar="DIR|FILE", type=_path, help="result.nc, or the directory that holds it")
        reader.add_argument("--out", metavar="DIR", type=_path, help=f"directory for the files; default: {own}")
        reader.add_argument("--torque", metavar="NM", type=float, help=f"{of_torque}; default: largest")
        reader.add_argument("--position", metavar="N", type=int, help=f"position of {of_position}, from 1; {peak}")
    plot.add_argument("--all", action="store_true", help="draw contact_patterns.png and full_mesh.png too")
    tooth.add_argument("--fillet-radius", metavar="MM", type=float, help="of arcs at the root; default: by the module")
    tooth.add_argument("--whole-gears", action="store_true", help="all teeth in the STL files, not one")
    below.add_argument("--pair", metavar="K", type=int, help=f"tooth pair, as load_share.png counts; {peak}")
    below.add_argument(
        "--gear", choices=("pinion", "wheel"), default="pinion", help="below whose flank; default: pinion"
    )
    compare = command("compare", _compare, "show what two or more results differ in", COMPARE)
    compare.add_argument(
        "results", metavar="DIR|FILE", nargs="+", type=_path, help="results; the first is what others are compared with"
    )
    compare.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the files")
    compare.add_argument("--names", metavar="NAME", nargs="+", help="of the results; default: from their directories")
    compare.add_argument("--torque", metavar="NM", type=float, help="pinion torque of the pictures; default: largest")
    compare.add_argument(
        "--position", metavar="N", type=int, help="position of the maps in the first result, from 1; default: own peaks"
    )
    ease_off = command("ease-off", _ease_off, "draw the ease-off of a scene, without load", EASE_OFF)
    _add_scene(ease_off)
    ease_off.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the picture")
    ease_off.add_argument("--gear", choices=("pinion", "wheel"), default="pinion", help="whose flank; default: pinion")
    study = command(
        "study", _study, "analyse the variants of a study file; run again, it goes on where it stopped", STUDY
    )
    study.add_argument("study", metavar="STUDY.toml", help="study file")
    study.add_argument("--out", metavar="DIR", required=True, type=_path, help="directory for the results")
    engine = study.add_mutually_exclusive_group()
    engine.add_argument("--workers", metavar="N", type=int, help="processes on this machine; default: this one alone")
    engine.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, as tcp://host:8786")
    study.add_argument("--rank-by", metavar="FIGURE", help="figure of study.csv, the least is best; default: TE span")
    study.add_argument(
        "--keep-maps",
        metavar="N,N,...",
        type=_numbers,
        default=(),
        help="variants, from 0, whose results are kept whole",
    )
    check = command("check", _check, "read a scene and show its geometry, without computing a contact", None)
    _add_scene(check)
    return parser


def _add_scene(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE.toml", help="scene file")
    text = "another value of a key, for instance pinion.teeth=21; may be given again for other keys"
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], type=_change, help=text)


def _change(text: str) -> tuple[str, str]:
    """Key and value, as text, of a change of a scene."""
    key, equals, value = (part.strip() for part in text.partition("="))
    if not key or not equals:
        raise argparse.ArgumentTypeError(f"{text!r:.60} is not KEY=VALUE, for instance pinion.teeth=21")
    return key, value


def _scene(options: argparse.Namespace) -> Scene:
    """The scene that the command line names, with its changes."""
    from loaded_tca.scene import read_scene
    from loaded_tca.scene.parse import literal_value

    scene = read_scene(options.scene)
    changes = {key: literal_value(value) for key, value in options.set}
    return scene.with_changes(changes) if changes else scene


class _Version(argparse.Action):
    """Looks the version up only when asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        print(f"loaded-tca {version('loaded_tca')}")
        parser.exit()


def _demo(options: argparse.Namespace) -> None:
    from loaded_tca.results.files import replace_together

    directory = options.out
    _check_place(directory)
    scene, content = directory / "scene.toml", DEMO_SCENE.read_bytes()
    if scene.exists() and scene.read_bytes() != content:
        again = f"'loaded-tca run {scene} --out {directory}'"
        raise InputError(f"{scene}: has been changed, and the demo would replace it; rename it, or use {again}")
    replace_together(directory, {scene.name: content})
    _run(argparse.Namespace(scene=scene, set=[], out=directory))
    print(f"Next: change {scene}, for instance its lead_crowning_um, then try\n")
    print(f"  loaded-tca run {scene} --out my-pair")


def _run(options: argparse.Namespace) -> None:
    """Read, analyse, write everything, and show the summary."""
    from loaded_tca.analysis import analyse
    from loaded_tca.output.report import write_report
    from loaded_tca.plots import MORE_PICTURES, PICTURES, plot_all

    scene, directory = _scene(options), options.out
    _check_place(directory)
    with _progress_bar(scene) as progress:
        result = analyse(scene, progress=progress)
    report = write_report(result, directory, outdated=[f"{name}.png" for name in (*PICTURES, *MORE_PICTURES)])
    try:
        pictures = plot_all(result, directory)
    except BaseException as error:  # an interrupt, too
        again = f"'loaded-tca plot {directory}' draws them"
        error.add_note(f"{directory}: the numbers are new, all pictures are missing: {again}")
        raise
    print(result.summary(), end="\n\n")
    _print_files([*report, *pictures])


def _plot(options: argparse.Namespace) -> None:
    from loaded_tca.plots import plot_all

    result, directory, torque, position = _loaded(options)
    _print_files(plot_all(result, directory, torque=torque, position=position, more=options.all))


def _tooth(options: argparse.Namespace) -> None:
    from loaded_tca.output.surface_files import write_teeth
    from loaded_tca.output.teeth_in_space import teeth_in_space
    from loaded_tca.pairs import mating_teeth
    from loaded_tca.plots import draw_teeth, png_of

    result, directory, torque, position = _loaded(options)
    teeth = mating_teeth(result.gear_pair, fillet_radius=options.fillet_radius)
    shown = teeth_in_space(result, teeth, position, torque)
    picture = {"teeth.png": png_of(draw_teeth(result, shown))}
    title = result.scene.title
    _print_files(write_teeth(shown, teeth, directory, title=title, whole_gears=options.whole_gears, more=picture))


def _subsurface(options: argparse.Namespace) -> None:
    from loaded_tca.output.subsurface_files import write_subsurface
    from loaded_tca.plots import plot_stress_below, png_of
    from loaded_tca.results.stress_below import NAMES, stress_below

    result, directory, torque, position = _loaded(options)
    below = stress_below(result, torque, position, options.pair, gear=options.gear)
    pictures = {f"subsurface_{quantity}.png": png_of(plot_stress_below(below, quantity)) for quantity in NAMES}
    written = write_subsurface(below, directory, pictures)
    print(below.summary(), end="\n\n")
    _print_files(written)


def _compare(options: argparse.Namespace) -> None:
    from loaded_tca.output.comparison_files import write_comparison
    from loaded_tca.plots import plot_compared_maps, plot_comparison, png_of
    from loaded_tca.results import MeshCycle, compare_results

    _check_place(options.out)
    paths = [_result_file(path) for path in options.results]
    names = options.names or _ends_that_differ(paths)
    if len(names) != len(paths) or len(set(names)) != len(names):
        raise InputError(f"--names {' '.join(names)}: {len(paths)} results take as many names, each another")
    comparison = compare_results(dict(zip(names, map(MeshCycle.load, paths), strict=True)))
    torque = None if options.torque is None else 1e3 * options.torque
    position = _index_of_position(options.position, comparison.results[names[0]])
    summary = comparison.summary(torque)
    pictures = {
        "comparison.png": png_of(plot_comparison(comparison, torque)),
        "compared_maps.png": png_of(plot_compared_maps(comparison, torque, position)),
    }
    written = write_comparison(comparison, options.out, pictures)
    print(summary, end="\n\n")
    _print_files(written)


def _ends_that_differ(paths: Sequence[Path]) -> list[str]:
    """Shortest ends of the paths of results, without the usual name of their files, that tell them apart."""
    from loaded_tca.output.report import RESULT

    whole = [Path(os.path.abspath(path)) for path in paths]
    for one in whole:
        if whole.count(one) > 1:
            raise InputError(f"{one}: given twice; a comparison takes different results")
    parts = [(one.parent if one.name == RESULT else one.with_suffix("")).parts for one in whole]
    longest = max(map(len, parts))
    ends = (["/".join(part[-length:]) for part in parts] for length in range(1, longest + 1))
    return next((names for names in ends if len(set(names)) == len(names)), [str(one) for one in whole])


def _ease_off(options: argparse.Namespace) -> None:
    from loaded_tca.flank_maps.ease_off_map import ease_off_map
    from loaded_tca.plots import plot_ease_off, png_of
    from loaded_tca.results.files import replace_together

    scene = _scene(options)
    _check_place(options.out)
    ease_off = ease_off_map(scene.pair(), options.gear)
    picture = png_of(plot_ease_off(ease_off, scene.title))
    _print_files(replace_together(options.out, {"ease_off.png": picture}))


def _study(options: argparse.Namespace) -> None:
    from loaded_tca.output.study_files import write_study
    from loaded_tca.plots import plot_study, png_of
    from loaded_tca.studies import read_study, run_study, study_summary

    study, directory = read_study(options.study), options.out
    _check_place(directory)
    with _executor(options) as executor, _bar("variants", len(study), STUDY_BAR) as show:
        found = run_study(study, executor, directory / "study.nc", show, keep_maps=options.keep_maps)
    pictures = {f"{name}.png": png_of(figure) for name, figure in plot_study(found, rank_by=options.rank_by).items()}
    written = write_study(found, directory, pictures, options.rank_by)
    print(study_summary(found), end="\n\n")
    _print_files([directory / "study.nc", *written])


@contextmanager
def _executor(options: argparse.Namespace) -> Iterator[Executor | None]:
    """Who analyses: processes of this machine, those of a cluster, or nobody else."""
    from loaded_tca.studies import process_pool

    if options.workers is not None:
        with process_pool(options.workers) as pool:
            yield pool
    elif options.scheduler is not None:
        try:
            from distributed import Client
        except ModuleNotFoundError:
            raise InputError("--scheduler: needs the package distributed; 'pip install distributed' gets it") from None
        try:
            client = Client(options.scheduler, timeout=REACHED_WITHIN)  # type: ignore[no-untyped-call]
        except (OSError, ValueError) as error:
            raise InputError(f"--scheduler {options.scheduler}: not reached: {reason_of(error)}") from None
        with client:
            yield client.get_executor(pure=False)  # type: ignore[no-untyped-call]
    else:
        yield None


def _numbers(text: str) -> tuple[int, ...]:
    if not all(part.isdecimal() for part in text.split(",")):
        raise argparse.ArgumentTypeError(f"{text}: allowed whole numbers with commas between them, as 0,12")
    return tuple(map(int, text.split(",")))


def _loaded(options: argparse.Namespace) -> tuple[MeshCycle, Path, int | None, int | None]:
    """What the command line names: the result, the directory to write to, and indices of the torque and position."""
    from loaded_tca.results.mesh_cycle import MeshCycle

    path = _result_file(options.result)
    result = MeshCycle.load(path)
    torque = options.torque
    if torque is not None:
        known = [f"{1e-3 * float(one):.6g}" for one in result.torque]
        if f"{torque:.6g}" not in known:
            raise InputError(f"--torque {torque:g}: the result has {', '.join(known)} N m")
        torque = known.index(f"{torque:.6g}")
    position = _index_of_position(options.position, result)
    chosen = {"torque_{:g}_Nm": options.torque, "position_{}": options.position}
    chosen |= {"pair_{}": getattr(options, "pair", None), "below_{}": getattr(options, "gear", None)}
    names = [name.format(value) for name, value in chosen.items() if value not in (None, "pinion")]
    directory = options.out or path.parent / "_".join(names)  # files of a part do not replace those of the whole
    _check_place(directory)
    return result, directory, torque, position


def _result_file(path: Path) -> Path:
    """The file of a result that is named by itself or by its directory."""
    from loaded_tca.output.report import RESULT

    return path / RESULT if os.path.isdir(path) else path


def _index_of_position(position: int | None, result: MeshCycle) -> int | None:
    """Index from 0 of a position of a result that is in contact, given from 1."""
    if position is None:
        return None
    if not 1 <= position <= len(result.path):
        raise InputError(f"--position {position}: the result has the positions 1 to {len(result.path)}")
    if not result.path.in_contact[position - 1]:
        raise InputError(f"--position {position}: no tooth pair is in contact there")
    return position - 1


def _check(options: argparse.Namespace) -> None:
    from loaded_tca.output.overview import describe_scene

    print(describe_scene(_scene(options)))


def _print_files(paths: Sequence[Path]) -> None:
    print(f"Written to {paths[0].parent}: {', '.join(path.name for path in paths)}")


def _check_place(directory: Path) -> None:
    """Refuse a directory that cannot be written before the analysis rather than after it; makes nothing."""
    whole = directory.absolute()
    existing = next(place for place in (whole, *whole.parents) if os.path.lexists(place))
    if not os.path.isdir(existing):
        what = "a link that leads nowhere" if existing.is_symlink() else "a file"
        raise InputError(f"--out {directory}: {existing} is {what}; give a directory")
    if not os.access(existing, os.W_OK):
        raise InputError(f"--out {directory}: {existing} cannot be written to; give another directory")
    for place in (whole, *(existing / name for name in whole.relative_to(existing).parts)):
        try:
            with suppress(FileNotFoundError):
                place.lstat()
        except OSError as error:  # a name that is too long
            raise InputError(f"--out {directory}: cannot be made a directory: {reason_of(error)}") from error


@contextmanager
def _progress_bar(scene: Scene) -> Iterator[Callable[[int, int], None] | None]:
    """An estimate of the analysis and, on a terminal, a bar with what is done, of how much, and the time left.

    In a file or a pipe there is no bar, and an estimate only of an analysis that is long or exceeds the memory. The bar
    is there from the start, before the first position teeth that bend are modelled, and shows the time all along.
    """
    from loaded_tca.loaded.effort import expected_effort

    effort, terminal = expected_effort(scene), sys.stderr is not None and sys.stderr.isatty()
    if not effort.is_refused and (terminal or effort.seconds > WORTH_TELLING or not effort.fits):
        _say(f"loaded-tca: {effort}")
    torques, positions = len(scene.torques), scene.analysis.positions
    count = "positions" if torques == 1 else f"{torques} torques x {positions} positions"
    with _bar(count, torques * positions, BAR) as show:
        yield show


@contextmanager
def _bar(what: str, whole: int, layout: str) -> Iterator[Callable[..., None] | None]:
    """On a terminal, a bar with what is done, of how much, and the time left: called with both, and failures."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from tqdm import tqdm

    with tqdm(desc=what, total=whole, bar_format=layout, delay=NOT_BY_ITSELF) as bar:
        bar.refresh()  # drawn only where an interrupt ends its line
        finished = Event()

        def tick() -> None:
            while not finished.wait(TICK):
                bar.refresh()

        def show(done: int, total: int, failed: int = 0) -> None:
            if failed:
                bar.set_description_str(f"{what} ({failed} failed)", refresh=False)
            bar.total = total
            bar.update(done - bar.n)

        ticking = Thread(target=tick, daemon=True)
        ticking.start()
        try:
            yield show
        finally:
            finished.set()
            ticking.join()


@contextmanager
def _warnings_in_one_line_each() -> Iterator[None]:
    """Collect warnings and tell each once, with its count, also if an error follows."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warnings.simplefilter("ignore", ResourceWarning)  # files that an interrupt leaves open
        try:
            yield
        finally:
            for message, count in Counter(" ".join(str(entry.message).split()) for entry in caught).items():
                _say(f"warning: {message}" + (f" ({count} times)" if count > 1 else ""))
