"""Gear pairs that the tests of the geometry share, and what is computed about them apart from the package."""

import math

import numpy as np
from hypothesis import strategies as st

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.modification import NO_POLYNOMIAL
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.unloaded import trace_contact

NONE = FlankModifications()


def cylindrical_mesh(teeth=(34, 57), module=3.0, width=25.0, helix_deg=0.0, shifts=(0.0, 0.0), distance=None, **gear):
    """Pinion of the helix angle given, right-handed if positive, and its mating gear."""
    gears = [
        CylindricalGear(
            z, module, width, helix_angle=math.radians(sign * helix_deg), profile_shift=x, name=name, **gear
        )
        for z, sign, x, name in zip(teeth, (1, -1), shifts, ("pinion", "wheel"), strict=True)
    ]
    return CylindricalMesh(*gears, distance)


def gear_pair(
    pinion=NONE,
    wheel=NONE,
    mounting=None,
    driving="pinion",
    sense="positive",
    materials=(Material(), Material()),
    **mesh,
):
    return cylindrical_pair(
        cylindrical_mesh(**mesh),
        modifications=(pinion, wheel),
        materials=materials,
        mounting=mounting or Mounting(),
        driving=driving,
        sense=sense,
    )


def sam_paper(helix_deg=0.0, **changes):
    """The crowned pair of the SAM paper: its Hertz ellipse is a little shorter than the face."""
    return gear_pair(FlankModifications(lead_crowning=0.005), helix_deg=helix_deg, **changes)


SAM_PAPER_TORQUE = 130e3  # N mm; inferred, the paper prints no load


def amounts(largest):
    return st.one_of(st.just(0.0), st.floats(1e-6, largest))


@st.composite
def modifications(draw, gear, active):
    """Every modification, each present or not, within the active profile and the face."""
    low, high = 2.0 * active.start_radius, 2.0 * active.end_radius
    slope = st.one_of(st.just(0.0), st.floats(-0.03, 0.03))
    profile = gear.roll_length(active.end_radius) - gear.roll_length(active.start_radius)
    return FlankModifications(
        lead_crowning=draw(amounts(0.05)),
        lead_crowning_form=draw(st.sampled_from(["parabolic", "circular", "logarithmic"])),
        end_relief=draw(amounts(0.03)),
        end_relief_length=draw(st.floats(0.1, 0.5)) * gear.face_width,
        profile_crowning=draw(amounts(0.03)),
        tip_relief=draw(amounts(0.05)),
        tip_relief_start=low + (high - low) * draw(st.floats(0.3, 0.95)),
        tip_relief_form=draw(st.sampled_from(["parabolic", "linear"])),
        root_relief=draw(amounts(0.05)),
        root_relief_start=low + (high - low) * draw(st.floats(0.05, 0.6)),
        root_relief_form=draw(st.sampled_from(["parabolic", "linear"])),
        helix_slope=draw(slope),
        profile_slope=draw(slope),
        twist=draw(slope),
        polynomial=draw(st.one_of(st.just(NO_POLYNOMIAL), polynomials(gear.face_width, profile))),
    )


@st.composite
def polynomials(draw, width, profile):
    """Coefficients a1 to a6 of amounts up to 10 um at the edges of the flank, hollow ones too."""
    x, y = 0.5 * width, 0.5 * profile
    powers = (1.0, x, y, x * y, x**2, y**2)
    return tuple(draw(st.floats(-0.01, 0.01)) / power for power in powers)


@st.composite
def reliefs(draw, module, diameters):
    """Modifications up to a hundredth of the module; reliefs start between the diameters of the active profile."""
    low, high = diameters
    most = 0.01 * module
    return FlankModifications(
        lead_crowning=draw(amounts(most)),
        lead_crowning_form=draw(st.sampled_from(["parabolic", "circular", "logarithmic"])),
        profile_crowning=draw(amounts(most)),
        tip_relief=draw(amounts(most)),
        tip_relief_start=low + (high - low) * draw(st.floats(0.3, 0.95)),
        tip_relief_form=draw(st.sampled_from(["parabolic", "linear"])),
        root_relief=draw(amounts(most)),
        root_relief_start=low + (high - low) * draw(st.floats(0.05, 0.6)),
        root_relief_form=draw(st.sampled_from(["parabolic", "linear"])),
        helix_slope=draw(st.floats(-most, most)),
        profile_slope=draw(st.floats(-most, most)),
    )


