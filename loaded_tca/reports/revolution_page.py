"""What the report of a whole revolution tells, of one pair or of both halves of a double helical pair."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.double_helical import DoubleHelicalRevolution
from loaded_tca.output.double_helical_overview import held_in_words
from loaded_tca.plain import plain
from loaded_tca.plots import halves_revolution_figures
from loaded_tca.plots.double_helical import HALVES_REVOLUTION_PICTURES
from loaded_tca.plots.picture import captions_of
from loaded_tca.plots.revolution import LEAST_SHOWN, REVOLUTION_PICTURES, revolution_figures
from loaded_tca.reports.double_helical_page import halves_geometry
from loaded_tca.reports.page import Table, parts_of, pictures_of
from loaded_tca.reports.result_page import MOST_TORQUES, explained, figures_table, scene_content
from loaded_tca.results.revolution import OverTurns, Revolution
from loaded_tca.results.summary import shown, shown_torque
from loaded_tca.scene.double_helical import HALVES, DoubleHelicalScene

if TYPE_CHECKING:
    from loaded_tca.results.revolution import Spectrum
    from loaded_tca.scene import Scene

MOST_ORDERS = 6
"""Of a table, those of the largest amplitudes."""
ORDER_GROUPS = "orders of the tooth mesh", "sidebands of the tooth mesh", "orders of rotation", "other orders"
"""What a page has a table of each."""
TEETH_IN_A_ROW = 10
"""Of a table of their deviations."""


def revolution_content(revolution: OverTurns) -> dict[str, Any]:
    """Return what the template of a whole revolution takes.

    Parameters
    ----------
    revolution : Revolution or DoubleHelicalRevolution
    """
    torques, figures, sentences = revolution.torque.tolist(), revolution.key_figures(), revolution.sentences()
    labels = revolution.labels()
    spectra = [revolution.spectrum(torque) for torque in range(len(torques))]
    return {
        "title": revolution.title or revolution.TITLE,
        "analysed_by": revolution.version,
        "scope": revolution.scope,
        "pitches": revolution.pitches,
        "key_figures": [figures_table(labels, figures[part]) for part in parts_of(torques, MOST_TORQUES)],
        "notes": [*sentences["note"], *sentences.get("finding", ())],
        "orders": [*order_tables(revolution, spectra, revolution.spectrum(rigid=True))],
        "most_orders": MOST_ORDERS,
        "least_order": plain(LEAST_SHOWN),
        "open_gears": " and of the ".join(revolution.open_gears),
        "warnings": explained(revolution.warnings or ()),
        **(_of_halves(revolution) if isinstance(revolution, DoubleHelicalRevolution) else _of_pair(revolution)),
    }


def _of_pair(revolution: OverTurns) -> dict[str, Any]:
    """What a revolution of one pair has of its own."""
    assert isinstance(revolution, Revolution)
    captions = captions_of(REVOLUTION_PICTURES)
    return {
        **scene_content(revolution.scene, len(revolution.pinion_angle)),
        "of_what": "",
        "held": "",
        "files": [],
        "motion_orders": [],
        "deviations": [*deviation_tables(revolution.scene)],
        "pictures": pictures_of(revolution_figures(revolution), captions, revolution.title),
    }


def _of_halves(revolution: DoubleHelicalRevolution) -> dict[str, Any]:
    """What a revolution of both halves has of its own."""
    scene, captions = revolution.scene, captions_of(HALVES_REVOLUTION_PICTURES)
    assert isinstance(scene, DoubleHelicalScene)
    halves = zip(HALVES, scene.half_scenes(scene.mounting.axial_offset_mm), strict=True)
    motions = [revolution.axial_spectrum(torque) for torque in range(len(revolution.torque))]
    return {
        **halves_geometry(scene, len(revolution.pinion_angle)),
        "of_what": " of a double helical pair",
        "held": held_in_words(scene),
        "files": [*revolution.parts()],
        "motion_orders": [*order_tables(revolution, motions)],
        "deviations": [*chain.from_iterable(deviation_tables(half, f" of half {name}") for name, half in halves)],
        "pictures": pictures_of(halves_revolution_figures(revolution), captions, revolution.title),
    }


def order_tables(revolution: OverTurns, spectra: Sequence[Spectrum], rigid: Spectrum | None = None) -> Iterator[Table]:
    """Tables of the orders with the largest amplitudes under any torque by their kinds, the largest first.

    Parameters
    ----------
    revolution : Revolution or DoubleHelicalRevolution
    spectra : sequence of Spectrum
        Under each torque.
    rigid : Spectrum, optional
        Without load.
    """
    amplitudes = np.array([spectrum.amplitude for spectrum in spectra])
    largest, kinds = amplitudes.max(axis=0), spectra[0].kind.tolist()
    ranked = [n for n in np.argsort(-largest, kind="stable").tolist() if largest[n] > LEAST_SHOWN]
    turns = [spectra[0].order * teeth / revolution.teeth[revolution.counted_by] for teeth in revolution.teeth]
    leaking = revolution.leaking_orders()
    heads = ["cycles per pinion turn", "per wheel turn"]
    heads += [f"leaking {gear} order" for gear in leaking] + ["without load [µm]"] * (rigid is not None)
    unloaded = [] if rigid is None else [rigid.amplitude]
    for group in ORDER_GROUPS:
        of_group = [n for n in ranked if _group(kinds[n]) == group][:MOST_ORDERS]
        for part in parts_of(spectra, MOST_TORQUES) if of_group else ():
            under = [f"{shown_torque(torque)} [µm]" for torque in revolution.torque[part].tolist()]
            rows = [
                (
                    order_in_words(kinds[n]),
                    *(plain(of_gear[n]) for of_gear in turns),
                    *(shown(of_gear[n], "order") for of_gear in leaking.values()),
                    *(shown(values[n], "amplitude_um") for values in (*unloaded, *amplitudes[part])),
                )
                for n in of_group
            ]
            yield Table(tuple(rows), (group, *heads, *under))


def _group(kind: str) -> str:
    """Group of the tables that a kind of order belongs to."""
    words = kind.split()
    if not words:
        return "other orders"
    if words[0] != "mesh":
        return "orders of rotation"
    return "orders of the tooth mesh" if len(words) == 2 else "sidebands of the tooth mesh"


def order_in_words(kind: str) -> str:
    """What an order is, by its kind in a spectrum.

    Examples
    --------
    >>> order_in_words("mesh 1"), order_in_words("mesh 2 -1 wheel")
    ('mesh order 1', 'mesh order 2 - 1 wheel order')
    >>> order_in_words("mesh 1 +3 pinion"), order_in_words("pinion 3"), order_in_words("")
    ('mesh order 1 + 3 pinion orders', 'pinion order 3', 'order of neither gear')
    >>> order_in_words("pinion 1 = wheel 2"), order_in_words("mesh 1 -1 pinion = -2 wheel")
    ('pinion order 1 = wheel order 2', 'mesh order 1 - 1 pinion order = - 2 wheel orders')
    """
    if not kind:
        return "order of neither gear"
    first, *others = kind.split(" = ")
    name, number, *sideband = first.split()
    words = f"{name} order {number}"
    if not sideband:
        return " = ".join([words, *map(order_in_words, others)])
    return f"{words} {' = '.join(_sideband(*one.split()) for one in (' '.join(sideband), *others))}"


def _sideband(apart: str, gear: str) -> str:
    """How many orders of a gear a sideband lies beside a mesh order."""
    return f"{apart[0]} {apart[1:]} {gear} order{'s' * (abs(int(apart)) > 1)}"


def deviation_tables(scene: Scene, of_what: str = "") -> Iterator[Table]:
    """Tables of where the teeth of both gears stand, and which of them have flanks of their own; none if all are alike.

    Parameters
    ----------
    scene : Scene
    of_what : str
        Behind the names of the gears in captions.
    """
    gears = scene.pinion, scene.wheel
    if not any(gear.teeth_differ for gear in gears):
        return
    deviations = scene.tooth_deviations(scene.pair())
    index = [1e3 * one.index for one in deviations]
    own = [", ".join(str(tooth.number) for tooth in gear.tooth or ()) or "none" for gear in gears]
    rows = (
        ("cumulative pitch deviation: span of the index deviations [µm]", *(_um(np.ptp(one)) for one in index)),
        ("largest single pitch deviation [µm]", *(_um(np.abs(one - np.roll(one, 1)).max()) for one in index)),
        ("runout, twice the eccentricity [µm]", *(_um(2e3 * one.eccentricity) for one in deviations)),
        ("azimuth of the eccentricity [deg]", *(plain(np.degrees(one.phase)) for one in deviations)),
        ("teeth with flanks of their own", *own),
    )
    yield Table(rows, ("", *(gear + of_what for gear in GEARS)))
    for name, values in zip(GEARS, index, strict=True):
        if values.any():
            cells = [*map(_um, values.tolist())]
            firsts = range(0, len(cells), TEETH_IN_A_ROW)
            head = ("tooth", *(f"+{n}" for n in range(min(TEETH_IN_A_ROW, len(cells)))))
            lines = tuple((f"{first}", *cells[first : first + TEETH_IN_A_ROW]) for first in firsts)
            yield Table(lines, head, f"Index deviations of the {name}{of_what} [µm]")


def _um(value: float) -> str:
    """A length in um with two decimal places."""
    return f"{value:z.2f}"
