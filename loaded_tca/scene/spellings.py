"""Keys of scenes as other programs, standards and drawings spell them, for messages about unknown keys."""

from __future__ import annotations

import re
from collections.abc import Container

from loaded_tca.units import INCHES, UNITS

SPELLINGS = {
    "normal_module_mm": "m mn module modulemm",
    "transverse_module_mm": "mt transversemodule",
    "diametral_pitch_per_inch": "pd dp diametralpitch diametralpitchperin diametralpitchin",
    "normal_diametral_pitch_per_inch": "pn pnd ndp normaldiametralpitch normaldiametralpitchperin",
    "transverse_diametral_pitch_per_inch": "pt ptd transversediametralpitch transversediametralpitchperin",
    "transverse_pressure_angle_deg": "alphat alft transversepressureangle",
    "pressure_angle_deg": "alpha alphan alfn alphanormal pressureangle",
    "helix_angle_deg": "beta helixangle lead",
    "centre_distance_mm": "a aw centredistance centerdistance centerdistancemm",
    "teeth": "z z1 z2 numberofteeth nteeth numteeth",
    "face_width_mm": "b b1 b2 facewidth",
    "profile_shift": "x x1 x2 xn profileshiftcoefficient addendummodification addendummodificationcoefficient",
    "tip_diameter_mm": "da da1 da2 outsidediameter tipdiameter",
    "root_diameter_mm": "df df1 df2 rootdiameter",
    "bore_diameter_mm": "di innerdiameter bore",
    "addendum_coefficient": "hap hap1 hap2 hapstar hastar addendum addendumfactor",
    "addendum_factor": "hap khap addendum addendumcoefficient",
    "dedendum_coefficient": "hfp hfp1 hfp2 hfpstar hfstar dedendum dedendumfactor wholedepth",
    "dedendum_factor": "hfp khfp dedendum dedendumcoefficient",
    "root_radius_coefficient": "rhofp rofp rhofpstar rhof filletradius rootradius rootradiusfactor",
    "tip_alteration_coefficient": "k kstar tipalteration tipshortening",
    "tip_shortening": "k kstar",
    "thickness_allowance_um": "as asn ase asi asne asni tooththicknessallowance",
    "normal_tooth_thickness_mm": "sn tooththickness normalthickness circulartooththickness arctooththickness "
    "normalcirculartooththickness normalarctooththickness",
    "span_measurement_mm": "w wk span basetangentlength",
    "ball_measurement_mm": "md mdk overballs betweenballs mob measurementoverballs dimensionoverballs mbb",
    "ball_diameter_mm": "dm dmeff balldiameter",
    "pin_measurement_mm": "mdr overpins betweenpins mop mbp measurementoverpins measurementbetweenpins "
    "measurementoverwires dimensionoverpins overwires overrollers",
    "pin_diameter_mm": "pindiameter wirediameter rollerdiameter measuringpindiameter",
    "youngs_modulus_MPa": "e emod youngsmodulus elasticmodulus",
    "poisson_ratio": "nu poisson poissonsratio",
    "pinion_torque_Nm": "t t1 torque piniontorque",
    "tip_relief_um": "ca caa calphaa tiprelief",
    "root_relief_um": "cf calphaf rootrelief",
    "lead_crowning_um": "cb cbeta crowning leadcrowning",
    "profile_crowning_um": "calpha barrelling profilecrowning",
    "helix_slope_um": "chb chbeta",
    "profile_slope_um": "cha chalpha",
}
"""Key -> spellings, without signs, spaces and capitals; one may stand for several keys, of which a scene has one."""
ENDINGS = {ending.lower() for ending in (*UNITS, *INCHES)}
"""Units behind a spelling."""


def key_meant_by(name: str, keys: Container[str]) -> str | None:
    """Key that a spelling of another program stands for, the first of ``keys``; None where it is no such spelling.

    Examples
    --------
    >>> key_meant_by("haP*", ["teeth", "addendum_coefficient"]), key_meant_by("h_fP", ["dedendum_factor"])
    ('addendum_coefficient', 'dedendum_factor')
    >>> key_meant_by("MOP_in", ["ball_measurement_mm", "pin_measurement_mm"])
    'pin_measurement_mm'
    """
    word, _, unit = name[:60].lower().rpartition("_")
    names = [name[:60].lower(), word] if unit in ENDINGS else [name[:60].lower()]
    words = [re.sub(r"[^a-z0-9]", "", each) for each in names]
    meant = (key for each in words for key, spellings in SPELLINGS.items() if key in keys and each in spellings.split())
    return next(meant, None)
