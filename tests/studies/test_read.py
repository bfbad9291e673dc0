"""Study files: the words of Study in TOML."""

import bz2
import gzip
import lzma
import re

import numpy as np
import pytest
from scipy import stats

from loaded_tca.errors import InputError
from loaded_tca.studies import parse_study, read, read_study
from tests.refusals import refused_calls
from tests.samples.studies import HELICAL

CROWNING, TILT = "pinion.modifications.lead_crowning_um", "mounting.misalignment_um"

WHOLE = f"""
scene = "{HELICAL}"
samples = 8
seed = 3
table = "given.csv"

[changes]
analysis.positions = 5

[factors]
{CROWNING} = {{ from = 0.0, to = 6.0, count = 3 }}
"wheel.modifications.lead_crowning_form" = ["parabolic", "circular"]

[distributions]
{TILT} = {{ distribution = "norm", loc = 1.0, scale = 5.0 }}
"""


def test_file_holds_all_that_a_study_has(tmp_path):
    (tmp_path / "given.csv").write_text(
        "load.pinion_torque_Nm,pinion.modifications.tip_relief_form\n40,linear\n80.5,parabolic\n"
    )
    (tmp_path / "study.toml").write_text(WHOLE)
    study = read_study(tmp_path / "study.toml")
    assert len(study) == 2 * 3 * 2 * 8
    assert study.scene.analysis.positions == 5
    assert study.seed == 3
    assert study.factors[CROWNING] == [0.0, 3.0, 6.0]
    assert study.changes(len(study) - 1)["load.pinion_torque_Nm"] == 80.5
    values = np.array([study.changes(variant)[TILT] for variant in range(8)])
    assert sorted(np.floor(8 * stats.norm(1.0, 5.0).cdf(values))) == list(range(8))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("scene = 3", "scene: found 3; allowed the name of a scene file"),
        ('scene = "absent.toml"', "absent.toml: cannot be read"),
        ("changes = 1", "changes: found 1; allowed a section [changes]"),
        ("factors = [1]", "factors: found [1]; allowed a section [factors]"),
        ("factor = 1", 'factor: unknown word; did you mean "factors"?'),
        ("xyz = 1", "xyz: unknown word; allowed scene, stage, changes, factors"),
        ("factors.a.b = 3", "factors.a.b: found 3; allowed a list of values or { from, to, count }"),
        ("factors.a = { from = 1, to = 2 }", "factors.a: found a table; allowed a list of values or {"),
        ("factors.a = { from = 1, to = 2, count = 0 }", "factors.a.count: found 0; allowed a whole number from 1"),
        ("factors.a = { from = 1, to = inf, count = 2 }", "allowed two finite numbers"),
        ("distributions.a = 1", "distributions.a: found 1; allowed { distribution ="),
        ("distributions.a = { distribution = 'gaussian' }", 'distributions.a: found "gaussian"'),
        ("distributions.a = { distribution = 'norme' }", 'distributions.a: found "norme"; did you mean "norm"?'),
        ("distributions.a = { distribution = 'norm', width = 1 }", "norm has the parameters loc, scale; found width"),
        ("table = 1", "table: found 1; allowed the name of a CSV file"),
        ("table = 'absent.csv'", "absent.csv: cannot be read: No such file"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_file_is_told(tmp_path, text, told):
    scene = "" if text.startswith(("scene", "changes")) else f'scene = "{HELICAL}"\n'
    scene += f'scene = "{HELICAL}"\n' if text.startswith("changes") else ""
    with pytest.raises(InputError) as caught:
        parse_study(scene + text, folder=tmp_path)
    assert len(caught.value.problems) == 1
    assert told in caught.value.problems[0]


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("empty.csv", b""),
        ("commas.csv", b"mounting.misalignment_um\n0,5\n1,5\n"),
        ("longer.csv", b"mounting.misalignment_um,pinion.teeth\n1,33,3\n"),
    ],
)
def test_table_that_is_no_table(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=f"{name}: no CSV"):
        parse_study(f'scene = "{HELICAL}"\ntable = "{name}"', folder=tmp_path)


@pytest.mark.parametrize("pack", [bz2.compress, gzip.compress, lzma.compress])
def test_table_is_not_unpacked(tmp_path, pack):
    """A small file may hold gigabytes."""
    (tmp_path / "packed.csv.xz").write_bytes(pack(b"mounting.misalignment_um\n1\n"))
    with pytest.raises(InputError, match=r"^table: .*packed\.csv\.xz: not a text file in UTF-8"):
        parse_study(f'scene = "{HELICAL}"\ntable = "packed.csv.xz"', folder=tmp_path)


