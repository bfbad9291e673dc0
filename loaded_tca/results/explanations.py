"""Accuracy warnings in plain words: what each means for the numbers, and what to do."""

from __future__ import annotations

from typing import NamedTuple


class Explanation(NamedTuple):
    """What is to be known of an accuracy warning; code in backticks.

    Attributes
    ----------
    words : str
        A part of its sentence; the first one whose words are in a sentence explains it.
    meaning, advice : str
    """

    words: str
    meaning: str
    advice: str


EXPLANATIONS = (
    Explanation(
        "the free edge is left out (analysis.free_edges)",
        "a tip or face end ends the contact; theory has an infinite pressure at a sharp edge, and the half-space goes "
        "on beyond it, which is too stiff there: K_Hbeta grows with the cells, by `face_load_factor_error` at the most",
        "`free_edges = true`; read `peak_pressure`, not `edge_pressure` or the cells of the map; more crowning, end or "
        "tip relief on the gears",
    ),
    Explanation(
        "the contact reaches an edge of a flank",
        "a tip or face end ends the contact; theory has an infinite pressure at a sharp edge",
        "read `peak_pressure`, not `edge_pressure` or the cells of the map; more crowning, end or tip relief on the "
        "gears",
    ),
    Explanation(
        "the pressure at a rounded edge has an estimated error",
        "two edges that meet askew, or a rounding much smaller than the contact, need more columns than are made; "
        "where a rounded edge meets a sharp one or the start of a linear relief, the pressure has no limit",
        "read `edge_pressure` with its error; a larger radius, or one for the sharp edge, too; a parabolic relief",
    ),
    Explanation(
        "the contact lies across the start of a linear relief",
        "the flank has a relief start there",
        '`tip_relief_form = "parabolic"`, or read `peak_pressure`, not the cells of the map',
    ),
    Explanation(
        "an edge cuts the slices of the largest line load",
        "which cells the edge leaves of a slice changes with every step of a key: analyses on both sides differ by as "
        "much as the derivative",
        "read the derivatives of the load share and of the peak pressure",
    ),
    Explanation(
        "an edge cuts the slices of the peak pressure",
        "a corner of a contact, or one that has only just come under load, has few cells: the peak follows them",
        "read the derivatives of other contacts, or compare two grids; more crowning, end or tip relief on the gears",
    ),
    Explanation(
        "edges of both gears end the contact at one place",
        "to one side of the key the pinion's end rules and to the other the wheel's, and on one of them the contact is "
        "shorter: the derivative is that of the edges that rule in the scene, and lies between those of both sides",
        "faces of two widths or an offset, so that one gear ends the contact; else analyses on both sides",
    ),
    Explanation(
        "another strip of the face carries as much",
        "K_Hbeta is the largest of 30 strips, and beyond the change by which another one becomes the largest it "
        "follows that: of an aligned pair it rises to either side",
        "analyses on both sides, or a Monte Carlo study; not the spread to first order",
    ),
    Explanation(
        "a linear relief starts in the contact beside its point",
        "the start runs through cells that have the gap of their middles: derivatives by mounting errors, machine "
        "settings and starts are off by 15 to 25 %, of either sign, and by more for line loads whose slice lies there",
        '`tip_relief_form = "parabolic"`, or compare two grids; amounts of reliefs are as exact as elsewhere',
    ),
    Explanation(
        "the estimated error of the peak pressure stays above",
        "the finest grid allowed is too coarse for the accuracy asked for; at edges and relief starts, where grids are "
        "refined until the approach agrees, the line load still moves by more than that; where the curvature of the "
        "gap jumps, the pressure beside the peak",
        "a larger `accuracy`, or `cells`; at edges a smaller `accuracy`",
    ),
    Explanation(
        "the peak pressure moves by more than",
        "the forces of the slices bend the teeth otherwise than when the grid was chosen, and the peak changed by more "
        "than its load: its error is as large",
        "fewer `cells` along the contact, or a larger `accuracy`; compare the same position a pitch later",
    ),
    Explanation(
        "the contact reaches the box of its grid",
        "the grid ends before the contact does, after it was made larger eight times: the pressure at its border is "
        "that of a body ending there",
        "less torque, or a higher `max_pressure_MPa`: a contact that outgrows its estimate 25 times over is no small "
        "area of the flank",
    ),
    Explanation(
        "is next to no torque",
        "forces below 1e-12 E* m_n² (1 µN at module 3) deform flanks by what rounding puts into their gaps",
        "nothing, or a torque that is one",
    ),
    Explanation(
        "the twist of the gear bodies about their bores",
        "with teeth that bend: bores are held rigid, and small ones let the whole body turn",
        "the `bore_diameter_mm` of the hub or shaft seat; of a pinion in one piece with its shaft none (0.55 of the "
        "root diameter)",
    ),
    Explanation(
        "fewer than 8 cells lie across the contact",
        "the grid is wide for its contact: a pair that barely carries load, or few `cells`",
        "nothing if its `load_share` is small; else more `cells`, or `accuracy`",
    ),
    Explanation(
        "the contact is so wide that the tooth is no half-space",
        "half its width is above a quarter of the module",
        "an estimate, all of it: less torque, or finite elements",
    ),
    Explanation(
        "the deflection under load is up to",
        "only pairs with a smaller one share the load; another one may come to bear under so much load",
        "less torque; else read the shares as those of too few pairs",
    ),
    Explanation(
        "fillet interference",
        "the mating gear's tip touches where the flank ends and the fillet begins",
        "tip diameters, profile shifts, or the cutter; `check` tells the diameters",
    ),
    Explanation(
        "negative backlash",
        "both flanks of a tooth touch, and the load of the back adds to that of the flank in contact; no number of the "
        "result contains it",
        "a smaller sum of profile shifts, or a larger centre distance: `check` has the sum that leaves no backlash; of "
        "bevel gears thinner teeth",
    ),
    Explanation(
        "its flank in contact is analysed all the same",
        "pressure on half-spaces needs no tooth behind the flank; a gear would have none",
        "profile shift, tip diameter, cutter, or smaller amounts of the modifications",
    ),
    Explanation(
        "the rim below its teeth is",
        "a real rim bends, and root stress on it rises by Y_B of ISO 6336-3; the bore of the model takes that strain",
        "multiply by Y_B, or finite elements of the whole gear; of a pinion in one piece with its shaft "
        "`bore_diameter_mm = 0`",
    ),
    Explanation(
        "of the flank uncovered",
        "measured points do not reach the edges",
        "results near these edges rest on no measurement",
    ),
    Explanation(
        "its continuation beyond them swings",
        "a B-spline through every point follows the noise, too, and goes on with it beyond the outermost points: near "
        "the edges the flank is no measured one",
        "`degree = 3` with `coefficients = [4, 4]`, or few more; points nearer to the edges; compare two fits",
    ),
    Explanation("misses the flank by", "the fit is coarse", "more points"),
    Explanation(
        "is its unit right?",
        "modifications are some hundredths of a millimetre",
        "the amount in the unit of its key: um in scenes, mm in Python",
    ),
    Explanation(
        "it bends like the tooth without them",
        "the modified tooth cannot be meshed, for instance where it is pointed; its contact has the modifications, its "
        "bending has not",
        "smaller amounts; the compliance is that of a tooth a few hundredths of a millimetre thicker",
    ),
    Explanation(
        "across its face elements are",
        "the face is so wide that few elements lie across it",
        "read root stress under a contact of the whole face; a contact that covers a part of it has more",
    ),
)
"""Of every accuracy warning of an analysis."""


def explanation_of(sentence: str) -> Explanation | None:
    """Return what is to be known of an accuracy warning; None of one that another package gave.

    Examples
    --------
    >>> explanation_of("the contact reaches the box of its grid (at 1 of 9 pressure maps; the first: ...)").advice[:11]
    'less torque'
    """
    return next((one for one in EXPLANATIONS if one.words in sentence), None)
