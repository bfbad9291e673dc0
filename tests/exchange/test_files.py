"""REXS files: three formats, the same model; arrays in base64; whatever else lies under the name."""

from __future__ import annotations

import base64
import json
import struct
import xml.etree.ElementTree as ElementTree
import zipfile
from io import BytesIO
from pathlib import Path

import pytest

from loaded_tca.errors import InputError
from loaded_tca.exchange import Attribute, import_stage, parse_rexs, read_rexs, with_attributes
from loaded_tca.exchange.model import VERSIONS
from tests.samples.rexs import EXAMPLE, as_json, as_zip, changed, example

XML = EXAMPLE.read_bytes()
CONTENTS = {
    "rexs": XML,
    "rexsj": as_json(example()),
    "rexsz": as_zip(("rexs-model.rexs", XML), ("housing.stl", b"solid")),
    "rexsz of JSON": as_zip(("model.rexsj", as_json(example()))),
    "rexs with mark": b"\xef\xbb\xbf" + XML,
    "rexsj with mark": b"\xef\xbb\xbf" + as_json(example()),
    "UTF-16": XML.decode().replace("UTF-8", "UTF-16").encode("utf-16"),
    "namespace": XML.replace(b"<model ", b'<model xmlns="https://www.rexs.info" '),
}


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("content", CONTENTS.values(), ids=CONTENTS)
def test_every_format_gives_the_same_scenes(content: bytes) -> None:
    for stage in ("10", "11"):
        expected = import_stage(example(), stage)
        assert import_stage(parse_rexs(content), stage).scene == expected.scene


def test_a_model_keeps_its_parts() -> None:
    model = read_rexs(EXAMPLE)
    assert (model.version, len(model.components), len(model.relations)) == ("1.7", 48, 51)
    assert model.components["21"].name == "Pinion 1"
    assert model.components["4"].attributes["support_vector"] == Attribute(("40.0", "0.0", "98.0"), "mm")
    assert [(case.spectrum, case.id) for case in model.load_cases] == [("1", "1"), ("1", "2")]
    assert [one.id for one in model.related("stage", "stage", "11", "gear_2")] == ["24"]


@pytest.mark.parametrize("version", VERSIONS)
def test_versions_before_2_are_read(version: str) -> None:
    assert parse_rexs(XML.replace(b'version="1.7"', f'version="{version}"'.encode())).version == version


@pytest.mark.parametrize("version", ["2.0", "2.0.0", "0.9", "1.8", ""])
def test_other_versions_are_refused(version: str) -> None:
    with pytest.raises(InputError, match=rf'model: version: found "{version}"; allowed 1\.0 to 1\.7'):
        parse_rexs(XML.replace(b'version="1.7"', f'version="{version}"'.encode()))


CODED = {"float64": "<3d", "float32": "<3f", "int32": "<3i"}


@pytest.mark.parametrize("code", CODED)
@pytest.mark.parametrize("form", ["xml", "json"])
def test_arrays_in_base64_are_decoded(code: str, form: str) -> None:
    text = base64.b64encode(struct.pack(CODED[code], 40, 0, 98)).decode()
    if form == "xml":
        old = b'<attribute id="support_vector" unit="mm"><array><c>40.0</c><c>0.0</c><c>98.0</c></array>'
        content = XML.replace(
            old, f'<attribute id="support_vector" unit="mm"><array code="{code}">{text}</array>'.encode()
        )
    else:
        old = b'"floating_point_array": [40.0, 0.0, 98.0]'
        content = as_json(example()).replace(
            old, json.dumps({"floating_point_array_coded": {"code": code, "value": text}})[1:-1].encode()
        )
    assert content != (XML if form == "xml" else as_json(example()))
    assert parse_rexs(content).components["4"].attributes["support_vector"].value == (40.0, 0.0, 98.0)


def test_matrices_and_arrays_of_arrays_are_tuples_of_rows() -> None:
    rows = "<r><c>1</c><c>2</c></r><r><c>3</c><c>4</c></r>"
    arrays = "<array><c>1</c></array><array><c>2</c><c>3</c></array>"
    content = (
        '<model version="1.7"><components><component id="1" type="material">'
        f'<attribute id="a"><matrix>{rows}</matrix></attribute>'
        f'<attribute id="b"><array_of_arrays>{arrays}</array_of_arrays></attribute>'
        "</component></components></model>"
    )
    attributes = parse_rexs(content.encode()).components["1"].attributes
    assert attributes["a"].value == (("1", "2"), ("3", "4"))
    assert attributes["b"].value == (("1",), ("2", "3"))


