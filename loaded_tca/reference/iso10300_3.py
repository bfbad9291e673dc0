"""Tooth root stress of bevel and hypoid pairs after ISO 10300-3, method B1.

Load at the tip of the virtual gears in the normal section; the section of 30 degrees as in ISO 6336-3; factors for load
sharing and for contact lines that lie across the tooth. Edition of 2023, whose text was not seen: formulas and their
numbers as in ``iso10300_1``, checked against samples 1 to 4 of ISO/TR 10300-30:2024. What roots withstand has the
factors of ISO 6336-3 (``iso6336_3.root_factors``) with q_s and Y_Sa of here, and Y_R_relT with ``of_bevels``.
"""

from __future__ import annotations

from math import acos, cos, pi, sin, sqrt, tan

from loaded_tca.arguments import checked
from loaded_tca.errors import GeometryError, require, require_positive
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_3 import RootSection, fillet_section
from loaded_tca.reference.iso10300_1 import VirtualPair

_ROUNDING = 1e-12  # m_mn, of a rounding that fills the slot


@checked
def tip_section(
    teeth: float,
    tip_diameter: float,
    *,
    tool_depth: float,
    edge_radius: float,
    profile_shift: float,
    thickness_shift: float,
    pressure_angle: float,
    effective_pressure_angle: float | None = None,
    coast: tuple[float, float] | None = None,
    protuberance: float = 0.0,
    generated: bool = True,
) -> RootSection:
    r"""Critical section of a tooth with the load at its tip, in mean normal modules.

    .. math::
        E = \frac{\pi}{4} - x_{sm} - h_{a0} \tan\alpha_e - \varrho_{a0} \frac{1 - \sin\alpha_e}{\cos\alpha_e}
            - s_{pr}, \qquad G = \varrho_{a0} - h_{a0} + x_{hm}

    and on as :func:`loaded_tca.reference.iso6336_3.root_section`, with the mean chord s_Fn of both sides of the tooth.
    Teeth of a wheel that is not generated have straight flanks, with the pressure angle alpha_n in E and

    .. math::
        s_{Fn} = \pi - 2 E - 2 \varrho_{a0} \cos 30°, \qquad
        h_{Fa} = h_{a0} - \tfrac12 \varrho_{a0} + h_{am} - x_{hm}
                 - \left(\frac{\pi}{4} + x_{sm} - (h_{am} - x_{hm}) \tan\alpha_n\right) \tan\alpha_n

    Parameters
    ----------
    teeth : float
        z_vn.
    tip_diameter : float
        d_van/m_mn.
    tool_depth, edge_radius : float
        h_a0/m_mn, from the basic rack's datum line; rho_a0/m_mn.
    profile_shift, thickness_shift : float
        x_hm; x_sm, with half the backlash in it where the tooth is thinner for that.
    pressure_angle, effective_pressure_angle : float [rad]
        alpha_n; alpha_e, the same unless it is given.
    coast : (float, float) or None
        Of the side that is not loaded: z_vn and the angle [rad], alpha_e of generated teeth and alpha_n of others; as
        of the loaded side unless given.
    protuberance : float
        s_pr/m_mn.
    generated : bool
        Whether the gear rolls as it is cut; formate wheels do not.

    Raises
    ------
    InputError
        If a value is out of range; every one is told.
    GeometryError
        If there is no such section.

    References
    ----------
    ISO 10300-3:2023, formulas (6) to (26). The lever of the straight tooth follows from its geometry; it is formula
    (22) where h_am - x_hm is m_mn. Generated teeth become it as their number grows.

    Examples
    --------
    Sample 3, pinion; printed Y_Fa 2.102, Y_Sa 1.988:

    >>> from math import radians
    >>> section = tip_section(18.988, 88.162 / 4.028, tool_depth=1.25, edge_radius=0.8 / 4.028, profile_shift=0.45,
    ...                       thickness_shift=0.04, pressure_angle=radians(15.868),
    ...                       effective_pressure_angle=radians(20.0))
    >>> round(section.form_factor, 3), round(section.stress_correction_factor, 3)
    (2.102, 1.988)
    """
    effective = pressure_angle if effective_pressure_angle is None else effective_pressure_angle
    alpha = effective if generated else pressure_angle
    coast_teeth, coast_angle = (teeth, alpha) if coast is None else coast
    angles = {"pressure_angle": pressure_angle, "effective_pressure_angle": effective, "coast": coast_angle}
    require_positive(
        teeth=teeth, tip_diameter=tip_diameter, tool_depth=tool_depth, edge_radius=edge_radius, coast=coast_teeth
    )
    require(
        *((0.0 < each < 0.25 * pi, f"{name}: {each} rad is not between 0 and 45 deg") for name, each in angles.items()),
        (tool_depth > profile_shift, f"profile_shift: {profile_shift} leaves no dedendum below {tool_depth}"),
        (0.0 <= protuberance < 1.0, f"protuberance: {protuberance} m_mn; allowed 0 to below 1"),
    )
    middle = 0.25 * pi - thickness_shift - protuberance
    gaps = [
        middle - tool_depth * tan(each) - edge_radius * (1.0 - sin(each)) / cos(each) for each in (alpha, coast_angle)
    ]
    if sum(gaps) < -_ROUNDING:
        raise GeometryError(f"edge_radius: {plain(edge_radius)} m_mn does not fit on the bottom of the slot")
    if not generated:
        above = 0.5 * (tip_diameter - teeth) - profile_shift
        lever = tool_depth - 0.5 * edge_radius + above
        lever -= (0.25 * pi + thickness_shift - above * tan(alpha)) * tan(alpha)
        thickness = pi - sum(gaps) - sqrt(3.0) * edge_radius
        return _section(thickness, lever, edge_radius, alpha, pressure_angle)
    base = teeth * cos(alpha)
    if tip_diameter <= base:
        raise GeometryError(f"tip_diameter: {plain(tip_diameter)} m_mn lies inside the base circle")
    depth = edge_radius - tool_depth + profile_shift
    angle, thickness, radius, below = fillet_section(gaps[0], depth, edge_radius, teeth)
    if coast is not None:
        thickness = 0.5 * (thickness + fillet_section(gaps[1], depth, edge_radius, coast_teeth)[1])
    at_tip = acos(base / tip_diameter)
    half = (0.5 * pi + 2.0 * (profile_shift * tan(alpha) + thickness_shift)) / teeth
    half += tan(alpha) - alpha - tan(at_tip) + at_tip
    load = at_tip - half
    height = (cos(half) - sin(half) * tan(load)) * tip_diameter
    lever = 0.5 * (height - teeth * cos(pi / 3.0 - angle) - below)
    return _section(thickness, lever, radius, load, pressure_angle)


