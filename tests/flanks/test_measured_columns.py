"""Columns of measuring centres: nominal points with normals, i and j, profile and helix lines, and other files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError
from loaded_tca.flanks import FlankModifications, MeasuredDeviations, MeasuredPoints, measured
from loaded_tca.flanks.base import outward_normal, unmodified
from loaded_tca.flanks.measured_columns import MOST_OF_LINE
from loaded_tca.flanks.topography import parse_topography
from loaded_tca.scene import FlankForm
from loaded_tca.scene.build import in_own_frame
from tests.flanks.test_topography import pair_of
from tests.samples.gear_pairs import gear_pair

NOMINAL = "i j x_mm y_mm z_mm nx ny nz deviation_um"


@pytest.fixture(scope="module")
def flank():
    return pair_of("spiral_bevel").wheel.flank


def excess_at(rho, z):
    return 2e-3 * np.sin(rho / 3.0) + 1e-3 * np.cos(z / 2.0)


def nominal_rows(flank, azimuth=0.4, turned=False):
    """Rows of nominal points, normals out of the material, deviations [um]; i lengthwise, j along the profile."""
    rho, z = (part[1:-1, 1:-1] for part in flank.grid(8, 12))
    theta = flank.theta(rho, z).value + azimuth
    out, around = np.stack([np.cos(theta), np.sin(theta)]), np.stack([-np.sin(theta), np.cos(theta)])
    parts = outward_normal(flank, rho, z)
    normal = np.stack([*(parts[..., 0] * out + parts[..., 1] * around), parts[..., 2]])
    columns = [rho * out[0], rho * out[1], z, *normal, 1e3 * excess_at(rho, z)]
    rows = [
        " ".join([f"{i if turned else j:2d}", f"{j if turned else i:2d}", *(f"{part[i, j]:.12g}" for part in columns)])
        for i, j in np.ndindex(rho.shape)
    ]
    return "\n".join([NOMINAL, *rows])


@pytest.mark.parametrize("turned", [False, True])
def test_nominal_points_with_normals_are_points_of_the_measured_flank(flank, turned):
    """Deviations come back, whichever of i and j runs along the tooth, and at any azimuth."""
    topography = parse_topography(nominal_rows(flank, turned=turned))
    assert isinstance(topography, MeasuredPoints)
    assert topography.radius.shape == (6, 10)
    excess = topography.excess_over(flank, turned=True)
    asked = excess_at(topography.radius, topography.axial)
    # mm; a point is moved along its normal by 3 um where the flank turns by 1 / 10 mm
    assert_allclose(excess, asked, atol=3e-3**2 / 10.0)


def test_nominal_points_turn_into_the_frame_of_the_gear_with_the_measured_ones():
    points = np.arange(12.0).reshape(2, 2, 3)
    there = in_own_frame(MeasuredPoints(points + 1e-3, nominal=points), -1)
    assert_allclose(there.nominal, points * np.array([1.0, -1.0, -1.0]))
    assert_allclose(there.points - there.nominal, 1e-3 * np.array([1.0, -1.0, -1.0]) * np.ones((2, 2, 1)), rtol=1e-9)
    with pytest.raises(InputError, match=r"nominal: shape \(2, 1, 3\); allowed \(2, 2, 3\)"):
        MeasuredPoints(points, nominal=points[:, :1])


def test_nominal_points_without_normals_are_places_of_deviations():
    text = "x_mm;y_mm;z_mm;removed_um\n" + "3;4;1;-2\n" * 4
    topography = parse_topography("# points = 2 x 2\n" + text)
    assert isinstance(topography, MeasuredDeviations)
    assert_allclose(topography.radius, 5.0)
    assert_allclose([topography.axial, 500.0 * topography.excess], 1.0)


RADII, PLACES = np.linspace(49.0, 54.0, 9), np.linspace(-11.0, 12.0, 15)


def lines_text(up, along, radius=51.0, axial=2.0, separator=","):
    rows = [("profile", r, axial, up(r)) for r in RADII[::-1]] + [("Helix", radius, z, along(z)) for z in PLACES]
    return separator.join(["line", "radius_mm", "axial_mm", "deviation_um"]) + "".join(
        "\n" + separator.join(map(str, row)) for row in rows
    )


def test_two_lines_make_a_flank_of_their_sum():
    """A slope of the profile and a crowning along the face, whose lines have zeros of their own."""
    topography = parse_topography(
        lines_text(lambda r: 3.0 + 2.0 * (r - 51.0), lambda z: -7.0 - 0.05 * (z**2 - 4.0), separator="\t")
    )
    assert_allclose(topography.radius[:, 0], RADII)
    assert_allclose(topography.axial[0], PLACES)
    radius, axial = np.meshgrid(RADII, PLACES, indexing="ij")
    sum_of_both = 2.0 * (radius - 51.0) - 0.05 * (axial**2 - 4.0)
    # um; the helix line is straight between its points, where the lines cross: a bend of 0.1 over 1.64 mm
    assert_allclose(1e3 * topography.excess, sum_of_both, atol=0.05 * 1.65**2 / 4.0)
    assert np.ptp(1e3 * topography.excess - sum_of_both) < 1e-9


def test_flank_of_two_lines_of_a_modified_gear_is_that_gear():
    pair = gear_pair(FlankModifications(lead_crowning=0.01, profile_slope=0.004), helix_deg=15.0)
    flank = pair.pinion.flank
    rho, z = (part[1:-1, 1:-1] for part in flank.grid(11, 17))
    removed = flank.removal(rho, z).value
    rows = [f"profile,{rho[i, 7]},{z[i, 7]},{-1e3 * removed[i, 7]}" for i in range(rho.shape[0])]
    rows += [f"helix,{rho[4, j]},{z[4, j]},{-1e3 * removed[4, j]}" for j in range(rho.shape[1])]
    topography = parse_topography("\n".join(["line,radius_mm,axial_mm,deviation_um", *rows]))
    again = measured(unmodified(flank), topography)
    off = again.theta(rho, z).value - flank.theta(rho, z).value
    turn = off.mean()  # the zero of the lines
    assert_allclose((off - turn) / flank.gradient_norm(rho, z).value, 0.0, atol=1e-9)  # mm


def test_long_lines_are_thinned_by_means():
    radii, places = np.linspace(49.0, 54.0, 480), np.linspace(-12.0, 12.0, 400)
    rows = [f"profile,{r},0,{r}" for r in radii] + [f"lead,51,{z},{2 * z}" for z in places]
    topography = parse_topography("line,radius_mm,axial_mm,deviation_um\n" + "\n".join(rows))
    assert topography.radius.shape == (MOST_OF_LINE, MOST_OF_LINE)
    assert_allclose(1e3 * topography.excess, topography.radius - 51.0 + 2.0 * topography.axial, atol=1e-9)


ROWS = "\n".join(f"{k % 2} {k // 2} {3 + 5 * (k // 2)} {k % 2} 0 0 0 1 1" for k in range(8))
REFUSED = {
    "GDE (VDI/VDE 2610) and other XML": '<?xml version="1.0"?>\n<gde/>',
    "a normal of length 2; allowed 1": NOMINAL + "\n" + ROWS.replace("0 0 1 1", "0 0 2 1"),
    "deg askew on its line of points; allowed up to 12": NOMINAL + "\n" + ROWS.replace("0 0 1 1", "1 0 0 1"),
    "mm long, about alike; name the columns": "i,j,radius_mm,axial_mm,deviation_um\n"
    "0,0,1,1,0\n0,1,1,2,0\n1,0,2,1,0\n1,1,2,2,0",
    "columns i and j belong together": "i,radius_mm,axial_mm,deviation_um\n0,1,1,0",
    "allowed one pair of them": "i,j,profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um\n0,0,0,0,1,1,0",
    "column weight: not allowed beside line": "line,radius_mm,axial_mm,deviation_um,weight\nprofile,1,1,0,1",
    "line 2, column 1: line is no line, profile or helix": "line,radius_mm,axial_mm,deviation_um\ntip,1,1,0",
    "line helix: 0 points; allowed from 4 on": "line,radius_mm,axial_mm,deviation_um\nprofile,1,1,0",
    "line profile: its axial coordinate changes by 5 mm": lines_text(abs, abs).replace(",2.0,", ",7.0,", 1),
    "the lines do not cross": lines_text(abs, abs, radius=40.0),
}


@pytest.mark.parametrize("words", REFUSED)
def test_files_that_are_refused(words):
    with pytest.raises(InputError) as caught:
        parse_topography(REFUSED[words])
    assert words in str(caught.value)


def test_weights_are_refused_where_a_spline_goes_through_the_points(flank, tmp_path):
    """In Python, and in a scene that names the file."""
    rows = "\n".join(f"{i},{j},{40 + i},{60 + j},0,1" for i, j in np.ndindex(4, 4))
    text = "profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um,weight\n" + rows
    with pytest.raises(InputError, match="weight: a spline through measured points has none"):
        measured(flank, parse_topography(text))
    file = tmp_path / "weighted.csv"
    file.write_text(text)
    with pytest.raises(InputError, match="weight: a spline through measured points has none"):
        FlankForm(form="measured", file=str(file))
    with pytest.raises(InputError, match="weights: allowed from 0 on, and not all of them 0"):
        parse_topography(text.replace(",1\n", ",-1\n"))
