"""Files of measured flanks: units, signs, orders, and everything that is refused."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import InputError
from loaded_tca.flanks import FlankModifications, MeasuredDeviations, MeasuredPoints, measured, read_topography
from loaded_tca.flanks.base import unmodified
from loaded_tca.flanks.topography import LARGEST_FILE, MOST_PROBLEMS, parse_topography
from tests.samples.gear_pairs import gear_pair

HEADER = "profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um"
EPS = np.finfo(float).eps
OF_UNITS = 2.0 * EPS  # every digit is written; a factor and two products round by half of EPS each


def rows_of(*columns, separator=","):
    """Rows of a file, the profile running fastest, with indices in front."""
    rows, lines = columns[0].shape
    return [
        separator.join([str(i + 1), str(j + 1), *(repr(float(column[i, j])) for column in columns)])
        for j in range(lines)
        for i in range(rows)
    ]


@pytest.fixture
def flank():
    return gear_pair(FlankModifications(lead_crowning=0.01, twist=0.005), helix_deg=15.0).pinion.flank


@pytest.fixture
def grid(flank):
    """(radius, axial, excess) [mm] over the flank."""
    radius, axial = flank.grid(7, 9)
    return radius, axial, -np.asarray(flank.removal(radius, axial).value)


def problems_of(text):
    with pytest.raises(InputError) as caught:
        parse_topography(text)
    return caught.value.problems


# What is read


def test_flank_written_to_a_file_comes_back(flank, grid, tmp_path):
    file = tmp_path / "pinion.csv"
    columns = grid[0], grid[1], 1e3 * grid[2]
    file.write_text("\n".join(["# gear = pinion", "# a note", HEADER, *rows_of(*columns)]), encoding="utf-8")
    topography = read_topography(file)
    assert isinstance(topography, MeasuredDeviations)
    assert topography.notes == {"gear": "pinion"}
    again = measured(unmodified(flank), topography)
    rho, z = flank.grid(5, 5)
    # rad; every digit is written: none seen
    assert_allclose(again.theta(rho, z).value, flank.theta(rho, z).value, rtol=0, atol=1e-14)


def test_order_of_the_rows_with_indices_does_not_matter(grid, rng):
    rows = rows_of(*grid)
    shuffled = [rows[k] for k in rng.permutation(len(rows))]
    found = parse_topography("\n".join([HEADER, *shuffled]))
    assert_array_equal(found.radius, grid[0])
    assert_array_equal(found.excess, 1e-3 * grid[2])


def test_rows_without_indices_run_along_the_profile_first(grid):
    rows = [row.split(",", 2)[2] for row in rows_of(*grid)]
    found = parse_topography("\n".join(["# points = 7 x 9", "radius_mm,axial_mm,deviation_um", *rows]))
    assert_array_equal(found.axial, grid[1])
    assert_array_equal(found.excess, 1e-3 * grid[2])


@pytest.mark.parametrize(("unit", "factor"), [("um", 1e-3), ("mm", 1.0), ("m", 1e3), ("in", 25.4)])
def test_every_unit_is_turned_into_millimetres(unit, factor):
    ones = np.ones((2, 2))
    header = f"profile_index,lengthwise_index,radius_{unit},axial_mm,removed_{unit}"
    found = parse_topography("\n".join([header, *rows_of(ones, 0.0 * ones, 3.0 * ones)]))
    assert_allclose(found.radius, factor * ones)
    assert_allclose(found.excess, -3.0 * factor * ones)


def test_removed_material_is_the_deviation_with_the_other_sign(grid):
    rows = rows_of(*grid)
    deviation, removed = (
        parse_topography("\n".join([HEADER.replace("deviation", name), *rows])) for name in ("deviation", "removed")
    )
    assert_array_equal(removed.excess, -np.asarray(deviation.excess))


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_points_are_read_with_every_separator_a_byte_order_mark_and_blank_lines(flank, tmp_path, separator):
    rho, z = flank.grid(6, 6)
    theta = flank.theta(rho, z).value
    points = rho * np.cos(theta), rho * np.sin(theta), z
    header = separator.join(["profile_index", "lengthwise_index", " x_mm", "y_mm ", "z_mm"])
    text = "\r\n".join(["", header, "", *rows_of(*points, separator=separator), ""])
    (tmp_path / "points.csv").write_text(text, encoding="utf-8-sig", newline="")
    found = read_topography(tmp_path / "points.csv")
    assert isinstance(found, MeasuredPoints)
    assert_array_equal(found.points, np.stack(points, axis=-1))
    assert_allclose(found.radius, rho, rtol=20.0 * EPS)  # the root of sine and cosine squared: half a dozen roundings


def as_a_spreadsheet(header, rows):
    """Text as a spreadsheet writes it: quoted names, separators at the ends of lines, lines of separators alone."""
    lines = ['"# gear = pinion";;;;;', ";".join(f'"{name}"' for name in header.split(",")) + ";", ";;;;;"]
    return "\r\n".join([*lines, *(f"{row.replace(',', ';')};" for row in rows), ";;;;;", ""])


@pytest.mark.parametrize("micro", ["u", "\N{MICRO SIGN}", "\N{GREEK SMALL LETTER MU}"])
def test_file_of_a_spreadsheet_is_read_with_every_sign_for_micro(grid, micro):
    rows = rows_of(grid[0], grid[1], 1e3 * grid[2])
    found = parse_topography(as_a_spreadsheet(HEADER.replace("_um", f"_{micro}m"), rows))
    assert found.notes == {"gear": "pinion"}
    assert_allclose(found.excess, grid[2], rtol=OF_UNITS)
    assert_array_equal(found.axial, grid[1])


def test_file_of_windows_is_read(grid, tmp_path):
    """Its code page has other signs for micro and umlauts; the first line of Excel says what is between cells."""
    rows = [row.replace(",", "\t") for row in rows_of(2.0 * grid[0], grid[1], 1e3 * grid[2])]
    header = HEADER.replace("_um", "_\N{MICRO SIGN}m").replace("radius", "diameter").replace(",", "\t")
    note = "# Pr\N{LATIN SMALL LETTER U WITH DIAERESIS}fer = 7; 8"
    (tmp_path / "flank.csv").write_bytes("\r\n".join(["sep=\t", note, header, *rows]).encode("cp1252"))
    topography = read_topography(tmp_path / "flank.csv")
    assert topography.notes == {"Pr\N{LATIN SMALL LETTER U WITH DIAERESIS}fer": "7; 8"}
    assert_array_equal(topography.radius, grid[0])
    assert_allclose(topography.excess, grid[2], rtol=OF_UNITS)


def test_separator_of_the_first_line_rules():
    """Semicolons in names, for one."""
    (problem,) = problems_of(f"sep=,\n{HEADER},note;\n1,1,50,0,0,0")
    assert problem.startswith("line 2, column 6: the name of the column is unknown")


def test_empty_first_cell_between_tabs_is_no_other_column():
    text = "\n".join([HEADER.replace(",", "\t"), "\t1\t50\t0\t0"])
    assert problems_of(text) == ("line 2, column 1: profile_index is not a finite number",)


# What is refused


@pytest.mark.parametrize(
    "cell",
    ["1_0", "\N{ARABIC-INDIC DIGIT ONE}", "\N{FULLWIDTH DIGIT TWO}", "nan", "inf", "0x1", "1e999", "1d0", "\u22121"],
)
def test_what_python_alone_takes_for_a_number_is_none(cell):
    assert problems_of(f"{HEADER}\n1,1,50,0,{cell}") == ("line 2, column 5: deviation_um is not a finite number",)


def test_unknown_unit_of_a_known_column_is_told_as_such():
    """The nearest name is that in metres, a million times as much."""
    (problem,) = problems_of("radius_mm,axial_mm,deviation_UM\n1,2,3")
    units = "deviation_um, deviation_mm, deviation_m, deviation_in, deviation_uin"
    assert problem == f"line 1, column 3: the unit of deviation is unknown; allowed {units}"


def test_decimal_commas_in_quotes_are_one_problem():
    (problem,) = problems_of(f'{HEADER}\n1,1,"50,5",0,0')
    assert problem.startswith("line 2: decimal commas, it seems (1 such line)")


@pytest.mark.parametrize("row", ['1,1,"50,0,0', '1,1,"50"5,0,0'])
def test_quotation_that_does_not_end_is_told(row):
    assert problems_of(f"{HEADER}\n{row}") == ("line 2: a quotation that does not end, or goes on behind its end",)


def test_shape_of_a_grid_has_digits_that_people_of_all_scripts_read():
    (problem,) = problems_of("# points = \N{ARABIC-INDIC DIGIT TWO} x 2\nx_mm,y_mm,z_mm\n" + "1,2,3\n" * 4)
    assert problem.startswith("the shape of the grid is missing")


def test_columns_that_are_unknown_without_unit_or_double_are_refused_all_at_once():
    assert problems_of("radius_mm,axial,deviation_um,deviatoin_um,axial_mm,axial_um\n1,2,3,4,5,6") == (
        "column 'axial' has no unit; allowed axial_um, axial_mm, axial_m, axial_in, axial_uin",
        "line 1, column 4: the name of the column is unknown; did you mean 'deviation_um'?",
        "column axial appears twice",
    )
    (problem,) = problems_of("# note\nqqq,x_mm,y_mm,z_mm\n1,2,3,4")
    assert problem.startswith("line 2, column 1: the name of the column is unknown; allowed profile_index, ")
    assert problem.endswith(", weight, and lengths as x_mm")


@pytest.mark.parametrize(
    "header", ["x_mm,y_mm", "radius_mm,axial_mm", "radius_mm,axial_mm,deviation_um,removed_um", "profile_index"]
)
def test_columns_that_do_not_belong_together_are_refused(header):
    (problem,) = problems_of(header + "\n" + ",".join("1" for _ in header.split(",")))
    assert (
        "allowed x, y, z; x, y, z, deviation; x, y, z, nx, ny, nz, deviation; radius, axial, deviation; or" in problem
    )


def test_one_index_alone_is_refused():
    (problem,) = problems_of("lengthwise_index,x_mm,y_mm,z_mm\n1,2,3,4")
    assert problem == "columns profile_index and lengthwise_index belong together; only one is there"


def test_lines_that_are_no_numbers_are_refused_with_their_place():
    text = "\n".join(["# note", HEADER, "1,1,50,0,1", "2,1,51,0,abc", "3,1,52,0", "", "4,1,nan,inf,0"])
    assert problems_of(text) == (
        "line 4, column 5: deviation_um is not a finite number",
        "line 5: 4 values; the header names 5 columns",
        "line 7, column 3: radius_mm is not a finite number",
        "line 7, column 4: axial_mm is not a finite number",
    )


@pytest.mark.parametrize("separator", [",", ";", "\t", ":"])
@pytest.mark.parametrize("header", [True, False])
def test_what_stands_in_a_file_of_another_kind_is_not_repeated(header, separator):
    """A scene may name any file that can be read."""
    secret = [separator.join(["root", "x", "0", "secret", f"/home/{k}"]) for k in range(20)]
    told = problems_of("\n".join([HEADER.replace(",", separator)] * header + secret))
    assert not any(word in line for line in told for word in ("root", "secret", "home"))


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_decimal_commas_are_one_problem(grid, separator):
    rows = [row.replace(".", ",") for row in rows_of(*grid, separator=separator)]
    told = problems_of("\n".join([HEADER.replace(",", separator), *rows]))
    assert told == (
        f"line 2: decimal commas, it seems ({len(rows)} such lines); numbers are written with a decimal point",
    )


def test_decimal_comma_of_one_line_is_told_with_its_place(grid):
    rows = rows_of(*grid, separator=";")
    rows[3] = "4;1;+50,25;-,5e-1;0"
    (told,) = problems_of("\n".join([HEADER.replace(",", ";"), *rows]))
    assert told.startswith("line 5: decimal commas, it seems (1 such line)")


def test_many_bad_lines_are_counted():
    problems = problems_of("\n".join([HEADER, *["1,1,?,0,1"] * 25]))
    assert len(problems) == MOST_PROBLEMS + 1
    assert problems[-1] == "and 15 more problems of this kind"


@pytest.mark.parametrize(("place", "column"), [("1.5,1", "profile_index"), ("1,1.5", "lengthwise_index")])
def test_index_between_whole_numbers_is_told_as_such(place, column):
    places = [f"{i},{j}" for i in range(3) for j in range(3)]
    places[4] = place
    rows = [f"{indices},{50 + k // 3},{k % 3},0" for k, indices in enumerate(places)]
    with pytest.raises(InputError) as caught:
        parse_topography("\n".join([HEADER, *rows]))
    assert caught.value.problems == (f"{column}: 1.5 is not a whole number (1 such rows)",)


def test_missing_and_double_points_are_refused(grid):
    rows = rows_of(*grid)
    assert problems_of("\n".join([HEADER, *rows[:10], rows[3], *rows[12:]])) == (
        "2 of the 7 x 9 points are missing, the first at profile_index 4, lengthwise_index 2",
        "1 of the 7 x 9 points is given more than once, the first at profile_index 4, lengthwise_index 1",
    )


def test_a_diagonal_of_indices_takes_no_memory():
    rows = [f"{k},{k},50,0,0" for k in range(20000)]
    (problem,) = problems_of("\n".join([HEADER, *rows]))
    assert problem.startswith("399980000 of the 20000 x 20000 points are missing")


@pytest.mark.parametrize(
    ("note", "match"),
    [
        ("# nothing", "the shape of the grid is missing: columns profile_index and lengthwise_index, or a comment"),
        ("# points = many", "the shape of the grid is missing"),
        ("# points = 3 x 2", "points = 3 x 2 are 6, but there are 4 rows"),
    ],
)
def test_grid_without_its_shape_is_refused(note, match):
    (problem,) = problems_of("\n".join([note, "x_mm,y_mm,z_mm", *["1,2,3"] * 4]))
    assert problem.startswith(match)


@pytest.mark.parametrize("text", ["", "# only a note", HEADER])
def test_file_without_points_is_refused(text):
    assert problems_of(text)[0].startswith("no points: ")


def test_file_that_cannot_be_read_is_refused_by_name(tmp_path):
    with pytest.raises(InputError, match=r"missing.csv: cannot be read: No such file"):
        read_topography(tmp_path / "missing.csv")
    (tmp_path / "binary.csv").write_bytes(b"# note\n\xff\xfe\x00")
    with pytest.raises(InputError, match=r"binary.csv: not a text file in UTF-8 \(line 2\)"):
        read_topography(tmp_path / "binary.csv")
    (tmp_path / "huge.csv").write_bytes(b"#" * (LARGEST_FILE + 1))
    with pytest.raises(InputError, match=r"huge.csv: more than 8388608 bytes"):
        read_topography(tmp_path / "huge.csv")
    (tmp_path / "bad.csv").write_text(HEADER + "\n1,1,50,0,x\n1,1,50,y,1", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_topography(tmp_path / "bad.csv")
    assert len(caught.value.problems) == 2
    assert all(problem.startswith(str(tmp_path / "bad.csv: line ")) for problem in caught.value.problems)


def test_radius_of_points_on_the_axis_is_zero_and_not_a_failure():
    found = MeasuredPoints(np.zeros((4, 4, 3)))
    assert found.radius.max() == 0.0
    with pytest.raises(InputError, match="points lie off the flank"):
        measured(gear_pair().pinion.flank, found)
    assert math.isclose(found.axial.max(), 0.0)
