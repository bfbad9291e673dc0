"""What tribology finds: name, dimensions, unit, long name, and what each number needs."""

from __future__ import annotations

from loaded_tca.results.declared import CYCLE, PAIRS, Number
from loaded_tca.results.quantities import CYCLE_NUMBERS

TORQUE = ("torque",)
GEARS = (*PAIRS, "gear")

NEEDS = {
    "load_sharing": "needs the load sharing of tooth pairs; set analysis.load_sharing = true and run the scene",
    "positions": "a mean over a pitch takes five positions or more; raise analysis.positions and run the scene",
    "speed": "needs pinion_speed_rpm, or operation.pinion_speed_rpm in the scene",
    "lubricant": "needs lubricant, or [lubricant] with viscosity_100_mm2_s and oil_temperature_C in the scene",
    "roughness": "needs roughness_um, or pinion.roughness_Ra_um and wheel.roughness_Ra_um in the scene",
    "friction": 'needs friction: "local", "Xu-Kahraman" or a number; ISO/TS 6336-22 covers cylindrical gears only',
    "bulk": "needs bulk_temperature_C: the standard computes it for cylindrical gears only",
    "load_stage": "needs scuffing_load_stage, or lubricant.scuffing_load_stage in the scene",
    "permissible": "needs permissible_film_ratio, or lubricant.permissible_film_ratio in the scene",
}
"""What a number may lack, in the order in which it is told -> what the error says."""


OF_PITCH = frozenset({"load_sharing", "positions"})
SPEED = frozenset({"speed"})
FRICTION = frozenset({"friction"})
FLASH = SPEED | FRICTION
BULK = frozenset({"bulk"})
HOT = FLASH | BULK
FILM = HOT | {"lubricant"}
SCUFFING = frozenset({"lubricant", "load_stage"})

EXTREMES = {
    "largest_flash_temperature": "flash_temperature",
    "largest_contact_temperature": "contact_temperature",
    "least_film_thickness": "film_thickness",
    "least_film_ratio": "film_ratio",
    "pressure_velocity": "pressure_velocity",
}
"""Number under a torque -> number of slices whose extreme it is; least ones begin so, the others are largest."""

QUANTITIES: dict[str, Number] = {
    "loss_factor": Number(TORQUE, "1", "load loss factor H_VL", OF_PITCH, label="loss factor H_VL"),
    "mean_friction": Number(
        TORQUE,
        "1",
        "mean coefficient of friction, weighted with the loss",
        OF_PITCH | FRICTION,
        label="mean coefficient of friction",
    ),
    "mean_friction_power": Number(
        TORQUE, "W", "friction power, mean over a pitch", OF_PITCH | FLASH, label="friction power, mean"
    ),
    "efficiency": Number(
        TORQUE,
        "1",
        "1 minus the friction power over the power at the pinion",
        OF_PITCH | FRICTION,
        label="efficiency of the mesh",
        largest_is_best=True,
    ),
    "bulk_temperature": Number(TORQUE, "°C", "bulk temperature of the teeth", BULK, label="bulk temperature"),
    "largest_flash_temperature": Number(
        TORQUE, "K", "largest flash temperature", FLASH, label="largest flash temperature"
    ),
    "largest_contact_temperature": Number(
        TORQUE, "°C", "largest contact temperature", HOT, label="largest contact temperature"
    ),
    "scuffing_safety": Number(
        TORQUE,
        "1",
        "safety against scuffing by the contact temperature, S_B",
        HOT | {"lubricant", "load_stage"},
        label="safety against scuffing S_B",
        largest_is_best=True,
    ),
    "least_film_thickness": Number(
        TORQUE, "um", "least film thickness", FILM, label="least film thickness", largest_is_best=True
    ),
    "least_film_ratio": Number(
        TORQUE, "1", "least film ratio lambda_GF", FILM | {"roughness"}, label="least film ratio", largest_is_best=True
    ),
    "micropitting_safety": Number(
        TORQUE,
        "1",
        "safety against micropitting, S_lambda",
        FILM | {"roughness", "permissible"},
        label="safety against micropitting S_lambda",
        largest_is_best=True,
    ),
    "pressure_velocity": Number(
        TORQUE,
        "MPa m/s",
        "largest product of pressure and sliding velocity",
        SPEED,
        label="largest pressure times sliding velocity",
    ),
    "friction_power": Number(CYCLE, "W", "friction power of all tooth pairs", FLASH | {"load_sharing"}),
    "sliding_velocity": Number(PAIRS, "m/s", "largest sliding velocity of the tooth pair", SPEED),
    "sum_velocity": Number(PAIRS, "m/s", "sum of both rolling velocities where the pair slides most", SPEED),
    "friction": Number(PAIRS, "1", "largest coefficient of friction", FRICTION),
    "flash_temperature": Number(PAIRS, "K", "largest flash temperature", FLASH),
    "contact_temperature": Number(PAIRS, "°C", "largest contact temperature", HOT),
    "film_thickness": Number(PAIRS, "um", "least film thickness", FILM),
    "isothermal_film_thickness": Number(
        PAIRS, "um", "least film thickness without the thinning by the heat of sliding, S_GF = 1", FILM
    ),
    "film_ratio": Number(PAIRS, "1", "least film ratio lambda_GF", FILM | {"roughness"}),
    "rolling_velocity": Number(GEARS, "m/s", "rolling velocity of each gear where the pair slides most", SPEED),
    "specific_sliding": Number(GEARS, "1", "specific sliding of each gear where the pair slides most"),
    "friction_torque": Number(
        GEARS, "N mm", "torque of friction on each gear, positive in its sense of motion", FRICTION
    ),
}
"""Names in ``Tribology.dataset``, and what each is."""
PLACES: dict[str, tuple[str, str]] = {
    "position": ("1", "position, an index"),
    "pair": ("1", "tooth pair"),
    "radius": ("mm", "radius on the pinion"),
    "axial": ("mm", "axial coordinate on the pinion"),
}
"""Ends of the names of the places of extremes, as ``least_film_ratio_radius``: unit and long name."""
NUMBERS: dict[str, Number] = {
    "torque": CYCLE_NUMBERS["torque"].changed(label="pinion torque"),
    **{
        name + end: number.changed(unit=unit, text=f"{text} of the {number.text}", label="") if end else number
        for name, number in QUANTITIES.items()
        for end, unit, text in (
            ("", "", ""),
            *((f"_{end}", *about) for end, about in PLACES.items() if name in EXTREMES),
        )
    },
}
"""Names in ``Tribology.dataset`` with the torque and the places of extremes, and what each is."""

