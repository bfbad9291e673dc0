"""Tolerances of bevel and hypoid gears by accuracy grade, after ISO 17485:2006.

Formulas instead of tables, as in ISO 1328-1; each step from grade to grade is a factor sqrt(2). The text was not seen:
the formula gives the 12 and 26 um that sample 1 of ISO/TR 10300-30 prints, with grade 6 for the pinion and 8 for the
wheel. The ranges are those of the scope of the standard.
"""

from __future__ import annotations

from loaded_tca.arguments import checked
from loaded_tca.errors import require
from loaded_tca.plain import plain

ACCURACY_GRADES = range(2, 12)
_REFERENCE_GRADE = 4
_TEETH = (5, 400)
_DIAMETERS = (5.0, 2500.0)
_MODULES = (1.0, 50.0)


@checked
def single_pitch_tolerance(teeth: int, mean_normal_module: float, tolerance_diameter: float, grade: int) -> float:
    r"""Single pitch tolerance f_ptT [um], not rounded.

    .. math:: f_{ptT} = (0.003\,d_T + 0.3\,m_{mn} + 5)\,\sqrt{2}^{\,B - 4}

    Parameters
    ----------
    teeth : int
        z.
    mean_normal_module, tolerance_diameter : float [mm]
        m_mn; d_T, of the circle at the mean cone distance in the middle of the working depth.
    grade : int
        B, accuracy grade from 2 to 11.

    Raises
    ------
    InputError
        If a value lies outside the range of the standard; every one is told.

    References
    ----------
    ISO 17485:2006, 5.4.

    Examples
    --------
    >>> round(single_pitch_tolerance(14, 3.213, 57.97, 6)), round(single_pitch_tolerance(39, 3.213, 151.9, 8))
    (12, 26)
    """
    numbers = (
        ("teeth", teeth, _TEETH, ""),
        ("mean_normal_module", mean_normal_module, _MODULES, " mm"),
        ("tolerance_diameter", tolerance_diameter, _DIAMETERS, " mm"),
    )
    require(
        (grade in ACCURACY_GRADES, f"grade: {grade} is not one of {min(ACCURACY_GRADES)} to {max(ACCURACY_GRADES)}"),
        *(
            (
                low <= value <= high,
                f"{name}: {plain(value, 6)}{unit} is not within {plain(low, 6)} to {plain(high, 6)}{unit} of ISO 17485",
            )
            for name, value, (low, high), unit in numbers
        ),
    )
    basic = 0.003 * tolerance_diameter + 0.3 * mean_normal_module + 5.0
    return float(basic * 2.0 ** (0.5 * (grade - _REFERENCE_GRADE)))