LAUGHS = b'<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
START = b'<model version="1.7">'
REFUSED = {
    "document type": (LAUGHS + START + b"&b;</model>", "document type"),
    "document type in UTF-16": ((LAUGHS + START + b"&b;</model>").decode().encode("utf-16"), "document type"),
    "external entity": (b'<!DOCTYPE m SYSTEM "file:///etc/passwd">' + START + b"</model>", "document type"),
    "cut XML": (XML[:2000], "neither XML, JSON nor zip"),
    "text": (b"hello", "neither XML, JSON nor zip"),
    "empty": (b"", "neither XML, JSON nor zip"),
    "other XML": (b"<gearbox/>", r"found <gearbox>; a REXS file is a <model>"),
    "encoding": (b'<?xml version="1.0" encoding="klingon"?><model/>', "neither XML|encoding"),
    "no type": (START + b'<components><component id="1"/></components></model>', "<component>: type: missing"),
    "no id": (START + b'<components><component type="shaft"/></components></model>', "<component>: id: missing"),
    "attribute without id": (
        START + b'<components><component id="1" type="shaft"><attribute>1</attribute></component></components></model>',
        "<attribute>: id: missing",
    ),
    "id twice": (
        START + b'<components><component id="1" type="shaft"/><component id="1" type="shaft"/></components></model>',
        "component 1: found twice",
    ),
    "unknown reference": (
        START + b'<relations><relation id="1" type="stage"><ref id="7" role="gear_1"/></relation></relations></model>',
        "relation stage: gear_1: no component has the id 7",
    ),
    "order": (
        START + b'<relations><relation id="1" type="stage" order="x"/></relations></model>',
        "relation: order: found 'x'; allowed a number",
    ),
    "code": (
        START + b'<components><component id="1" type="shaft"><attribute id="u"><array code="int8">AA==</array>'
        b"</attribute></component></components></model>",
        "component 1: u: found the code 'int8'; allowed float64, float32, int32",
    ),
    "base64": (
        START + b'<components><component id="1" type="shaft"><attribute id="u"><array code="int32">A!</array>'
        b"</attribute></component></components></model>",
        "component 1: u: not base64",
    ),
    "bytes": (
        START + b'<components><component id="1" type="shaft"><attribute id="u"><array code="int32">AAA=</array>'
        b"</attribute></component></components></model>",
        "component 1: u: found 2 bytes; allowed multiples of 4",
    ),
    "cut JSON": (as_json(example())[:300], "not JSON"),
    "JSON of something else": (b'{"gearbox": 1}', "model: missing"),
    "JSON model": (b'{"model": 1}', "model: found 1; allowed a JSON object"),
    "JSON components": (
        b'{"model": {"version": "1.7", "components": {}}}',
        "components: found {}; allowed a JSON array",
    ),
    "JSON component": (
        b'{"model": {"version": "1.7", "components": [1]}}',
        "components: found 1; allowed JSON objects",
    ),
    "JSON id": (b'{"model": {"version": "1.7", "components": [{"type": "shaft"}]}}', "id: missing"),
    "deep JSON": (b'{"model":' + b"[" * 100_000, "nested too deeply|not JSON"),
    "JSON in Latin-1": ('{"model": "ü"}'.encode("latin-1"), "not a text file in UTF-8"),
    "broken zip": (as_zip(("a.rexs", XML))[:-40], "not a zip that can be read"),
    "zip without a model": (as_zip(("a.stl", b"solid")), "found models: none"),
    "zip with two models": (as_zip(("a.rexs", XML), ("b.rexs", XML)), r"found models: a\.rexs, b\.rexs"),
    "zip in a zip": (as_zip(("a.rexs", as_zip(("b.rexs", XML)))), "a zip in a zip"),
}


