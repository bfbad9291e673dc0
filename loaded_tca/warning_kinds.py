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


RELIEVE = "give the gears more `lead_crowning_um`, `end_relief_um` or `tip_relief_um`"
"""What takes the load from edges."""
OFFSET_FACES = (
    "give the gears different `face_width_mm`, or shift one along its axis, for instance by `mounting.axial_offset_mm`"
)
"""What brings faces apart that end at one place."""

EDGE_NOT_FREE = Kind(
    "the contact reaches an edge of a flank, where the pressure of the map is mesh-dependent; the free edge is left "
    "out (analysis.free_edges)",
    "the contact ends at a tip or a face end. In theory the pressure at a sharp edge is infinite. The half-space of "
    "the model goes on beyond the edge and is too stiff there: K_Hbeta grows with the number of cells, by "
    "`face_load_factor_error` at the most",
    f"`free_edges = true`; read `peak_pressure`, not `edge_pressure` and not the cells of the map; {RELIEVE}",
)
EDGE = Kind(
    "the contact reaches an edge of a flank, where the pressure of the map is mesh-dependent",
    "the contact ends at a tip or a face end. In theory the pressure at a sharp edge is infinite",
    f"read `peak_pressure`, not `edge_pressure` and not the cells of the map; {RELIEVE}",
)
ROUNDED_EDGE = Kind(
    "the pressure at a rounded edge has an estimated error above {limit:.0%}, {size}",
    "two edges that meet askew, or a rounding much smaller than the contact, need more columns of cells than the "
    "analysis makes. Where a rounded edge meets a sharp edge or the start of a linear relief, the pressure has no "
    "limit",
    "read `edge_pressure` together with its error; use a larger `tip_rounding_mm` or `side_rounding_mm`, round the "
    "sharp edge, too, or use a parabolic relief",
)
NARROW_ENDS = Kind(
    "the pressure at rounded flush face ends is uncertain: their radius is below {part} of the half width of the "
    "contact",
    "the contact runs within 45 degrees of the direction of these ends. There the image of the pressure in a free end"
    " acts on whole slices, with the width of a contact whose half width is a twentieth of the module. Beside a wider "
    "contact the pressure is too high: 1.4 to 2.1 times for a radius of a twentieth of the half width. The estimated "
    "error does not contain this",
    "where both gears have the same radius, take 1.16 (p^2 E*)^(1/3), which small radii do not change. An analysis of "
    "the same ends without roundings has p, which makes this 17 to 25% too high on a spur pair. Use `end_relief_um` or"
    " `lead_crowning_um`",
)
EDGE_UNSOLVED = Kind(
    "the pressure at a rounded edge is not known: its columns of cells are left with a residual of {residual:.1e}, "
    "above {tolerance:.0e}",
    "the contact is solved once more along the edge, for `edge_pressure` alone, and this solution did not converge. "
    "This contact has no edge pressure, and the largest edge pressure is that of the other contacts. All other numbers"
    " stand",
    "another number of `cells`, or a slightly different radius of the edge: both make other columns",
)
RELIEF_START = Kind(
    "the contact lies across the start of a linear relief, where the pressure of the map is mesh-dependent",
    "a linear relief starts within the contact, and the slope of the flank jumps there",
    '`tip_relief_form = "parabolic"`; or read `peak_pressure`, not the cells of the map',
)
LINE_LOAD_SLOPES = Kind(
    "an edge of a flank cuts the slices with the largest line load: of the derivatives of such line loads one in four"
    " is off by more than 5%, one in six by more than 10%",
    "with every step of a key the edge cuts other cells of a slice. Even differences of analyses on both sides of a "
    "value are off by as much as the derivative",
    "read the derivatives of the load share and of the peak pressure instead",
)
PEAK_SLOPES = Kind(
    "an edge of a flank cuts the slices with the peak pressure, or a pair at an edge carries less than 5% of the "
    "torque: of the derivatives of such peak pressures one in eight is off by more than 5%, one in thirty by more "
    "than 10%",
    "only few cells lie in the corner of a contact, or in a contact that has only just come under load: the peak "
    "pressure follows these few cells",
    f"read the derivatives of other contacts, or compare two grids; {RELIEVE}",
)
PEAK_BESIDE_JUMP = Kind(
    "the curvature of the gap jumps beside the peak pressure, as at the start of a parabolic relief: derivatives of "
    "the peak pressure by keys that move the contact or the start of the relief are off by 10 to 30%, some by half",
    "the peak lies within half a width of the contact from the start of the relief and moves with this start. The "
    "derivative holds the place of the peak. Finer grids do not help",
    "analyse values on both sides of the present one; start the relief elsewhere; derivatives by amounts of reliefs "
    "are within 12 %",
)
EDGES_AT_ONE_PLACE = Kind(
    "edges of both gears lie at one place: the transmission error has a kink there, and its derivatives for growing "
    "values differ by up to {size:.2g} um per {unit} from those for falling values ({key}; {count} of {keys} keys)",
    "for values on one side of the present value the edge of the pinion ends the contact, on the other side the edge "
    "of the wheel, and on one of these sides the contact gets shorter. A misalignment that is given over the common "
    "face also tilts the wheel more where this face gets shorter. The derivative is the mean of both sides",
    f"{OFFSET_FACES}, so that one gear alone ends the contact; else analyse values on both sides of the present one",
)
FACE_ENDS_AT_ONE_PLACE = Kind(
    "faces of both gears end at one place: K_Hbeta has a kink there, and its derivative is {falling:+.2g} per {unit} "
    "for falling and {growing:+.2g} per {unit} for growing values ({key}; {count} of {keys} keys)",
    "K_Hbeta counts over the common face, which growing and falling values shorten, as a whole or at one end. The "
    "derivative is the mean of both sides. Where the face ends close to an end of the load, the derivative and even "
    "its sign depend on the cells",
    f"{OFFSET_FACES}; else analyse values on the side of interest, in steps that move the face by more than a cell",
)
FACE_END_IN_LOAD = Kind(
    "K_Hbeta is that of the strip at one end of the face, and this end moves with a key: the derivative of K_Hbeta "
    "depends on the cells, at times even its sign ({key}; {count} of {keys} keys)",
    "the load is highest where the face ends, in a cell that this end cuts: differences of analyses over steps below "
    "a cell scatter by as much as the derivative",
    "use analyses over steps of more than a cell along the contact; use `end_relief_um` or `lead_crowning_um` that "
    "takes the load away from the end of the face",
)
ARC_IN_LOAD = Kind(
    "contacts end on the rounding of a face end beside the strip with the largest load, and K_Hbeta of the cells alone "
    "is off by up to {error:.0%}: derivatives of K_Hbeta depend on the cells by as much as their own size ({key}; "
    "{count} of {keys} keys)",
    "the cells resolve the end of a contact on a rounding to half a cell only, and a key moves this end. Derivatives "
    "are those of the cells; K_Hbeta itself is that of finer columns",
    "use differences of analyses over steps that change K_Hbeta by more than its `face_load_factor_error`; more "
    "`cells` along the contact; use `end_relief_um` or `lead_crowning_um` that takes the load away from the rounding",
)
SLOPES_BY_GRIDS = Kind(
    "derivatives of the transmission error depend on the grid by up to {size:.2g} um per {unit}, more than 5% of "
    "their range over the positions ({key}; {count} of {keys} keys)",
    "edges, arcs and relief starts run through cells. The derivatives depend by this size on where the grids lie, both"
    " for grids that stay in place and for grids that move with the contact points; smaller cells make this size "
    "smaller. Derivatives of peak to peak and of harmonics are off by about as much",
    "more `cells`, or a smaller `accuracy`; compare two grids",
)
SHARES_BY_GRIDS = Kind(
    "derivatives of load shares depend on the grid by up to {size:.2g} per {unit}, where the largest is {largest:.2g} "
    "per {unit} ({key}; {count} of {keys} keys)",
    "edges, arcs and relief starts run through cells. The derivatives depend by this size on where the grids lie, both"
    " for grids that stay in place and for grids that move with the contact points; smaller cells make this size "
    "smaller",
    "more `cells`, or a smaller `accuracy`; compare two grids",
)
PAIR_LEAVES = Kind(
    "a tooth pair with {share:.2g}% of the torque loses its load at a change by {change:+.2g} {unit}, where load "
    "shares have a kink: over a change by {usual:g} {unit} to that side derivatives are off by at least {size:.0%} of "
    "the largest ({key}; {count} of {keys} keys)",
    "beyond this change the pair carries nothing, and the other pairs share the whole torque. Derivatives are those of "
    "the pairs that carry load now, and smaller cells do not change them",
    "use the derivatives up to that change only; analyse values on both sides of the present one; do not use the "
    "spread to first order",
)
PEAKS_ALIKE = Kind(
    "two places of a contact have nearly the same pressure, {lacking:.2%} apart, so that its peak pressure has a kink: "
    "the derivative is {slope:.3g} MPa per {unit} at one place and {other:.3g} MPa per {unit} at the other ({key}; "
    "{count} of {keys} keys)",
    "the peak pressure follows the place with the largest pressure. Where a change of a key gives another place the "
    "largest pressure, the peak pressure follows that place: if both ends of a contact have the same pressure, a tilt "
    "in either direction raises the peak pressure",
    "analyse values on both sides of the present one; do not use the spread to first order",
)
NEARLY_PLASTIC = Kind(
    "the cap on the pressure leaves fewer than {cells} cells of a contact below it: derivatives of load shares are "
    "off by 10 to 30%, those of peak to peak by as much as their own size",
    "cells at the cap do not respond to a key. The few cells below the cap take the whole change, so that derivatives"
    " follow single cells",
    "more `cells`; else a higher `max_pressure_MPa` or less torque, or analyse values on both sides of the present one",
)
STRIPS_ALIKE = Kind(
    "another strip of the face carries nearly the largest load, {lacking:.2%} less: K_Hbeta has a kink, and beyond it"
    " derivatives differ by up to {size:.0%} ({key}; {count} of {keys} keys)",
    "K_Hbeta follows the one of 30 strips that has the largest load. Where a change of a key makes another strip the "
    "most loaded one, K_Hbeta follows that strip: for an aligned pair K_Hbeta rises to both sides",
    "analyse values on both sides of the present one, or use a Monte Carlo study; do not use the spread to first order",
)
STRIPS_BESIDE = Kind(
    "K_Hbeta follows the strip with the largest load by {slope:.3g} per {unit}, while the load moves along the face: "
    "through this strip and both strips beside it the derivative is {other:.3g} ({key}; {count} of {keys} keys)",
    "K_Hbeta is that of the strip with the largest load, of 30 strips. While the load moves along the face, each "
    "strip in turn has the largest load, and its derivative swings about the derivative of the load itself. A change "
    "that moves the load by more than a strip follows the derivative of the load",
    "for changes that move the load by a strip or more, take the second number, the derivative through three strips",
)
CONTACTS_ALIKE = Kind(
    "{figure}: the largest stresses of two contacts differ by {lacking:.1%}; derivatives are those of the contact "
    "with the larger stress, and where the other contact gets the larger stress they change by up to {size:.0%} "
    "({key}; {count} of {keys} keys)",
    "local safeties follow from the largest pressure and the largest root tension of all positions. Where a change of"
    " a key gives another contact the largest stress, local safeties follow that contact",
    "analyse values on both sides of the present one, or use more positions; do not use the spread to first order",
)
TRANSVERSE_HELD = Kind(
    "rating: derivatives hold K_Halpha of the analysis constant, though safeties after the standard depend on it",
    "K_Halpha is the largest line load of the mesh over the mean line load, and changes with reliefs and crownings. "
    "Pressures and root tensions of local safeties do not depend on it",
    'analyse values on both sides of the present one; or give `transverse_load_factor = "method B"` or a number; or '
    "read local safeties",
)
ANOTHER_POSITION = Kind(
    "{figure}: its derivatives do not hold over the whole tolerance: beyond a change by {change:+.2g} {unit} another "
    "position is the highest or lowest, and the derivatives differ by {size:.0%} ({key}; {count} of {keys} keys)",
    "the figure follows one position, or two. Beyond the stated change, which is computed from values and derivatives"
    " of all positions, the figure follows another position: it may grow to both sides even where the derivative is "
    "negative",
    "use the derivative up to that change only; beyond it use analyses or a Monte Carlo study, not the spread to "
    "first order",
)
PAIR_COMES_OR_GOES = Kind(
    "derivatives do not hold over the whole tolerance: beyond a change by {change:+.2g} {unit} a tooth pair comes "
    "under load or loses its load, and load shares are off by up to {share:.1%} ({key}; {count} of {keys} keys)",
    "a tooth pair that nearly touches, or only just touches, carries nothing to one side of that change and more and "
    "more to the other side. Derivatives are those of the pairs that carry load now; difference quotients over both "
    "sides grow with their step",
    "use the derivatives up to that change only; beyond it use analyses or a Monte Carlo study, not the spread to "
    "first order",
)
RELIEF_START_BESIDE = Kind(
    "a linear relief starts within the contact, beside the contact point: derivatives depend on the grid by up to 25%",
    "the start of the relief runs through cells, and each cell has the gap of its middle. Derivatives by mounting "
    "errors, machine settings and relief starts are off by 15 to 25 %, with either sign. Derivatives of line loads in "
    "slices on the start of the relief are off by more",
    '`tip_relief_form = "parabolic"`, or compare two grids; derivatives by amounts of reliefs are as exact as '
    "elsewhere",
)
PEAK_ERROR = Kind(
    "the estimated relative error of the peak pressure stays above {allowed:g}",
    "the finest grid allowed is too coarse for the accuracy asked for. At edges and relief starts grids are refined "
    "until the approach agrees, and the line load still changes by more than the accuracy. Where the curvature of the"
    " gap jumps, the pressure beside the peak still changes by more than the accuracy",
    "a larger `accuracy`, or more `cells`; at edges a smaller `accuracy`, which refines the grid further",
)
PEAK_MOVES = Kind(
    "the peak pressure changes by more than {limit:.0%} as the teeth bend after the grid was chosen",
    "under the final forces of the slices the teeth bend in another way than when the grid was chosen. The peak "
    "pressure changed by this percentage more than the load, and its error is as large",
    "fewer `cells` along the contact, or a larger `accuracy`; compare the same position one pitch later",
)
BOX = Kind(
    "the contact reaches the border of its grid",
    "the contact goes on beyond the grid, although the grid was made larger eight times: the pressure at the border "
    "is that of a body which ends there",
    "less torque, or a higher `max_pressure_MPa`: a contact more than 25 times as large as estimated is no small area"
    " of the flank",
)
NO_TORQUE = Kind(
    "{torque:g} N m is next to no torque and is taken for no load: the gaps that it closes are rounding errors",
    "forces below 1e-12 E* m_n² (1 µN at module 3) deform the flanks by no more than the rounding errors of their gaps",
    "nothing, or a larger torque",
)
IN_ONE_PIECE = (
    "for a pinion in one piece with its shaft give `bore_diameter_mm = 0`; beside a `[pinion.shaft]`, which contains "
    "this torsion, leave `bore_diameter_mm` out"
)
"""What bore to give a gear that has none."""
BODY_TWIST = Kind(
    "the twist of the gear bodies about their bores, {bores} mm, is up to {share:.0%} of the deflection: the mesh "
    "stiffness is mostly that of the bodies",
    "where teeth bend, the model holds the bores rigid, and about a small bore the whole body twists",
    f"give the `bore_diameter_mm` of the hub or shaft seat; {IN_ONE_PIECE}",
)
RIGID_BORES = Kind(
    "bores of {bores} mm are held rigid: the mesh is about {share:.0%} stiffer than with bores of {usual} mm, the "
    "seats of shafts or the default bores",
    "where teeth bend, the model holds the bores rigid; a thin rim on a bearing, a sleeve or a web is not. The "
    "percentage comes from two models with these bores",
    "give the diameter of the part that is as stiff as a shaft as `bore_diameter_mm`, or leave this key out; else use"
    " finite elements of the whole gear",
)
FEW_CELLS = Kind(
    "fewer than 8 cells lie across the contact",
    "the grid is wide for its contact: the pair barely carries load, or there are few `cells`",
    "nothing if the `load_share` of the pair is small; else more `cells`, or `accuracy` instead of `cells`",
)
WIDE = Kind(
    "the contact is so wide that the tooth is no half-space",
    "half the width of the contact is above a quarter of the module",
    "take all numbers as estimates only; use less torque, or finite elements",
)
DEFLECTION = Kind(
    "the deflection under load is up to {deflection:.3g} mm, more than {reach:g} modules: tooth pairs with a larger "
    "initial separation are not looked for",
    "only tooth pairs with a smaller initial separation share the load in the model; under so much load a further "
    "pair may come into contact",
    "less torque; else read the load shares as those of too few tooth pairs",
)
FILLET = Kind(
    "fillet interference: {what}",
    "the tip of the mating gear touches the root where the flank ends and the fillet begins",
    "change tip diameters, profile shifts, or the cutter; `check` shows the diameters",
)
UNDERCUT = Kind(
    "undercut: the trochoid of the fillet ends the flank of the {gear} at diameter {form:.4f} mm, where the tip of "
    "the {mating} would use an involute down to {wanted:.4f} mm: {lost:.4f} mm of the path of contact are lost, "
    "{share:.1%}, and the transverse contact ratio is {ratio:.4f} instead of {whole:.4f} ({place}); a profile_shift "
    "of {shift:.4f} avoids the undercut",
    "the mating flank leaves the corner where flank and fillet meet, just as it leaves a tip. Contact begins later or"
    " ends earlier, fewer teeth share the load, and the root below the corner is thin. The numbers of the result "
    "contain all of this",
    "more profile shift, more teeth, or a larger pressure angle; nothing, if the contact ratio suffices",
)
NOTCH = Kind(
    "grinding notch: {gear}: the stock for grinding is {depth:.3g} um larger than the protuberance of the tool and "
    "leaves a notch of this depth at the root form circle; ISO 6336-3 raises Y_S by {percent:.2g} % for it, if it is "
    "as round as the tip of the tool",
    "bending and root stress are those of teeth without the notch, which no element resolves; root safeties leave the"
    " notch out, too",
    "a protuberance larger than the stock",
)
BACKLASH = Kind(
    "negative backlash: teeth are thicker than the tooth spaces of the mating gear, so that whole gears jam; the "
    "analysis has only the contact of one flank of each gear",
    "both flanks of a tooth touch, and the load on the back flank adds to the load on the flank in contact. No number"
    " of the result contains the load on the back flank",
    "a smaller sum of profile shifts, or a larger centre distance: `check` shows the sum at which the backlash is "
    "zero; for bevel gears thinner teeth",
)
NO_TOOTH = Kind(
    "{gear}: {fault}; the flank in contact is analysed nevertheless",
    "half-spaces have a pressure even without a tooth behind the flank; a real gear would not have this tooth",
    "change profile shift, tip diameter or cutter, or use smaller amounts of the modifications",
)
THIN_RIM = Kind(
    "root stress of the {gear}: the rim below its teeth is {rim:.2g} tooth heights thick, less than {least:g}: with "
    "the rigid bore of the model root stress falls as the rim gets thinner, on a real gear it rises",
    "a real rim bends, and its root stress rises by Y_B of ISO 6336-3; in the model the rigid bore takes that strain",
    f"multiply root stress by Y_B, or use finite elements of the whole gear; {IN_ONE_PIECE}",
)
UNCOVERED = Kind(
    "{direction}: the measured points leave {left} of the flank uncovered; there the deviation is extrapolated",
    "the measured points do not reach the edges of the flank",
    "do not rely on results near these edges, which no measurement supports",
)
SWINGS = Kind(
    "the points deviate by {points}, the flank by {flank}: the flank oscillates where it is extrapolated beyond the "
    "points",
    "a B-spline through every point also follows the noise of the measurement, and extrapolates it beyond the "
    "outermost points: near the edges the flank is not the measured one",
    "`degree = 3` with `coefficients = [4, 4]`, or few more; points nearer to the edges; compare two fits",
)
COARSE_FIT = Kind(
    "the B-spline through {points} points misses the flank by {error} between the points: take more points; the start"
    " of a linear relief gets rounded off, however many points there are",
    "the fit has too few points",
    "more points",
)
UNIT = Kind(
    "{key}: {amount:.6g} mm is more than {most:g} mm; is its unit right?",
    "usual modifications are some hundredths of a millimetre",
    "give the amount in the unit of its key: um in scenes, mm in Python",
)
ODD_INPUT = Kind(
    "{key}: {value:g} {unit} is {what}; is its unit right?",
    "the program takes the number as it is, in the unit of its key",
    "check the unit: moduli of steel are 2.06e5 MPa, those of plastics some 1e3 MPa; torques are in N m",
)
THICKNESS = Kind(
    "tooth thickness of the {gear}: the allowance A_sn is {allowance:+.4g} um beside profile_shift = {shift:.4f}, "
    "{source}; with profile_shift = {generating:.4f} the same teeth have no allowance",
    "allowances of real teeth are small, and negative, since they make the backlash. A measure over teeth, balls or "
    "pins without a profile shift counts as an allowance on teeth of `profile_shift = 0`. Flanks and roots are those "
    "of the measured teeth; tip diameters that are not given, and c' of ISO 6336-1, are those of the profile shift",
    "give the `profile_shift` of the drawing; where the drawing has none, give the value that leaves no allowance, and"
    " `tip_diameter_mm`; an allowance of thinner teeth is negative",
)
LONG_TIP = Kind(
    "tip of the {gear}: tip_diameter_mm is that of a tip alteration of {alteration:+.3g} modules beside profile_shift "
    "= 0, the default, since none is given; with profile_shift = {shift:.4f} the tip has no alteration",
    "a basic rack of ISO 53 leaves no longer tip. On gears with a long and a short addendum the tip diameter has the "
    "profile shift in it; without it flanks, thickness and root are those of other teeth",
    "give the `profile_shift` of the drawing; `profile_shift = 0` says that the teeth are only longer",
)
WIDE_BACKLASH = Kind(
    "wide backlash: {backlash:.3g} mm along the normal of the flanks, {modules:.2g} modules: at the centre distance of "
    "{distance:.4f} mm the sum of the profile shifts is {given:.4f}, and a sum of {wanted:.4f} leaves no backlash",
    "gears have a backlash of some hundredths of a module. With a centre distance and no profile shifts teeth are too "
    "thin by the shifts that are missing: bending and root stress are those of such teeth",
    "give the `profile_shift` of one gear: that of the other one follows from the centre distance; or give the tooth "
    "thickness of both; nothing, if the backlash is meant",
)
WIDE_SPACES = Kind(
    "wide backlash: at the mean point the normal pitch is {backlash:.3g} mm, {modules:.2g} mean normal modules, larger "
    "than the teeth of pinion and wheel together",
    "gears have a backlash of some hundredths of a module. Teeth of face-milled gears are as thin as the point radii "
    "of their blades make them: bending and root stress are those of such teeth",
    "check the point radii of both cutters, or the backlash and the thickness modification of the blank that they "
    "follow from; nothing, if the backlash is meant",
)
CONTACT_RATIO = Kind(
    "the contact ratio is {ratio:.3g}, below 1: over a part of each pitch the gears touch at a tip or a face end only",
    "the path of contact is shorter than a pitch: one pair leaves it before the next pair enters it, and meanwhile a "
    "tip stays in contact",
    "larger tip diameters, a smaller centre distance, more teeth, or a helix; `check` shows the contact ratio",
)
CLEARANCE = Kind(
    "the tip of the mating gear comes within {clearance:.3g} mm of the root of the {gear}, less than {least:g} modules",
    "rolling flanks do not touch there, but tips and roots of real gears, which have tolerances, may touch",
    "a smaller tip diameter of the mating gear, or a deeper dedendum",
)
BEYOND_YIELD = Kind(
    "4/pi of the mean pressure of a contact is above {most:.4g} MPa, which no gear material with a Young's modulus of"
    " {modulus:.6g} MPa carries without yielding",
    "for a line contact 4/pi of the mean pressure is the peak pressure. The mean pressure also contains the load on "
    "cells beside edges, which `peak_pressure` leaves out. The contact is elastic; real flanks yield below their "
    "surface, and carry the load on a wider contact",
    "give `max_pressure_MPa` or less torque, or correct the unit of an input",
)
ROOT_BEYOND_YIELD = Kind(
    "root stress of the {gear} is up to {stress:.4g} MPa, above {most:g} MPa, which no gear steel carries without "
    "yielding",
    "the computed stress is elastic; real roots yield, and their stress range in later turns is different",
    "less torque, a larger module or fillet, or correct the unit of an input",
)
UNMODIFIED_TOOTH = Kind(
    "{gear}, with its modifications: {fault}; the bending is that of the tooth without modifications",
    "the tooth with its modifications cannot be meshed with elements, for instance where it is pointed. The contact "
    "has the modifications, the bending has not",
    "smaller amounts of the modifications; the compliance is that of a tooth a few hundredths of a millimetre thicker",
)
FACE_ELEMENTS = Kind(
    "root stress of the {gear}: the elements along its face are {width:.2g} modules wide; where a contact covers only"
    " a part of the face, root stress is too low, by a tenth with elements of 2 modules",
    "the face is so wide that only few elements lie along it",
    "use root stress under a contact of the whole face; under a contact of a part of it the real root stress is higher",
)
LARGE_MOTIONS = Kind(
    "gears on their supports move by up to {way:.3g} mm and tilt by up to {tilt:.3g} mrad, more than {modules:g} "
    "modules or {most:g} mrad: the supports, which are linear, are so soft that the gears hardly mesh",
    "motions of that size shift the contact by a part of the tooth; a stiffness may have another unit than was meant",
    "stiffer supports, less torque, or the right unit of compliance and stiffness: mm, rad, N, N mm",
)
SUPPORT_MOMENT = Kind(
    "the forces on the supports of the pinion have a moment about its axis that differs by {part:.1%} from its torque",
    "all over the contact the forces have the direction of the normal at the contact point. On flanks whose normal "
    "turns within the contact, as on those of hypoid pairs, motions of the gears and forces on bearings are off by "
    "about that percentage",
    "take motions and forces on bearings as exact to that percentage only; less torque makes the contact shorter",
)
EXTREME_AT_EDGE = Kind(
    "tribology: the {extreme} lies at an edge of a flank, where it is that of a line contact with the curvature of "
    "the flank beside the edge, or of its arc",
    "slices that reach a tip or a face end produce real heat, but their pressure rises towards the edge: film and "
    "flash temperature there are indicative only",
    "read the numbers of slices away from edges (column `on_edge` in the table of `slices`); tip or end relief; an "
    "edge with a radius",
)
EXTREME_MOVES = Kind(
    "tribology: from every second position alone the {extreme} differs by {change:.1%}",
    "the extreme lies in a corner of the path of contact, or in few positions: more positions may find a worse one, "
    "by up to half that percentage",
    "more `positions`: 17 and more for corners of helical gears",
)
SLICES_AT_CAP = Kind(
    "tribology: the pressure of slices is cut at the cap on the pressure",
    "flash temperature and film follow the cut pressure, while the force of the slices is not cut",
    "less torque, or a scene without `max_pressure_MPa`",
)
COLD_BULK = Kind(
    "tribology: the bulk temperature, {bulk:g} °C, is below the temperature of the oil, {oil:g} °C",
    "teeth that transmit power are warmer than the oil that cools them",
    "exchange both temperatures, or leave `bulk_temperature_C` out",
)
PITCH_VELOCITY = Kind(
    "tribology: the pitch line velocity, {velocity:.3g} m/s, is outside {low:g} to {high:g} m/s",
    "the coefficients of friction of the standards were fitted within this range",
    "give `friction` as a number from a test",
)
EDGES_NOT_RATED = Kind(
    "rating: local safeties of flanks leave edges out, whose pressure is {pressure:.0f} MPa under {torque}, on pairs "
    "that carry 0.1% of the torque or more, beside a peak pressure of {peak:.0f} MPa, {accuracy}",
    "local safeties follow from slices of the flanks away from edges, as `peak_pressure` does. A sharp edge has no "
    "finite pressure, and allowable stresses are not those of edges. The pitting that an edge adds is not rated",
    "tip or end relief that takes the load from the edge, as the finding of the summary says. A radius makes "
    "`edge_pressure` finite, and local safeties stay the same; safeties after the standard have no edges",
)
ABOVE_STATIC_STRENGTH = Kind(
    "rating: {where}: the stress {stress:.0f} MPa is above the static strength {strength:.0f} MPa under {torque}, "
    "beyond which the standard does not apply",
    "a tooth may yield or break in the first load cycle, so that safeties there are no measure of a life. The life is"
    " given as 0",
    "a smaller torque or `operation.application_factor`, other allowable stresses, or a larger pair",
)
SPECTRUM_BETWEEN = Kind(
    "rating: the damage of the spectrum may be wrong by {change:.1%}, since stresses are interpolated between {count}"
    " analysed torques",
    "damage grows with a high power of the stress, and the curve of the stress over the torque bends where contacts "
    "come to edges, reliefs and further tooth pairs. The error is estimated by leaving out every second torque, and "
    "by how much the results of analysed torques scatter",
    "more torques in `analysis.torques_Nm`, up to the largest of the spectrum; where their results scatter, more "
    "`cells`",
)
SPECTRUM_UNKNOWN = Kind(
    "rating: the damage of the spectrum has no estimate of its error: {count} analysed torques of at least {fewest}",
    "damage grows with a high power of the stress, and the curve of the stress over the torque bends where contacts "
    "come to edges, reliefs and further tooth pairs. The estimate leaves out every second torque, which takes "
    "four of them",
    "more torques in `analysis.torques_Nm`, up to the largest of the spectrum",
)
NARROW_FACE = Kind(
    "the face is {width:.2g} modules wide, less than {least:g}: K_Hbeta has no bound of its error",
    "each end of the face is softened as if the other end were far away, so that the load of a narrow face crowds at "
    "both: K_Hbeta of an even load is up to 1.1 on faces of 0.6 modules and 2 on 0.1 modules instead of 1",
    "take K_Hbeta and pressures near the ends as estimates only, or use finite elements",
)
CONSTANT_LOADS = Kind(
    "the loads on the shaft of the {gear} are the same under all {count} torques",
    "`[[pinion.shaft.loads]]` and `[[wheel.shaft.loads]]` have one value each. Forces of other stages on a shaft grow "
    "with the torque: under other torques than theirs the tilt of the gear, K_Hbeta and pressures are wrong, and so is "
    "the damage of their bins",
    "one scene for each torque, each with its own loads; of a gearbox model `loaded-tca import --torque` or "
    "`--load-case`. Loads that do not depend on the torque, as those of belts or weights, are right",
)
PITCH_DEVIATIONS = Kind(
    "the gears have runout or teeth that differ; an analysis of one pitch leaves this out and takes all teeth as alike",
    "pitch deviations, flanks of single teeth and eccentricity repeat with each turn of their gear, not with each "
    "pitch",
    "`loaded-tca revolution`, or `analyse_revolution`",
)
INDEX_OF_ONE_SIDE = Kind(
    "{key}: deviations of the flanks of the drive side are kept on the coast side",
    "either side of the teeth has index deviations of its own. A tooth that stands elsewhere as a whole is set back on "
    "one side and stands forward on the other; the same deviation on both sides is that of a thinner tooth",
    "give the deviations of the other side: `scene.coast_side().with_changes({key: values})`. An analysis of one pitch "
    "leaves them out, runout holds for both sides",
)
OPEN_REVOLUTION = Kind(
    "{pitches} pitches are no whole turn of the {gear}, whose teeth deviate: both ends of the curve do not meet, so "
    "that orders of the gears mix, and deviations hold for this part of the turn only",
    "amplitudes of a curve that is not closed leak into neighbouring orders, whichever gear these are named after; "
    "spans hold for the part of the turn that was analysed",
    '`pitches = "hunting"`, or a multiple of the number of teeth of that gear',
)
WEAK_SETTINGS = Kind(
    "settings from measured flanks: together the following changes alter the flanks by only {effect} um, though each "
    "of them alone alters the flanks by up to 10 um: {changes}",
    "noise of the measurement turns into large corrections that cancel each other: the deviations that remain are "
    "small, but the settings are not those of the machine",
    "fewer settings, limits for their changes, or measurements of both flanks of the gear; compare the standard "
    "deviations of the settings",
)
SHARES_OF_HALVES = Kind(
    "the shares of the halves are off by up to {error:.1%} of the torque, since they lie between the torques for "
    "which the halves were analysed",
    "the curve of the deflection over the torque bends where contacts come to edges, reliefs and further tooth pairs."
    " The error is estimated from how much compliances and deflections of neighbouring torques disagree",
    "a gear that floats, two halves that are alike, or more crowning and relief, so that contacts stay off the edges",
)
DEFLECTION_OF_HALVES = Kind(
    "the deflection of both halves together is off by up to {error:.1%}, since it lies between the torques for which "
    "the halves were analysed",
    "the transmission error is off by this part of the deflection under load, which is much of its span over the pitch."
    " The error is estimated from how much compliances and deflections of neighbouring torques disagree",
    "a gear that floats, two halves that are alike, or more crowning and relief, so that contacts stay off the edges",
)
SHUTTLES = Kind(
    "the {gear} shuttles along its axis by up to {way:.3g} um from its mean place, more than a thousandth of the "
    "width of a half",
    "flanks are analysed with the floating gear at its mean place. In reality ends of the faces, crowning and reliefs"
    " move with the gear by as much. Pressures leave this out; the axial motion itself and the shares contain it",
    "smaller apex runout and slopes; see how the face load factor changes with a `pair.apex_offset_mm` of that size",
)
MEASURED_HALF = Kind(
    "half {half} of the {gear} has a measured flank, the other half has none, and both gears are held along their "
    "axes: the measured flank is turned onto its pitch point, so that the shares leave out its place against the "
    "other half",
    "a measured flank is turned until it passes through the pitch point: its deviation at the pitch point, which is a"
    " shift of the apex, is left out of the shares and of the transmission error",
    "`pair.apex_offset_mm` for the apex as measured, modifications of the same size, or a gear that floats freely",
)

KINDS = tuple(one for one in globals().values() if isinstance(one, Kind))
"""Of every accuracy warning of an analysis, of derivatives of its result, of its tribology and its rating."""


def kind_of(sentence: str) -> Kind | None:
    """Return the kind of an accuracy warning; None of one that another package gave.

    Examples
    --------
    >>> kind_of("the contact reaches the border of its grid (at 1 of 9 pressure maps; the first: ...)").advice[:11]
    'less torque'
    """
    return max((one for one in KINDS if one.words in sentence), key=lambda one: len(one.words), default=None)
