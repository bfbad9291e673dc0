"""Formulas of ISO 23509:2016 (method 0, axes that meet) and of ISO 10300-1 annex A, written apart from the package."""

from math import acos, asin, atan, cos, pi, radians, sin, sqrt, tan


def sheet(*, z, m_et, b, sigma, alpha, beta, r_c0, x_hm, k_hap, k_hfp, x_smn, j_en, taper, b1=None, c_be2=0.5):
    """Dimension sheet of a pair as a dictionary; two values are those of pinion and wheel, three toe, mean, heel.

    Numbers of formulas are those of the standard's edition of 2016.
    """
    ratio = z[1] / z[0]
    delta1 = atan(sin(sigma) / (cos(sigma) + ratio))
    delta1 = delta1 if delta1 > 0.0 else delta1 + pi
    delta = (delta1, sigma - delta1)
    r_e = m_et * z[1] / (2.0 * sin(delta[1]))
    r_m = r_e - c_be2 * b  # calculation point
    m_mn = 2.0 * r_m * sin(delta[1]) * cos(beta) / z[1]  # 116
    shift = (x_hm, -x_hm)
    h_am = [m_mn * (k_hap + x) for x in shift]  # 133, 134
    h_fm = [m_mn * (k_hfp - x) for x in shift]  # 135, 136
    clearance = m_mn * (k_hfp - k_hap)

    standard = [atan(h / r_m) for h in h_fm]
    if taper == "uniform":
        theta_f = [0.0, 0.0]
    elif taper == "standard":
        theta_f = standard
    else:  # annex C.5
        narrowing = 0.0 if r_c0 is None else r_m * sin(beta) / r_c0
        whole = radians(90.0 * m_et / (r_e * tan(alpha) * cos(beta)) * (1.0 - narrowing))
        if taper == "modified":
            whole = min(whole, 1.3 * sum(standard))
        first = whole * h_am[1] / (2.0 * m_mn * k_hap)
        theta_f = [first, whole - first]
    theta_a = theta_f[::-1]
    delta_a = [d + t for d, t in zip(delta, theta_a, strict=True)]
    delta_f = [d - t for d, t in zip(delta, theta_f, strict=True)]

    # apexes of face and root cones beyond the crossing point, 150 to 153
    t_zf2 = -(r_m * sin(theta_a[1]) - h_am[1] * cos(theta_a[1])) / sin(delta_a[1])
    t_zr2 = (r_m * sin(theta_f[1]) - h_fm[1] * cos(theta_f[1])) / sin(delta_f[1])
    t_zf1 = (-t_zr2 * sin(delta_f[1]) - clearance) / sin(delta_a[0])
    t_zr1 = (-t_zf2 * sin(delta_a[1]) - clearance) / sin(delta_f[0])

    def spiral(distance):
        """193, of the cutter's circle."""
        if r_c0 is None:
            return beta
        return asin((2.0 * r_m * r_c0 * sin(beta) - r_m**2 + distance**2) / (2.0 * distance * r_c0))

    gears = []
    for gear, width in enumerate((b if b1 is None else b1, b)):
        out, back = c_be2 * width, (1.0 - c_be2) * width
        steps = (-back, 0.0, out)
        h_a = [h_am[gear] + step * tan(theta_a[gear]) for step in steps]  # 195 to 200
        h_f = [h_fm[gear] + step * tan(theta_f[gear]) for step in steps]
        d = [2.0 * (r_m + step) * sin(delta[gear]) for step in steps]
        cosine = cos(delta[gear])
        # 201 to 215
        taken = j_en / (4.0 * m_mn * cos(alpha)) * r_m * cos(beta) / (r_e * cos(spiral(r_e)))
        x_sm = (x_smn, -x_smn)[gear] - taken
        s_mn = m_mn * (pi / 2.0 + 2.0 * (x_sm + shift[gear] * tan(alpha)))
        d_mn = d[1] / ((1.0 - sin(beta) ** 2 * cos(alpha) ** 2) * cosine) if abs(cosine) > 1e-12 else None
        gears.append(
            {
                "pitch_angle": delta[gear],
                "face_angle": delta_a[gear],
                "root_angle": delta_f[gear],
                "addenda": h_a,
                "dedenda": h_f,
                "pitch_diameters": d,
                "tip_diameters": [one + 2.0 * h * cosine for one, h in zip(d, h_a, strict=True)],
                "root_diameters": [one - 2.0 * h * cosine for one, h in zip(d, h_f, strict=True)],
                "crown_to_crossing": [
                    (r_m + step) * cosine - h * sin(delta[gear]) for step, h in zip(steps, h_a, strict=True)
                ],
                "spiral_angles": [spiral(r_m + step) for step in steps],
                "face_apex": (t_zf1, t_zf2)[gear],
                "root_apex": (t_zr1, t_zr2)[gear],
                "mean_point_to_crossing": r_m * cosine,
                "thickness_coefficient": x_sm,
                "mean_normal_thickness": s_mn,
                "virtual_diameter": d_mn,
                "chordal_thickness": None if d_mn is None else d_mn * sin(s_mn / d_mn),
                "chordal_addendum": None if d_mn is None else h_a[1] + 0.5 * d_mn * cosine * (1.0 - cos(s_mn / d_mn)),
            }
        )
    return {
        "mean_cone_distance": r_m,
        "outer_cone_distance": r_e,
        "mean_normal_module": m_mn,
        "clearance": clearance,
        "dedendum_angles": tuple(theta_f),
        "virtual_contact_ratios": contact_ratios(gears, alpha, beta, m_mn, b),
        "gears": gears,
    }


