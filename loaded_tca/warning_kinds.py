"""Kinds of accuracy warnings: the sentence of each, what it means for the numbers, and what to do.

A warning is declared here and given where its reason is seen: ``give_accuracy_warning(kinds.BOX.sentence())``. Files
and reports have sentences; ``kind_of`` finds what is to be known of one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

from loaded_tca.plain import Sentence


@dataclass(frozen=True)
class Kind:
    """What is to be known of a kind of accuracy warning; code in backticks.

    Attributes
    ----------
    template : str
        Its sentence, numbers and names of which are fields in braces.
    meaning, advice : str
    """

    template: str
    meaning: str
    advice: str

    def sentence(self, **values: object) -> str:
        """The sentence with the values of its fields."""
        return Sentence().format(self.template, **values)

    @cached_property
    def words(self) -> str:
        """The longest part of the sentence that all of its kind have."""
        return max(re.split(r" ?\(?\{[^}]*\}", self.template), key=len)


EDGE_NOT_FREE = Kind(
    "the contact reaches an edge of a flank, where the pressure of the map is mesh-dependent; the free edge is left "
    "out (analysis.free_edges)",
    "a tip or face end ends the contact; theory has an infinite pressure at a sharp edge, and the half-space goes "
    "on beyond it, which is too stiff there: K_Hbeta grows with the cells, by `face_load_factor_error` at the most",
    "`free_edges = true`; read `peak_pressure`, not `edge_pressure` or the cells of the map; more crowning, end or "
    "tip relief on the gears",
)
EDGE = Kind(
    "the contact reaches an edge of a flank, where the pressure of the map is mesh-dependent",
    "a tip or face end ends the contact; theory has an infinite pressure at a sharp edge",
    "read `peak_pressure`, not `edge_pressure` or the cells of the map; more crowning, end or tip relief on the gears",
)
ROUNDED_EDGE = Kind(
    "the pressure at a rounded edge has an estimated error above {limit:.0%}, {size}",
    "two edges that meet askew, or a rounding much smaller than the contact, need more columns than are made; where "
    "a rounded edge meets a sharp one or the start of a linear relief, the pressure has no limit",
    "read `edge_pressure` with its error; a larger radius, or one for the sharp edge, too; a parabolic relief",
)
RELIEF_START = Kind(
    "the contact lies across the start of a linear relief, where the pressure of the map is mesh-dependent",
    "the flank has a relief start there",
    '`tip_relief_form = "parabolic"`, or read `peak_pressure`, not the cells of the map',
)
LINE_LOAD_SLOPES = Kind(
    "an edge cuts the slices of the largest line load: one derivative in four is off by more than 5%, one in six by "
    "more than 10%",
    "which cells the edge leaves of a slice changes with every step of a key: analyses on both sides differ by as "
    "much as the derivative",
    "read the derivatives of the load share and of the peak pressure",
)
PEAK_SLOPES = Kind(
    "an edge cuts the slices of the peak pressure, or the pair carries less than 5% of the torque: one derivative "
    "in eight is off by more than 5%, one in thirty by more than 10%",
    "a corner of a contact, or one that has only just come under load, has few cells: the peak follows them",
    "read the derivatives of other contacts, or compare two grids; more crowning, end or tip relief on the gears",
)
PEAK_BESIDE_JUMP = Kind(
    "the curvature of the gap jumps beside the peak pressure, as at the start of a parabolic relief: its derivatives "
    "by keys that move contacts or starts are off by 10 to 30%, some by half",
    "the peak stands a part of the contact's width beside the start and goes with it, while the derivative holds its "
    "place; finer grids are no better",
    "analyses on both sides; a relief that starts elsewhere; amounts of reliefs are within 12 %",
)
EDGES_AT_ONE_PLACE = Kind(
    "edges of both gears lie at one place: derivatives of the transmission error have a kink, and by growing values "
    "are up to {size:.2g} um per {unit} off those by falling ones ({key}; {count} of {keys} keys)",
    "to one side of the key the pinion's end rules and to the other the wheel's, and on one of them the contact is "
    "shorter; and a misalignment over the common face tilts the wheel by more as that gets shorter: the derivative is "
    "the mean of both sides",
    "faces of two widths or an offset, so that one gear ends the contact; else analyses on both sides",
)
FACE_ENDS_AT_ONE_PLACE = Kind(
    "faces of both gears end at one place: the derivative of K_Hbeta has a kink, it is {falling:+.2g} per {unit} by "
    "falling and {growing:+.2g} by growing values ({key}; {count} of {keys} keys)",
    "the common face, over which K_Hbeta counts, gets shorter to either side of the key, or one end of it does: the "
    "derivative is the mean of both sides; beside ends of the load it depends on the cells, its sign, too",
    "faces of two widths or an offset; else analyses to the side that is meant, over more than a cell",
)
FACE_END_IN_LOAD = Kind(
    "K_Hbeta is that of the strip at an end of the face which goes with a key: its derivative depends on the cells, at "
    "times its sign ({key}; {count} of {keys} keys)",
    "the load is the highest where a face ends, in a cell that the end cuts: analyses over steps below a cell scatter "
    "by as much as the derivative",
    "analyses over more than a cell along the contact; end relief or crowning that takes the load from the end",
)
SLOPES_BY_GRIDS = Kind(
    "derivatives of the transmission error depend on the grid by up to {size:.2g} um per {unit}, more than 5% of what "
    "they differ by over the positions ({key}; {count} of {keys} keys)",
    "edges, arcs and relief starts run through cells: where grids stay, or go with the contact points, derivatives are "
    "others by that, as they would not be on small cells; peak to peak and harmonics are off by about as much",
    "more `cells`, or a smaller `accuracy`; compare two grids",
)
NEARLY_PLASTIC = Kind(
    "the cap on the pressure leaves fewer than {cells} cells of a contact below it: derivatives of load shares are "
    "off by 10 to 30%, and peak to peak by as much as itself",
    "cells at the cap do not answer to a key, the few others carry all of it: derivatives follow single cells",
    "more `cells`; else a higher `max_pressure_MPa`, less torque, or analyses on both sides",
)
STRIPS_ALIKE = Kind(
    "another strip of the face carries as much but for {lacking:.1g}: K_Hbeta has a kink, beyond which derivatives "
    "are others by up to {size:.0%} ({key}; {count} of {keys} keys)",
    "K_Hbeta is the largest of 30 strips, and beyond the change by which another one becomes the largest it follows "
    "that: of an aligned pair it rises to either side",
    "analyses on both sides, or a Monte Carlo study; not the spread to first order",
)
STRIPS_BESIDE = Kind(
    "K_Hbeta follows the largest of its strips by {slope:.3g} per {unit}, while the load moves along the face: through "
    "it and those beside it the derivative is {other:.3g} ({key}; {count} of {keys} keys)",
    "K_Hbeta is the largest of 30 strips: where the load moves along the face each strip in turn is the largest, and "
    "derivatives swing about that of the load itself, which changes over more than a strip follow",
    "take the derivative through three strips for changes that move the load by a strip or more",
)
CONTACTS_ALIKE = Kind(
    "{figure}: the largest stresses of two contacts differ by {lacking:.1%}; derivatives are those of the larger one, "
    "and where the other becomes the larger they change by up to {size:.0%} ({key}; {count} of {keys} keys)",
    "local safeties are those of the largest pressure and root tension of all positions, and beyond the change by "
    "which another contact has the largest they follow that",
    "analyses on both sides, or more positions; not the spread to first order",
)
TRANSVERSE_HELD = Kind(
    "rating: derivatives hold K_Halpha of the analysis, on which safeties after the standard depend",
    "it is the largest line load of the mesh over the mean one and moves with reliefs and crownings; pressures and "
    "root tensions of local safeties do not depend on it",
    'analyses on both sides; `transverse_load_factor = "method B"` or a number; local safeties',
)
ANOTHER_POSITION = Kind(
    "{figure}: its derivatives end within a tolerance: beyond a change by {change:+.2g} {unit} another position is "
    "the highest or lowest, and they are others by {size:.0%} ({key}; {count} of {keys} keys)",
    "the figure is that of one position, or of two, and follows another one beyond that change, by values and "
    "derivatives of all positions: it may grow to either side where the table has it fall",
    "read the change as far as that only; beyond it analyses, or a Monte Carlo study; not the spread to first order",
)
PAIR_COMES_OR_GOES = Kind(
    "derivatives end within a tolerance: beyond a change by {change:+.2g} {unit} a tooth pair comes under load or "
    "leaves it, by which load shares are off by up to {share:.1%} ({key}; {count} of {keys} keys)",
    "a pair that nearly touches, or only just does, carries nothing to one side of that change and ever more to the "
    "other: derivatives are those of the pairs that carry now, and differences over both sides grow with their step",
    "read the change as far as that only; beyond it analyses, or a Monte Carlo study; not the spread to first order",
)
RELIEF_START_BESIDE = Kind(
    "a linear relief starts in the contact beside its point: derivatives depend on the grid by up to 25%",
    "the start runs through cells that have the gap of their middles: derivatives by mounting errors, machine "
    "settings and starts are off by 15 to 25 %, of either sign, and by more for line loads whose slice lies there",
    '`tip_relief_form = "parabolic"`, or compare two grids; amounts of reliefs are as exact as elsewhere',
)
PEAK_ERROR = Kind(
    "the estimated error of the peak pressure stays above {allowed:g}",
    "the finest grid allowed is too coarse for the accuracy asked for; at edges and relief starts, where grids are "
    "refined until the approach agrees, the line load still moves by more than that; where the curvature of the gap "
    "jumps, the pressure beside the peak",
    "a larger `accuracy`, or `cells`; at edges a smaller `accuracy`",
)
PEAK_MOVES = Kind(
    "the peak pressure moves by more than {limit:.0%} as the teeth bend beneath it",
    "the forces of the slices bend the teeth otherwise than when the grid was chosen, and the peak changed by more "
    "than its load: its error is as large",
    "fewer `cells` along the contact, or a larger `accuracy`; compare the same position a pitch later",
)
BOX = Kind(
    "the contact reaches the box of its grid",
    "the grid ends before the contact does, after it was made larger eight times: the pressure at its border is "
    "that of a body ending there",
    "less torque, or a higher `max_pressure_MPa`: a contact that outgrows its estimate 25 times over is no small "
    "area of the flank",
)
NO_TORQUE = Kind(
    "{torque:g} N m is next to no torque, the gaps it closes are rounding: taken for no load",
    "forces below 1e-12 E* m_n² (1 µN at module 3) deform flanks by what rounding puts into their gaps",
    "nothing, or a torque that is one",
)
IN_ONE_PIECE = (
    "of a pinion in one piece with its shaft `bore_diameter_mm = 0`, or none beside a `[pinion.shaft]`, which has its "
    "torsion"
)
"""What bore to give a gear that has none."""
BODY_TWIST = Kind(
    "the twist of the gear bodies about their bores, {bores} mm, is up to {share:.0%} of the deflection: the mesh "
    "stiffness is that of the bodies",
    "with teeth that bend: bores are held rigid, and small ones let the whole body turn",
    f"the `bore_diameter_mm` of the hub or shaft seat; {IN_ONE_PIECE}",
)
RIGID_BORES = Kind(
    "bores of {bores} mm are held rigid: the mesh is about {share:.0%} stiffer than with {usual} mm, the seats of "
    "shafts or the default bores",
    "with teeth that bend: a thin rim on a bearing, a sleeve or a web gives way, which the model does not have; the "
    "size is that of two models with these bores",
    "the diameter of what is as stiff as a shaft as `bore_diameter_mm`, or none; else finite elements of the whole "
    "gear",
)
FEW_CELLS = Kind(
    "fewer than 8 cells lie across the contact",
    "the grid is wide for its contact: a pair that barely carries load, or few `cells`",
    "nothing if its `load_share` is small; else more `cells`, or `accuracy`",
)
WIDE = Kind(
    "the contact is so wide that the tooth is no half-space",
    "half its width is above a quarter of the module",
    "an estimate, all of it: less torque, or finite elements",
)
DEFLECTION = Kind(
    "the deflection under load is up to {deflection:.3g} mm, more than {reach:g} modules: tooth pairs with a larger "
    "initial separation are not looked for",
    "only pairs with a smaller one share the load; another one may come to bear under so much load",
    "less torque; else read the shares as those of too few pairs",
)
FILLET = Kind(
    "fillet interference: {what}",
    "the mating gear's tip touches where the flank ends and the fillet begins",
    "tip diameters, profile shifts, or the cutter; `check` tells the diameters",
)
UNDERCUT = Kind(
    "undercut: the trochoid of its fillet ends the flank of the {gear} at diameter {form:.4f} mm, where the tip of the "
    "{mating} would use an involute down to {wanted:.4f} mm: {lost:.4f} mm of the path of contact are lost, {share:.1%}"
    ", and the transverse contact ratio is {ratio:.4f} instead of {whole:.4f} ({place}); a profile_shift of "
    "{shift:.4f} avoids it",
    "the mating flank leaves the corner where flank and fillet meet, as it leaves a tip: contact begins later or ends "
    "earlier, fewer teeth share the load, and the root below the corner is thin; all of it is in the numbers",
    "more profile shift, more teeth, a larger pressure angle; nothing, if the contact ratio suffices",
)
NOTCH = Kind(
    "grinding notch: {gear}: the stock for grinding is {depth:.3g} um above the protuberance of its tool: a notch so "
    "deep is left at the root form circle, by which ISO 6336-3 raises Y_S by {percent:.2g} % if it is as round as the "
    "tip of the tool",
    "teeth bend and roots are stressed without the notch, which no element resolves; safeties of roots leave it out",
    "a protuberance above the stock",
)
BACKLASH = Kind(
    "negative backlash: teeth are thicker than the spaces of the mating gear, so that whole gears jam, while the "
    "analysis has the contact of one flank of each",
    "both flanks of a tooth touch, and the load of the back adds to that of the flank in contact; no number of the "
    "result contains it",
    "a smaller sum of profile shifts, or a larger centre distance: `check` has the sum that leaves no backlash; of "
    "bevel gears thinner teeth",
)
NO_TOOTH = Kind(
    "{gear}: {fault}; its flank in contact is analysed all the same",
    "pressure on half-spaces needs no tooth behind the flank; a gear would have none",
    "profile shift, tip diameter, cutter, or smaller amounts of the modifications",
)
THIN_RIM = Kind(
    "root stress of the {gear}: the rim below its teeth is {rim:.2g} tooth heights thick, less than {least:g}: on a "
    "bore that is held rigid stress falls as the rim thins, on a real one it rises",
    "a real rim bends, and root stress on it rises by Y_B of ISO 6336-3; the bore of the model takes that strain",
    f"multiply by Y_B, or finite elements of the whole gear; {IN_ONE_PIECE}",
)
UNCOVERED = Kind(
    "{direction}: the points leave {left} of the flank uncovered; there the deviation is a continuation",
    "measured points do not reach the edges",
    "results near these edges rest on no measurement",
)
SWINGS = Kind(
    "the points deviate by {points}, the flank by {flank}: its continuation beyond them swings",
    "a B-spline through every point follows the noise, too, and goes on with it beyond the outermost points: near "
    "the edges the flank is no measured one",
    "`degree = 3` with `coefficients = [4, 4]`, or few more; points nearer to the edges; compare two fits",
)
COARSE_FIT = Kind(
    "the B-spline through {points} points misses the flank by {error} between them: take more points; the relief "
    "start where a linear relief starts is rounded off by any number",
    "the fit is coarse",
    "more points",
)
UNIT = Kind(
    "{key}: {amount:.6g} mm is more than {most:g} mm; is its unit right?",
    "modifications are some hundredths of a millimetre",
    "the amount in the unit of its key: um in scenes, mm in Python",
)
ODD_INPUT = Kind(
    "{key}: {value:g} {unit} is {what}; is its unit right?",
    "the number is taken as it stands, in the unit of its key",
    "moduli of steel are 2.06e5 MPa, of plastics some 1e3; torques are in N m",
)
CONTACT_RATIO = Kind(
    "the contact ratio is {ratio:.3g}, below 1: over a part of each pitch no flanks touch but a tip or a face end",
    "the path of contact is shorter than a pitch: one pair leaves it before the next one comes, tips drag on",
    "larger tip diameters, a smaller centre distance, more teeth, or a helix: `check` tells the contact ratio",
)
CLEARANCE = Kind(
    "the tip of the mating gear comes within {clearance:.3g} mm of the root of the {gear}, less than {least:g} modules",
    "rolling flanks do not touch there, but tips and roots of gears with tolerances may",
    "a smaller tip diameter of the mating gear, or a deeper dedendum",
)
BEYOND_YIELD = Kind(
    "4/pi of the mean pressure of a contact is above {most:.4g} MPa, which no gear material with a Young's modulus of "
    "{modulus:.6g} MPa carries without yielding",
    "4/pi of its mean is the peak of a line contact; load on cells beside edges, which `peak_pressure` leaves out, "
    "counts, too. The contact is elastic: real flanks yield below their surface, and carry the load on a wider contact",
    "`max_pressure_MPa`, less torque, or another unit of what was given",
)
ROOT_BEYOND_YIELD = Kind(
    "root stress of the {gear} is up to {stress:.4g} MPa, above {most:g}, which no gear steel carries without yielding",
    "stress is elastic: real roots yield, and the stress range of the next turns is another",
    "less torque, a larger module or fillet, or another unit of what was given",
)
UNMODIFIED_TOOTH = Kind(
    "{gear}, with its modifications: {fault}; it bends like the tooth without them",
    "the modified tooth cannot be meshed, for instance where it is pointed; its contact has the modifications, its "
    "bending has not",
    "smaller amounts; the compliance is that of a tooth a few hundredths of a millimetre thicker",
)
FACE_ELEMENTS = Kind(
    "root stress of the {gear}: across its face elements are {width:.2g} modules wide; where contacts cover a part "
    "of the face alone, root stress is too low, by a tenth at 2 modules",
    "the face is so wide that few elements lie across it",
    "read root stress under a contact of the whole face; a contact that covers a part of it has more",
)
LARGE_MOTIONS = Kind(
    "gears on their supports move by up to {way:.3g} mm and tilt by up to {tilt:.3g} mrad, more than {modules:g} "
    "modules or {most:g} mrad: supports are linear, and so soft that the gears hardly mesh",
    "motions of that size shift the contact by parts of the tooth; stiffnesses may have another unit than was meant",
    "stiffer supports, less torque, or the unit of compliance and stiffness: mm, rad, N, N mm",
)
SUPPORT_MOMENT = Kind(
    "the forces on the supports of the pinion turn it by {part:.1%} more or less than its torque",
    "forces have the direction of the normal at the contact point, all over the contact: on flanks that curve within "
    "it, as those of hypoid pairs do, motions of the gears and forces on bearings are off by about that part",
    "motions and forces on bearings to that part only; less torque, which makes the contact shorter",
)
EXTREME_AT_EDGE = Kind(
    "tribology: the {extreme} lies at an edge of a flank, where it is that of a line contact of the flank beside it or "
    "of its arc",
    "slices that reach a tip or a face end are real heat, but their pressure rises towards the edge: film and flash "
    "temperature there are indicative",
    "read the numbers of other slices, `on_edge` in the table of `slices`; tip or end relief; an edge with a radius",
)
EXTREME_MOVES = Kind(
    "tribology: with every second position the {extreme} is another one by {change:.1%}",
    "it lies in a corner of the path, or in few positions: more of them may find a worse one, by as much as half that",
    "more `positions`: 17 and more for corners of helical gears",
)
SLICES_AT_CAP = Kind(
    "tribology: the pressure of slices is cut at the cap on the pressure",
    "flash temperature and film follow the cut pressure, while the force of the slices is the whole one",
    "less torque, or a scene without `max_pressure_MPa`",
)
COLD_BULK = Kind(
    "tribology: the bulk temperature, {bulk:g} °C, is below that of the oil, {oil:g} °C",
    "teeth that transmit power are warmer than the oil that cools them",
    "the temperatures in the place of each other, or `bulk_temperature_C` left out",
)
PITCH_VELOCITY = Kind(
    "tribology: the pitch line velocity, {velocity:.3g} m/s, is outside {low:g} to {high:g} m/s",
    "coefficients of friction of the standards were fitted within",
    "a number for `friction`, from a test",
)
EDGES_NOT_RATED = Kind(
    "rating: local safeties of flanks leave edges out, whose pressure is {pressure:.0f} MPa under {torque} beside a "
    "peak pressure of {peak:.0f} MPa, {accuracy}",
    "they follow from slices of the flanks without their edges, as `peak_pressure` does: a sharp edge has no finite "
    "pressure, and allowable stresses are not those of an edge; what an edge adds to pitting is not rated",
    "tip or end relief that takes the load from the edge, as the finding of the summary says; a radius makes "
    "`edge_pressure` finite, and local safeties stay the same; safeties after the standard have no edges",
)
ABOVE_STATIC_STRENGTH = Kind(
    "rating: {where}: the stress {stress:.0f} MPa is above the static strength {strength:.0f} MPa under {torque}, "
    "where the standard ends",
    "the first load cycle may yield or break a tooth, so that safeties there are no measure of a life, which is 0",
    "a smaller torque or `operation.application_factor`, other allowable stresses, or a larger pair",
)
SPECTRUM_BETWEEN = Kind(
    "rating: the damage of the spectrum may be wrong by {change:.1%}, since stresses are interpolated between {count} "
    "torques that were solved",
    "damage grows with a high power of the stress, which bends over the torque where contacts come to edges, reliefs "
    "and further tooth pairs; the error is told by leaving out every second torque, and by how solved torques scatter",
    "more torques, `analysis.torques_Nm`, up to the largest of the spectrum; where they scatter, more `cells`",
)
PITCH_DEVIATIONS = Kind(
    "the gears have runout or teeth that differ, which an analysis of one pitch leaves out: all teeth count as alike",
    "pitch deviations, flanks of single teeth and eccentricity repeat with a turn of their gear, not with every pitch",
    "`loaded-tca revolution`, or `analyse_revolution`",
)
OPEN_REVOLUTION = Kind(
    "{pitches} pitches are no whole turn of the {gear}, whose teeth deviate: the ends of the curve do not meet, so "
    "that orders of the gears mix and deviations are those of this part",
    "amplitudes of a curve that is not closed leak into neighbouring orders, whichever gear they are named after; "
    "spans hold for the part that is there",
    '`pitches = "hunting"`, or a multiple of the number of teeth of that gear',
)
WEAK_SETTINGS = Kind(
    "settings from measured flanks: together these hardly change the flanks, by {effect} um where each by itself "
    "changes them by up to 10 um: {changes}",
    "noise of the measurement turns into large corrections that undo each other: what is left is small, the settings "
    "are not those of the machine",
    "fewer settings, limits for their changes, or both flanks of the gear measured; compare the standard deviations",
)
SHARES_OF_HALVES = Kind(
    "the shares of the halves are off by up to {error:.1%} of the torque, between torques of the halves that were "
    "analysed",
    "deflections bend over the torque where contacts come to edges, reliefs and further tooth pairs; the error is "
    "told by how much compliances and deflections of neighbouring torques disagree",
    "a gear that floats, halves that are alike, or more crowning and relief, so that contacts stay off the edges",
)
SHUTTLES = Kind(
    "the {gear} shuttles along its axis by up to {way:.3g} um from its mean place, more than a thousandth of the width "
    "of a half",
    "flanks are analysed where the floating gear stands in the mean: ends of the faces, crowning and reliefs move with "
    "it by as much, which pressures leave out; the motion itself and the shares have it",
    "smaller apex runout and slopes; the change of the face load factor by `pair.apex_offset_mm` of that size",
)
MEASURED_HALF = Kind(
    "half {half} of the {gear} has a measured flank that the other half has not, between gears that are held along "
    "the axes: it is turned onto its pitch point, so that shares leave out how it stands against the other half",
    "a measured flank is turned until it holds the pitch point: what its deviations say there, a shift of the apex, "
    "is left out of the shares and of the transmission error",
    "`pair.apex_offset_mm` for the apex as measured, modifications of the same size, or a gear that floats freely",
)

KINDS = tuple(one for one in globals().values() if isinstance(one, Kind))
"""Of every accuracy warning of an analysis, of derivatives of its result, of its tribology and its rating."""


def kind_of(sentence: str) -> Kind | None:
    """Return the kind of an accuracy warning; None of one that another package gave.

    Examples
    --------
    >>> kind_of("the contact reaches the box of its grid (at 1 of 9 pressure maps; the first: ...)").advice[:11]
    'less torque'
    """
    return max((one for one in KINDS if one.words in sentence), key=lambda one: len(one.words), default=None)