def test_table_of_a_spreadsheet_is_read(tmp_path):
    lines = [
        '"mounting.misalignment_\N{MICRO SIGN}m";"pinion.modifications.lead_crowning_form";',
        "1.5;circular;",
        ";;",
    ]
    (tmp_path / "table.csv").write_text("\r\n".join(lines), encoding="utf-8-sig")
    study = parse_study(f'scene = "{HELICAL}"\ntable = "table.csv"', folder=tmp_path)
    assert study.changes(0) == {
        "mounting.misalignment_um": 1.5,
        "pinion.modifications.lead_crowning_form": "circular",
    }


def test_number_that_python_alone_reads_is_none_in_a_table(tmp_path):
    (tmp_path / "table.csv").write_text("mounting.misalignment_um\n1_0\n")
    with pytest.raises(InputError, match=r"mounting\.misalignment_um: .*1_0"):
        parse_study(f'scene = "{HELICAL}"\ntable = "table.csv"', folder=tmp_path)


def test_table_that_is_too_long_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(read, "LARGEST_TABLE", 10)
    (tmp_path / "long.csv").write_text("mounting.misalignment_um\n1\n")
    with pytest.raises(InputError, match=r"long\.csv: more than 10 bytes; no table of variants is so long"):
        parse_study(f'scene = "{HELICAL}"\ntable = "long.csv"', folder=tmp_path)