COLUMNS: dict[str, tuple[str, str, frozenset[str]]] = {
    "position": ("1", "position, an index", frozenset()),
    "pair": ("1", "tooth pair", frozenset()),
    "pinion_radius": ("mm", "radius on the pinion", frozenset()),
    "pinion_axial": ("mm", "axial coordinate on the pinion", frozenset()),
    "wheel_radius": ("mm", "radius on the wheel", frozenset()),
    "wheel_axial": ("mm", "axial coordinate on the wheel", frozenset()),
    "roll_length": ("mm", "distance from T1 along the common normal, in the transverse plane", frozenset()),
    "line_load": ("N/mm", "line load", frozenset()),
    "pressure": ("MPa", "pressure of a line contact, without K_A and K_v", frozenset()),
    "half_width": ("mm", "half width of a line contact", frozenset()),
    "relative_radius": ("mm", "radius of relative curvature across the contact", frozenset()),
    "on_edge": ("1", "whether the slice reaches the end of a flank", frozenset()),
    "pinion_specific_sliding": ("1", "specific sliding of the pinion", frozenset()),
    "wheel_specific_sliding": ("1", "specific sliding of the wheel", frozenset()),
    "pinion_wear": ("N/mm", "wear of the pinion at each mesh, over the coefficient of wear", frozenset()),
    "wheel_wear": ("N/mm", "wear of the wheel at each mesh, over the coefficient of wear", frozenset()),
    "pinion_rolling_velocity": ("m/s", "rolling velocity of the pinion", SPEED),
    "wheel_rolling_velocity": ("m/s", "rolling velocity of the wheel", SPEED),
    "sliding_velocity": ("m/s", "sliding velocity", SPEED),
    "sum_velocity": ("m/s", "sum of both rolling velocities", SPEED),
    "pressure_velocity": ("MPa m/s", "pressure times sliding velocity", SPEED),
    "friction": ("1", "coefficient of friction", FRICTION),
    "friction_power": ("W", "friction power of the slice", FLASH),
    "flash_temperature": ("K", "flash temperature", FLASH),
    "contact_temperature": ("°C", "contact temperature", HOT),
    "film_thickness": ("um", "film thickness", FILM),
    "isothermal_film_thickness": ("um", "film thickness without the thinning by heat", FILM),
    "film_ratio": ("1", "film ratio lambda_GF", FILM | {"roughness"}),
}
"""Columns of the table of slices: unit, long name, needs."""


LEAST = {"film_thickness", "isothermal_film_thickness", "film_ratio"}
"""Numbers of slices whose extreme is the least one."""


WITH_PLACES = ("largest_contact_temperature", "least_film_thickness")
"""Extremes under whose line the summary says where they lie; of the least film ratio it is the place of the film."""


def over_speed(number: Number) -> bool:
    """Whether a number has the dimension speed where several are given: it takes more than positions of a pitch."""
    return bool(number.needs - OF_PITCH)


def place_of(name: str) -> tuple[str, str]:
    """Extreme and end of the name of a place; empty where it is none."""
    extreme, _, end = name.rpartition("_")
    return (extreme, end) if extreme in EXTREMES and end in PLACES else ("", "")
