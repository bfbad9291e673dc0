"""What a rating finds: name, dimensions, unit, long name of each number, factors by names of ISO 6336 and 10300."""

from __future__ import annotations

from loaded_tca.results.declared import Asked, Number
from loaded_tca.results.quantities import CYCLE_NUMBERS
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.rating import METHOD_B

CASE = ("case",)
OF_GEARS = ("case", "gear")
OF_MODES = ("case", "gear", "mode")
OF_SPECTRUM = ("gear", "mode")
OF_ROOTS = Asked(
    lambda scene, _: scene.analysis.root_stress,
    "needs root stress; set analysis.root_stress = true and run the scene",
)

_RESONANCE = {
    "resonance_ratio": "resonance ratio N",
    "resonance_ratio_of_analysis": "N with the mesh stiffness of the analysis",
}
_EXCITATION = {
    "transmission_error_span": "transmission error, peak to peak",
    "transmission_error_order_1": "transmission error, order 1 of the tooth mesh",
}
OF_CYLINDRICAL = Asked(
    lambda scene, _: isinstance(scene, CylindricalScene), "a factor of ISO 6336; bevel pairs have factors of ISO 10300"
)
OF_BEVEL = Asked(
    lambda scene, _: not isinstance(scene, CylindricalScene),
    "a factor of ISO 10300, for bevel and hypoid pairs; cylindrical pairs have factors of ISO 6336",
)

OF_METHOD_B = Asked(
    lambda scene, _: isinstance(scene, CylindricalScene) and getattr(scene.rating, "dynamic_factor", "") == METHOD_B,
    'a part of K_v of cylindrical pairs by method B; set rating.dynamic_factor = "method B"',
)
_DEVIATIONS = {
    "f_pb": "base pitch deviation f_pb",
    "y_p": "running-in allowance y_p of f_pb",
    "f_falpha": "profile form deviation f_falpha",
    "y_f": "running-in allowance y_f of f_falpha",
    "C_a": "tip relief C_a that counts for K_v",
}
_OF_DYNAMIC_FACTOR = {
    "B_p": "of K_v: B_p = c' (f_pb - y_p)/w",
    "B_f": "of K_v: B_f = c' (f_falpha - y_f)/w",
    "B_k": "of K_v: B_k = |1 - c' C_a/w|",
}

_LOADS = {
    "K_A": "application factor K_A",
    "K_gamma": "mesh load factor K_gamma",
    "K_v": "dynamic factor K_v",
    "K_Hbeta": "face load factor K_Hbeta",
    "K_Halpha": "transverse load factor K_Halpha",
    "K_Fbeta": "face load factor of roots K_Fbeta",
    "K_Falpha": "transverse load factor of roots K_Falpha",
}


def _numbers(dims: tuple[str, ...], unit: str, texts: dict[str, str], asked: Asked | None = None) -> dict[str, Number]:
    labels = {name: text if dims == CASE else "" for name, text in texts.items()}
    return {name: Number(dims, unit, text, label=labels[name], asked=asked) for name, text in texts.items()}