def test_table_is_no_address(tmp_path, monkeypatch):
    """The name of a local file as an address, which pandas would open."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "table.csv").write_text("mounting.misalignment_um\n1\n")
    with pytest.raises(InputError, match=r"^table: file:.*: cannot be read: No such file"):
        parse_study(f'scene = "{HELICAL}"\ntable = "file:{tmp_path}/table.csv"')


test_read_refuses = refused_calls(
    (
        lambda: parse_study(f'scene = "{HELICAL}"\n[factors]\n{TILT} = [1]\n"{TILT}" = [2]'),
        r"factors\.mounting\.misalignment_um: given twice",
    ),
    (
        lambda: parse_study('scenes = "a"\n[factors]\na = 1\n[distributions]\nb = 2'),
        ("^scenes:", "^scene:", r"^factors\.a:", r"^distributions\.b:"),
    ),
)


SLOPE, TILTED = "pinion.modifications.helix_slope_um", "mounting.out_of_plane_deg"


def scattered(tmp_path, text):
    (tmp_path / "study.toml").write_text(
        f'scene = "{HELICAL}"\nsamples = 64\n[changes]\n{SLOPE} = 4.0\n[distributions]\n{text}\n'
    )
    return read_study(tmp_path / "study.toml").distributions


def test_distribution_about_the_nominal_lies_about_the_value_of_the_scene(tmp_path):
    found = scattered(
        tmp_path,
        f'{SLOPE} = {{ distribution = "norm", about = "nominal", scale = 2.0 }}\n'
        f'{TILTED} = {{ distribution = "uniform", about = "nominal", loc = -0.1, scale = 0.2 }}',
    )
    assert found[SLOPE].mean() == 4.0
    assert found[SLOPE].std() == 2.0
    assert found[TILTED].support() == pytest.approx((-0.1, 0.1))


def test_distribution_that_takes_the_place_of_a_nominal_value_says_so(tmp_path):
    assert scattered(tmp_path, f'{SLOPE} = {{ distribution = "norm", loc = 0.0, scale = 2.0 }}')[SLOPE].mean() == 0.0
    assert scattered(tmp_path, f'{TILTED} = {{ distribution = "norm", scale = 2.0 }}')[TILTED].mean() == 0.0
    with pytest.raises(
        InputError, match=rf'^distributions.{SLOPE}: the scene has 4.0 there; allowed about = "nominal"'
    ):
        scattered(tmp_path, f'{SLOPE} = {{ distribution = "norm", scale = 2.0 }}')


def test_tolerance_class_is_the_distribution_of_a_slope_about_that_of_the_scene(tmp_path):
    """f_HbetaT of class 6 is 9.0 um for d 105.6 mm, b 25 mm; f_HalphaT of class 8 15 um for d 177 mm, m_n 3 mm."""
    profile = "wheel.modifications.profile_slope_um"
    found = scattered(tmp_path, f"{SLOPE} = {{ tolerance_class = 6 }}\n{profile}.tolerance_class = 8\n")
    assert (found[SLOPE].mean(), found[SLOPE].std()) == (4.0, 3.0)
    assert (found[profile].mean(), found[profile].std()) == (0.0, 5.0)


CLASSES = "allowed pinion.modifications.helix_slope_um, pinion.modifications.profile_slope_um, wheel"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"{SLOPE} = {{ tolerance_class = 12 }}", f"{SLOPE}.tolerance_class: found 12; allowed a whole number from 1"),
        (f'{SLOPE} = {{ tolerance_class = "6" }}', f'{SLOPE}.tolerance_class: found "6"; allowed a whole number'),
        (
            f"{SLOPE} = {{ tolerance_class = 6, scale = 2.0 }}",
            f"{SLOPE}: found scale beside tolerance_class; allowed",
        ),
        (f"{TILTED} = {{ tolerance_class = 6 }}", f"{TILTED}: ISO 1328-1 has no tolerance of it by class; {CLASSES}"),
    ],
)
def test_tolerance_class_of_a_study_is_refused(tmp_path, text, told):
    with pytest.raises(
        InputError, match=re.escape(f"distributions.{told}") if told.startswith((SLOPE, TILTED)) else told
    ):
        scattered(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f'{SLOPE} = {{ distribution = "norm", about = "mean" }}', f'{SLOPE}.about: found "mean"; allowed "nominal"'),
        (
            'wheel.modifications.tip_relief_form = { distribution = "norm", about = "nominal" }',
            'tip_relief_form.about: the scene has no number there, but "parabolic"',
        ),
    ],
)
def test_what_a_distribution_cannot_lie_about_is_told(tmp_path, text, told):
    with pytest.raises(InputError, match=re.escape(told)):
        scattered(tmp_path, text)


IN_INCHES = f"""
scene = "{HELICAL}"
samples = 4
table = "given.csv"
[changes]
pinion.face_width_in = 1.25
[factors]
pinion.modifications.lead_crowning_in = [0.0001, 0.0002]
[distributions]
mounting.misalignment_in = {{ distribution = "norm", loc = 0.0001, scale = 0.0002 }}
mounting.axial_offset_in = {{ distribution = "uniform", about = "nominal", loc = -0.5 }}
"""


def test_study_of_a_drawing_in_inches_varies_the_metric_keys(tmp_path):
    (tmp_path / "given.csv").write_text("load.pinion_torque_lbf_in\n1000\n2000\n")
    (tmp_path / "study.toml").write_text(IN_INCHES)
    study = read_study(tmp_path / "study.toml")
    assert study.scene.pinion.face_width_mm == 31.75
    assert study.factors == {CROWNING: [2.54, 5.08]}
    assert study.table["load.pinion_torque_Nm"] == pytest.approx([112.9848, 225.9697], rel=1e-6)  # NIST SP 811
    scattered = study.distributions[TILT]
    assert (scattered.mean(), scattered.std()) == pytest.approx((2.54, 5.08), rel=1e-12)  # factors, and SciPy's mean
    # a width of one inch is not written, and yet is one of 25.4 mm
    assert study.distributions["mounting.axial_offset_mm"].support() == pytest.approx((-12.7, 12.7))


test_study_of_a_drawing_that_is_refused = refused_calls(
    (
        lambda: parse_study(f'scene = "{HELICAL}"\n[factors]\n{CROWNING} = [1]\n{CROWNING[:-2]}in = [1e-4]'),
        f"^factors: {CROWNING[:-2]}in: given twice, as {CROWNING} too$",
    ),
    (
        lambda: parse_study(
            f'scene = "{HELICAL}"\nsamples = 4\n[distributions]\n'
            'pair.normal_diametral_pitch_per_inch = { distribution = "norm", loc = 8, scale = 0.1 }'
        ),
        "pitch_per_inch: another quantity, which is not converted; allowed a distribution of normal_module_mm$",
    ),
    (
        lambda: parse_study(
            f'scene = "{HELICAL}"\nsamples = 4\n[distributions]\n'
            'mounting.misalignment_uin = { distribution = "poisson", mu = 3 }'
        ),
        "misalignment_uin: a distribution over whole numbers, which is not converted; allowed .* of misalignment_um$",
    ),
    (
        lambda: parse_study(
            f'scene = "{HELICAL}"\nsamples = 4\n[distributions]\n'
            'load.pinion_torque_lbf_in = { distribution = "norm", scale = 10 }'
        ),
        "pinion_torque_lbf_in: the scene has 1150.59.* there; allowed about",
    ),
)