def _section(thickness: float, lever: float, radius: float, load_angle: float, pressure_angle: float) -> RootSection:
    if not (thickness > 0.0 and lever > 0.0 and radius > 0.0):
        raise GeometryError(
            f"no critical section: thickness {plain(thickness)}, lever {plain(lever)}, radius {plain(radius)} m_mn"
        )
    return RootSection(thickness, lever, radius, load_angle, pressure_angle)


@checked
def contact_ratio_factor(pair: VirtualPair) -> float:
    r"""Contact ratio factor Y_eps, from the tip to the decisive point of load.

    .. math:: Y_\varepsilon = Y_{\varepsilon\alpha} - \varepsilon_{v\beta} (Y_{\varepsilon\alpha} - 0.625), \qquad
              Y_{\varepsilon\alpha} = 0.25 + \frac{0.75}{\varepsilon_{v\alpha}}

    0.625 from an overlap ratio of 1 on.

    References
    ----------
    ISO 10300-3:2023, formulas (27) to (29).
    """
    profile, face = pair.contact_ratios
    without = 0.25 + 0.75 / profile
    return without - min(max(face, 0.0), 1.0) * (without - 0.625)


@checked
def bevel_spiral_angle_factor(pair: VirtualPair, whole_depths: tuple[float, float]) -> float:
    r"""Bevel spiral angle factor Y_BS: contact lines across the tooth load a part of its root.

    .. math::
        Y_{BS} = \frac{a_{BS}}{c_{BS}} \left(\frac{l_{bb}}{b_a} - 1.05\,b_{BS}\right)^2 + 1, \qquad
        b_a = \frac{b_v}{\cos\beta_v}, \quad l_{bb} = \frac{l_{bm} \cos\beta_{vb}}{\cos\beta_v}

    with quadratic fits of a_BS, b_BS and c_BS over b_a by the mean of both depths. 1 of straight and zerol teeth, for
    which the standard has not validated it.

    Parameters
    ----------
    pair : VirtualPair
    whole_depths : (float, float) [mm]
        h_m of pinion and wheel.

    References
    ----------
    ISO 10300-3:2023, formulas (30) to (35).
    """
    first, second = whole_depths
    require_positive(pinion_depth=first, wheel_depth=second)
    if pair.spiral_angle == 0.0:
        return 1.0
    long = pair.widths[1] / cos(pair.spiral_angle)
    covered = pair.contact_lines.lengths[1] * cos(pair.base_spiral_angle) / cos(pair.spiral_angle)
    slender = 2.0 * long / (first + second)
    a = (-0.0182 * slender + 0.4736) * slender - 0.32
    b = (-0.0032 * slender + 0.0526) * slender + 0.712
    c = (-0.0050 * slender + 0.0850) * slender + 0.54
    return a / c * (covered / long - 1.05 * b) ** 2 + 1.0