def contact_ratios(gears, alpha, beta, m_mn, b):
    """eps_va and eps_vb of the virtual cylindrical gears with 0.85 b; external ones alone (delta below 90 deg)."""
    alpha_t = atan(tan(alpha) / cos(beta))
    path = 0.0
    for gear in gears:
        if gear["pitch_angle"] >= radians(89.0):
            return None
        d_v = gear["pitch_diameters"][1] / cos(gear["pitch_angle"])
        d_va, d_vb = d_v + 2.0 * gear["addenda"][1], d_v * cos(alpha_t)
        path += 0.5 * (sqrt(d_va**2 - d_vb**2) - d_v * sin(alpha_t))
    return path * cos(beta) / (pi * m_mn * cos(alpha_t)), 0.85 * b * sin(beta) / (pi * m_mn)


def whole_depth_at_heel(gear):
    """h_t, distance of the tip at the heel from the line of the root cone."""
    axial = gear["crown_to_crossing"][2] + gear["root_apex"]
    return 0.5 * gear["tip_diameters"][2] * cos(gear["root_angle"]) - axial * sin(gear["root_angle"])


def spread_blade_slots(gear, teeth, alpha):
    """s_n and top land at toe, mean and heel where the slot is as wide everywhere as at the mean point.

    Top lands by the virtual spur gear of each section: inv after its circle.
    """

    def involute(angle):
        return tan(angle) - angle

    d = gear["pitch_diameters"]
    pitch = [pi * one * cos(beta) / teeth for one, beta in zip(d, gear["spiral_angles"], strict=True)]
    slot = pitch[1] - gear["mean_normal_thickness"] - 2.0 * gear["dedenda"][1] * tan(alpha)
    thick = [p - slot - 2.0 * h * tan(alpha) for p, h in zip(pitch, gear["dedenda"], strict=True)]
    lands = []
    for one, beta, s, h in zip(d, gear["spiral_angles"], thick, gear["addenda"], strict=True):
        d_n = one / ((1.0 - sin(beta) ** 2 * cos(alpha) ** 2) * cos(gear["pitch_angle"]))
        d_na = d_n + 2.0 * h
        lands.append(d_na * (s / d_n + involute(alpha) - involute(acos(d_n * cos(alpha) / d_na))))
    return slot, thick, lands