@st.composite
def meshes(draw):
    """Macro geometries that exist: no undercut from 20 teeth on."""
    return cylindrical_mesh(
        (draw(st.integers(20, 60)), draw(st.integers(20, 90))),
        3.0,
        draw(st.floats(5.0, 40.0)),
        draw(st.sampled_from([0.0, 6.0, 15.0, -20.0, 28.0])),
        (draw(st.floats(-0.1, 0.4)), draw(st.floats(-0.1, 0.4))),
    )


@st.composite
def pairs(draw):
    """Pairs of every kind: modifications of both gears, mounting errors up to 1 deg, both drives, both senses."""
    mesh = draw(meshes())
    error = st.one_of(st.just(0.0), st.floats(-math.radians(1.0), math.radians(1.0)))
    mounting = Mounting(draw(error), draw(error), draw(st.floats(-0.1, 0.1)), draw(st.floats(-2.0, 2.0)))
    return cylindrical_pair(
        mesh,
        modifications=(
            draw(modifications(mesh.pinion, mesh.pinion_active_profile)),
            draw(modifications(mesh.wheel, mesh.wheel_active_profile)),
        ),
        mounting=mounting,
        driving=draw(st.sampled_from(["pinion", "wheel"])),
        sense=draw(st.sampled_from(["positive", "negative"])),
    )


def transmission_error_at(pair, phi1, rho, z):
    """Transmission error [rad] that lets the flanks meet at points of the pinion, and whether the wheel is there.

    Written from the definitions of the frames, without the ease-off field of the package.
    """
    theta = pair.pinion.flank.theta(rho, z).value + pair.sense * phi1
    offset = np.stack([rho * np.cos(theta), rho * np.sin(theta), z + 0.0 * rho], axis=-1) - pair.wheel_origin
    x, y, along = (offset @ axis for axis in pair.wheel_axes)
    radius = np.hypot(x, y)
    lag = pair.sense * (pair.wheel.flank.theta(radius, along).value - np.arctan2(y, x)) - pair.ratio * phi1
    return np.remainder(lag + np.pi, 2.0 * np.pi) - np.pi, pair.wheel.flank.inside(radius, along)


def highest_on_grid(pair, phi1, counts=(60, 60)):
    """First touch on a dense grid: the transmission error of the point that touches first; -inf if none can [rad]."""
    rho, z = pair.pinion.flank.grid(*counts)
    lag, there = transmission_error_at(pair, phi1, rho, z)
    return pair.driving * np.where(there, pair.driving * lag, -np.inf).max()


TURNS = st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=4)
"""Positions of the pinion, in pitches."""
ROUNDING = 1e-12
"""Height of a grid point above the contact, over r_b2, that is rounding."""


def assert_certified_or_refused(draw_pair, turns):
    """No point of the flanks penetrates at any position where they touch, and a pair that is refused says why."""
    try:
        pair = draw_pair()
        angles = np.array(turns) * pair.pitch
        path = trace_contact(pair, angles, warn=False)
    except (GeometryError, InputError) as error:
        assert_names_its_cause(str(error))
        return
    for row, angle in enumerate(angles):
        highest = highest_on_grid(pair, angle, (40, 40))
        if path.in_contact[row]:
            found = path.transmission_error[row]
            assert pair.driving * (highest - found) <= ROUNDING, "no point of the flanks penetrates"
        else:
            assert not np.isfinite(highest), "the flanks cover a common region"


def assert_names_its_cause(message):
    """A refusal begins with what it is about: a gear, a key, or that there is no common flank."""
    about = message.partition(":")[0].partition(".")[0]
    assert about in ("pinion", "wheel", "profile_shift", "no common flank", "undercut", "centre_distance"), message