NUMBERS: dict[str, Number] = {
    "torque": CYCLE_NUMBERS["torque"].changed(dims=CASE, label="pinion torque"),
    **_numbers(OF_GEARS, "1", {"cycles": "load cycles N_L"}),
    **_numbers(CASE, "1", _LOADS),
    **_numbers(CASE, "kg/mm", {"reduced_mass": "reduced mass m_red for each mm of the face"}, OF_CYLINDRICAL),
    **_numbers(CASE, "1", _RESONANCE, OF_CYLINDRICAL),
    **_numbers(CASE, "N/mm", {"specific_load": "w = F_t K_A K_gamma/b, at the reference circle"}, OF_METHOD_B),
    **_numbers(CASE, "N/(mm um)", {"single_stiffness": "single stiffness c' under w"}, OF_METHOD_B),
    **_numbers(CASE, "um", _DEVIATIONS, OF_METHOD_B),
    **_numbers(CASE, "1", _OF_DYNAMIC_FACTOR, OF_METHOD_B),
    **_numbers(CASE, "um", _EXCITATION),
    **_numbers(CASE, "1", {"Z_H": "zone factor Z_H"}, OF_CYLINDRICAL),
    **_numbers(CASE, "1", {"Z_MB": "mid-zone factor Z_M-B", "Z_LS": "load sharing factor Z_LS"}, OF_BEVEL),
    "Z_E": Number(CASE, "MPa^0.5", "elasticity factor Z_E", column="Z_E", label="elasticity factor Z_E"),
    **_numbers(
        CASE, "1", {"Z_eps": "contact ratio factor Z_eps", "Z_beta": "helix angle factor Z_beta"}, OF_CYLINDRICAL
    ),
    **_numbers(OF_GEARS, "1", {"Z_BD": "single contact factors Z_B, Z_D"}, OF_CYLINDRICAL),
    **_numbers(CASE, "MPa", {"sigma_H0": "nominal contact stress sigma_H0"}),
    **_numbers(OF_GEARS, "MPa", {"sigma_H": "contact stress sigma_H", "sigma_H_lim": "sigma_H_lim"}),
    **_numbers(
        OF_GEARS,
        "1",
        {
            "Z_NT": "life factor Z_NT",
            "Z_L": "lubricant factor Z_L",
            "Z_v": "velocity factor Z_v",
            "Z_R": "roughness factor Z_R",
            "Z_W_reference": "work hardening factor Z_W",
            "Z_W_static": "work hardening factor Z_W, static",
            "Z_X": "size factor Z_X",
        },
    ),
    **_numbers(CASE, "1", {"Z_KP": "bevel gear factor Z_KP", "Z_Hyp": "hypoid factor Z_Hyp"}, OF_BEVEL),
    **_numbers(
        OF_GEARS,
        "MPa",
        {
            "sigma_HG_static": "pitting strength, static",
            "sigma_HG_reference": "pitting strength, reference",
            "sigma_HG": "pitting strength sigma_HG at N_L",
        },
    ),
    **_numbers(OF_GEARS, "1", {"flank_safety": "safety against pitting S_H"}),
    **_numbers(
        OF_GEARS,
        "1",
        {
            "Y_F": "form factor Y_F",
            "Y_S": "stress correction factor Y_S",
            "Y_beta": "helix angle factor Y_beta",
            "Y_B": "rim thickness factor Y_B",
            "Y_DT": "deep tooth factor Y_DT",
        },
        OF_CYLINDRICAL,
    ),
    **_numbers(
        OF_GEARS,
        "1",
        {"Y_Fa": "form factor Y_Fa, load at the tip", "Y_Sa": "stress correction factor Y_Sa, load at the tip"},
        OF_BEVEL,
    ),
    **_numbers(
        CASE,
        "1",
        {
            "Y_eps": "contact ratio factor Y_eps",
            "Y_BS": "bevel spiral angle factor Y_BS",
            "Y_LS": "load sharing factor Y_LS",
        },
        OF_BEVEL,
    ),
    **_numbers(
        OF_GEARS,
        "MPa",
        {"sigma_F0": "nominal root stress sigma_F0", "sigma_F": "root stress sigma_F", "sigma_F_lim": "sigma_F_lim"},
    ),
    **_numbers(
        OF_GEARS,
        "1",
        {
            "Y_ST": "stress correction factor of test gears Y_ST",
            "Y_NT": "life factor Y_NT",
            "Y_delta_relT": "relative notch sensitivity Y_delta_relT",
            "Y_delta_relT_static": "relative notch sensitivity, static",
            "Y_R_relT": "relative surface factor Y_R_relT",
            "Y_X": "size factor Y_X",
            "Y_M": "mean stress influence factor Y_M",
            "Y_M_static": "mean stress influence factor Y_M, static",
        },
    ),
    **_numbers(
        OF_GEARS,
        "MPa",
        {
            "sigma_FG_static": "root strength, static",
            "sigma_FG_reference": "root strength, reference",
            "sigma_FG": "root strength sigma_FG at N_L",
        },
    ),
    **_numbers(OF_GEARS, "1", {"root_safety": "safety against tooth breakage S_F"}),
    **_numbers(CASE, "MPa", {"local_flank_stress": "local: largest contact pressure with K_A K_gamma K_v"}),
    **_numbers(
        OF_GEARS,
        "mm",
        {
            "local_flank_radius": "local: radius of this place, of a rack its height above the reference line",
            "local_flank_axial": "local: axial coordinate of this place",
        },
    ),
    **_numbers(OF_GEARS, "1", {"local_flank_safety": "local: safety against pitting"}),
    **_numbers(
        OF_GEARS,
        "MPa",
        {"local_root_stress": "local: root tension with K_A K_gamma K_v at the place that decides"},
        OF_ROOTS,
    ),
    **_numbers(OF_GEARS, "rad", {"local_root_angle": "local: tangent angle of this place"}, OF_ROOTS),
    **_numbers(OF_GEARS, "mm", {"local_root_axial": "local: axial coordinate of this place"}, OF_ROOTS),
    **_numbers(OF_GEARS, "1", {"local_stress_ratio": "local: smallest over largest stress R"}, OF_ROOTS),
    **_numbers(
        OF_GEARS,
        "1",
        {
            "local_Y_M": "local: mean stress influence factor Y_M",
            "local_Y_M_static": "local: mean stress influence factor Y_M, static",
        },
        OF_ROOTS,
    ),
    **_numbers(OF_GEARS, "MPa", {"local_sigma_FG": "local: root strength sigma_FG at N_L"}, OF_ROOTS),
    **_numbers(OF_GEARS, "1", {"local_root_safety": "local: safety against tooth breakage"}, OF_ROOTS),
    "damage": Number(OF_MODES, "1", "damage in the required life at the required safety"),
    "life_hours": Number(OF_MODES, "h", "life at the required safety, of the load case alone", column="life_h"),
}
"""Names in ``Rating.dataset``, and what each is, in the order of the summary."""
UNDER_LOAD = (
    *(name for name in _LOADS if name != "K_A"),
    *_RESONANCE,
    "specific_load",
    "single_stiffness",
    *_DEVIATIONS,
    *_OF_DYNAMIC_FACTOR,
    *_EXCITATION,
    *(
        f"local_{name}"
        for name in ("flank_radius", "flank_axial", "root_angle", "root_axial", "stress_ratio", "Y_M", "Y_M_static")
    ),
)
"""Numbers that nothing has without a torque: those of idle bins and idle halves are not known."""
OF_LOADED_FLANKS = (
    "sigma_H",
    "flank_safety",
    *(f"local_flank_{name}" for name in ("stress", "radius", "axial", "safety")),
)
"""Numbers of the flanks that a load case presses on: not known of those that are not analysed."""
SPECTRUM_NUMBERS: dict[str, Number] = {
    "torque": NUMBERS["torque"],
    "pinion_speed": Number(CASE, "rpm", "pinion speed", label="pinion speed"),
    "hours": Number(CASE, "h", "hours in the required life", column="hours", label="hours in the required life"),
    "reversed": Number(CASE, "1", "whether the torque is reversed", label="torque reversed (1: yes, 0: no)"),
    **{name: number for name, number in NUMBERS.items() if name not in ("torque", "life_hours")},
    "miner_sum": Number(OF_SPECTRUM, "1", "damage of all bins in the required life at the required safety"),
    "life_hours": Number(OF_SPECTRUM, "h", "life under the spectrum at the required safety", column="life_h"),
    "spectrum_safety": Number(OF_SPECTRUM, "1", "safety in the required life"),
    "equivalent_torque": Number(OF_SPECTRUM, "N mm", "equivalent pinion torque"),
    "interpolation_error": Number(OF_SPECTRUM, "1", "estimated error of the damage, by interpolation between torques"),
}
"""The same of a load spectrum, whose bins are the cases."""