@pytest.mark.parametrize(("content", "message"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_model_is_refused(content: bytes, message: str) -> None:
    with pytest.raises(InputError, match=message):
        parse_rexs(content)


def test_a_zip_that_grows_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("loaded_tca.exchange.files.LARGEST_FILE", 10_000)
    with pytest.raises(InputError, match="more than 10000 bytes unzipped"):
        parse_rexs(as_zip(("a.rexs", b" " * 20_000)))


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_rexs(tmp_path / "none.rexs")


@pytest.mark.parametrize("form", ["rexs", "rexsj", "rexsz", "namespace"])
def test_more_attributes_change_nothing_else(form: str) -> None:
    more = {"10": {"face_load_factor_flank": Attribute(1.25), "center_distance": Attribute(98.5, "mm")}}
    more["4"] = {"u_coordinates_of_beam_nodes": Attribute((0.0, 12.5), "mm")}
    old, new = parse_rexs(CONTENTS[form]), parse_rexs(with_attributes(CONTENTS[form], more))
    assert (new.version, new.relations, new.load_cases) == (old.version, old.relations, old.load_cases)
    assert new.components["10"].number("face_load_factor_flank") == 1.25
    assert new.components["10"].number("center_distance", {"mm": 1.0}) == 98.5
    assert new.components["4"].numbers("u_coordinates_of_beam_nodes", {"mm": 1.0}, 2) == (0.0, 12.5)
    for one, part in old.components.items():
        names = set(part.attributes) - set(more.get(one, {}))
        assert {name: part.attributes[name] for name in names} == {
            name: new.components[one].attributes[name] for name in names
        }


def test_attributes_join_no_file_that_is_no_model() -> None:
    for content in (
        b'{"model": {"version": "1.7", "components": [{"id": 1, "type": "shaft", "attributes": ["u"]}]}}',
        b"<a/>",
    ):
        with pytest.raises(InputError):
            with_attributes(content, {"1": {"width": Attribute(1.0, "mm")}})


def test_a_zip_keeps_its_other_files() -> None:
    content = with_attributes(CONTENTS["rexsz"], {"10": {"face_load_factor_flank": Attribute(1.25)}})
    with zipfile.ZipFile(BytesIO(content)) as archive:
        assert archive.namelist() == ["rexs-model.rexs", "housing.stl"]
        assert archive.read("housing.stl") == b"solid"
        assert ElementTree.fromstring(archive.read("rexs-model.rexs")).get("version") == "1.7"


def test_load_cases_replace_attributes() -> None:
    model = example().with_load_case("1:2")
    assert model.components["97"].number("torque_around_u_axis", {"Nm": 1.0}) == -60.0
    assert model.components["97"].number("u_coordinate_on_shaft", {"mm": 1.0}) == 0.0


@pytest.mark.parametrize("wanted", ["3", "2:1"])
def test_unknown_load_cases_name_those_there_are(wanted: str) -> None:
    with pytest.raises(InputError, match=f"load case {wanted}: not found; allowed 1:1, 1:2"):
        example().with_load_case(wanted)


def test_models_without_load_cases_say_so() -> None:
    with pytest.raises(InputError, match="allowed none, the model has no load cases"):
        parse_rexs(XML[: XML.index(b"  <load_spectrum")] + b"</model>").with_load_case("1")


def test_load_cases_of_two_spectra_are_told_apart() -> None:
    spectrum = XML[XML.index(b"  <load_spectrum") : XML.index(b"</model>")]
    twice = XML.replace(b"</model>", spectrum.replace(b'spectrum id="1"', b'spectrum id="2"') + b"</model>")
    with pytest.raises(InputError, match="load case 1: several; allowed 1:1, 1:2, 2:1, 2:2"):
        parse_rexs(twice).with_load_case("1")
    assert parse_rexs(twice).with_load_case("2:1").components["97"].number("torque_around_u_axis", {"Nm": 1.0}) == 150.0


VALUES = {
    "no number": ({"21.face_width": ("wide", "mm")}, "cylindrical_gear 21: face_width: found 'wide'; allowed a number"),
    "not finite": ({"21.face_width": ("NaN", "mm")}, "cylindrical_gear 21: face_width: found 'NaN'; allowed a number"),
    "endless": ({"21.face_width": ("1e300", "mm")}, "cylindrical_gear 21: face_width: found '1e300'; allowed a number"),
    "unit": ({"21.face_width": ("30", "kg")}, 'cylindrical_gear 21: face_width: found the unit "kg"; allowed mm or m'),
    "missing": ({"21.face_width": None}, "cylindrical_gear 21: face_width: missing"),
    "not whole": ({"21.number_of_teeth": ("21.5", "none")}, "number_of_teeth: found 21.5; allowed a whole number"),
    "array": ({"21.support_vector": (("1", "2"), "mm")}, "support_vector: found 2 values; allowed 3"),
    "flag": (
        {"31.is_driving_gear": ("perhaps", "none"), "3.rotational_speed": None},
        "is_driving_gear: found 'perhaps'",
    ),
}


@pytest.mark.parametrize(("attributes", "message"), VALUES.values(), ids=VALUES)
def test_bad_values_are_named_with_id_and_attribute(attributes: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        import_stage(changed(attributes=attributes), "10")


UNITS = {
    "21.face_width": [("0.03", "m"), ("30000", "µm"), ("3", "cm")],
    "97.torque_around_u_axis": [("150000", "N mm"), ("0.15", "kN m")],
    "3.rotational_speed": [("25", "1/s"), ("157.07963267948966", "rad / s")],
    "21.helix_angle_reference_diameter": [("0.20943951023931953", "rad"), ("12", "°")],
    "91.radial_stiffness": [("200000", "N/mm"), ("200", "N / µm")],
    "70.elastic_modulus": [("206", "GPa"), ("206000", "MPa"), ("206000", "N/mm²")],
    "70.density": [("7850", "kg / m^3")],
}


@pytest.mark.quick_cases(every=4)
@pytest.mark.parametrize(
    ("path", "value"), [(path, value) for path, values in UNITS.items() for value in values], ids=str
)
def test_units_of_files_give_the_same_scene(path: str, value: tuple[str, str]) -> None:
    expected = import_stage(example(), "10")
    found = import_stage(changed(attributes={path: value}), "10")
    for key, one in _numbers(expected.table).items():
        assert _numbers(found.table)[key] == pytest.approx(one, rel=1e-12, abs=1e-9), key  # a factor


def _numbers(table, path=""):
    """Every number of a table by its path."""
    if isinstance(table, dict):
        return {k: v for name, one in table.items() for k, v in _numbers(one, f"{path}.{name}").items()}
    if isinstance(table, list):
        return {k: v for n, one in enumerate(table) for k, v in _numbers(one, f"{path}.{n}").items()}
    return {path: table} if isinstance(table, int | float) else {}
