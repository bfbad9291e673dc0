"""Files of REXS models: XML (``.rexs``), JSON (``.rexsj``), and either in a zip (``.rexsz``); read and written.

The format is told by the content. A file that gets results keeps its format, and everything else that it has.

References
----------
REXS 1.0 to 1.7, specification and schemas, https://www.rexs.info; fva-net/rexs-api-java (Apache-2.0).
"""

from __future__ import annotations

import base64
import binascii
import io
import json
import os
import struct
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Iterator, Mapping
from typing import Any

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, require
from loaded_tca.exchange.model import Attribute, Component, LoadCase, Model, Relation, Value
from loaded_tca.input_files import number_in, read_bytes

LARGEST_FILE = 2**26
"""Bytes of a model; the public ones have about 10^5."""
CODES = {"float64": "d", "float32": "f", "int32": "i"}
"""Codes of arrays in base64, little-endian -> those of ``struct``."""


@checked
def read_rexs(path: str | os.PathLike[str]) -> Model:
    """Read a REXS model.

    Parameters
    ----------
    path : str or path
        XML, JSON, or a zip that holds one of them.

    Returns
    -------
    Model

    Raises
    ------
    InputError
        If the file cannot be read, is no such model, or of another version than 1.0 to 1.7.
    """
    return parse_rexs(read_bytes(path, LARGEST_FILE, "REXS model"), os.fspath(path))


def parse_rexs(content: bytes, source: str = "model") -> Model:
    """Make a model of the content of a file.

    Raises
    ------
    InputError
        As of :func:`read_rexs`.
    """
    if content.startswith(b"PK"):
        return parse_rexs(_unzipped(content, source)[1], source)
    if _is_json(content):
        return _of_json(content, source)
    return _of_xml(content, source)


def with_attributes(content: bytes, more: Mapping[str, Mapping[str, Attribute]], source: str = "model") -> bytes:
    """Return the content of a file with more attributes of its components, everything else as it was.

    Parameters
    ----------
    content : bytes
        Of a REXS file of any format, which the new one has, too.
    more : mapping
        Id of a component -> name -> attribute, a number or a tuple of numbers; those of the same name are replaced.
    source : str
        Name of the file.

    Raises
    ------
    InputError
        If the content is no REXS model.
    """
    parse_rexs(content, source)  # refuses what is no model
    if content.startswith(b"PK"):
        return _with_attributes_in_zip(content, more, source)
    if _is_json(content):
        return _with_attributes_in_json(content, more, source)
    root = _xml(content, source)
    space = str(root.tag).removesuffix("model")
    for component in (one for group in root if _tag(group) == "components" for one in group):
        attributes = more.get(component.get("id", ""), {})
        for one in [one for one in component if one.get("id") in attributes]:
            component.remove(one)
        for name, attribute in attributes.items():
            _add_attribute(component, name, attribute, space)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _with_attributes_in_zip(content: bytes, more: Mapping[str, Mapping[str, Attribute]], source: str) -> bytes:
    name, inner = _unzipped(content, source)
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as new:
        for one in old.infolist():
            part = with_attributes(inner, more, source) if one.filename == name else old.read(one)
            new.writestr(one.filename, part)
    return buffer.getvalue()


def _with_attributes_in_json(content: bytes, more: Mapping[str, Mapping[str, Attribute]], source: str) -> bytes:
    whole = _json(content, source)
    for one in _tables(whole["model"], "components", source):
        attributes = more.get(str(one.get("id")), {})
        kept = [each for each in one.get("attributes") or [] if str(each.get("id")) not in attributes]
        one["attributes"] = kept + [_json_attribute(name, each) for name, each in attributes.items()]
    return json.dumps(whole, indent=1, ensure_ascii=False).encode() + b"\n"


def _json_attribute(name: str, attribute: Attribute) -> dict[str, Any]:
    several = isinstance(attribute.value, tuple)
    kind, value = "floating_point_array" if several else "floating_point", attribute.value
    return {"id": name, "unit": attribute.unit, kind: list(value) if isinstance(value, tuple) else value}


def _add_attribute(component: ElementTree.Element, name: str, attribute: Attribute, space: str) -> None:
    element = ElementTree.SubElement(component, f"{space}attribute", {"id": name, "unit": attribute.unit})
    if not isinstance(attribute.value, tuple):
        element.text = str(attribute.value)
        return
    array = ElementTree.SubElement(element, f"{space}array")
    for value in attribute.value:
        ElementTree.SubElement(array, f"{space}c").text = str(value)


def _is_json(content: bytes) -> bool:
    return content.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{")


def _unzipped(content: bytes, source: str) -> tuple[str, bytes]:
    """Name and content of the one model in a zip."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            endings = (".rexs", ".rexsj", ".xml", ".json")
            models = [one for one in archive.infolist() if one.filename.lower().endswith(endings)]
            top = [one for one in models if "/" not in one.filename]
            models = top or models
            names = ", ".join(one.filename for one in models[:5]) or "none"
            require((len(models) == 1, f"{source}: found models: {names}; allowed a zip with one .rexs or .rexsj"))
            with archive.open(models[0]) as file:
                inner = file.read(LARGEST_FILE + 1)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{source}: not a zip that can be read: {error}") from None
    require(
        (len(inner) <= LARGEST_FILE, f"{source}: more than {LARGEST_FILE} bytes unzipped; no REXS model is so long")
    )
    require((not inner.startswith(b"PK"), f"{source}: a zip in a zip; allowed one .rexs or .rexsj in it"))
    return models[0].filename, inner


class _NoDoctype(ElementTree.TreeBuilder):
    """Elements of a file without a document type: entities of one may expand without end."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:  # noqa: ARG002
        raise InputError("has a document type (<!DOCTYPE ...>); REXS files have none")


def _xml(content: bytes, source: str) -> ElementTree.Element:
    """Root of a file in XML."""
    parser = ElementTree.XMLParser(target=_NoDoctype())
    try:
        parser.feed(content)
        root = parser.close()
    except ElementTree.ParseError as error:
        raise InputError(f"{source}: neither XML, JSON nor zip: {error}") from None
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    except (LookupError, ValueError) as error:
        raise InputError(f"{source}: its encoding cannot be read: {error}") from None
    require((_tag(root) == "model", f"{source}: found <{_tag(root):.40}>; a REXS file is a <model>"))
    return root


def _of_xml(content: bytes, source: str) -> Model:
    root = _xml(content, source)
    parts = {_tag(one): one for one in root if _tag(one) != "load_spectrum"}
    cases = []
    for spectrum in (one for one in root if _tag(one) == "load_spectrum"):
        for case in (one for one in spectrum if _tag(one) == "load_case"):
            values = {
                _need(one, "id", source): _xml_attributes(one, source) for one in case if _tag(one) == "component"
            }
            cases.append(LoadCase(_need(case, "id", source), spectrum.get("id", "1"), values))
    components = [
        Component(
            _need(one, "id", source), _need(one, "type", source), one.get("name", ""), _xml_attributes(one, source)
        )
        for one in parts.get("components", ())
    ]
    relations = tuple(
        Relation(
            _need(one, "type", source),
            {_need(ref, "role", source): _need(ref, "id", source) for ref in one},
            _order(one.get("order", "0"), source),
        )
        for one in parts.get("relations", ())
    )
    return Model(root.get("version", ""), _by_id(components, source), relations, tuple(cases), source)


def _tag(element: ElementTree.Element) -> str:
    """Name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


def _need(element: ElementTree.Element, name: str, source: str) -> str:
    value = element.get(name)
    if value is None:
        raise InputError(f"{source}: <{_tag(element)}>: {name}: missing")
    return value


def _xml_attributes(component: ElementTree.Element, source: str) -> dict[str, Attribute]:
    attributes = {}
    for one in component:
        name = _need(one, "id", source)
        where = f"{source}: component {component.get('id')}: {name}"
        attributes[name] = Attribute(_xml_value(one, where), one.get("unit", "none"))
    return attributes


def _xml_value(attribute: ElementTree.Element, where: str) -> Value:
    """Text of an attribute, or its array or matrix as tuples."""
    inner = next(iter(attribute), None)
    if inner is None:
        return (attribute.text or "").strip()
    if _tag(inner) == "array_of_arrays":
        return tuple(_xml_array(one, where) for one in inner)
    if _tag(inner) == "matrix" and inner.get("code") is None:
        return tuple(tuple((one.text or "").strip() for one in row) for row in inner)
    return _xml_array(inner, where)


def _xml_array(array: ElementTree.Element, where: str) -> tuple[Any, ...]:
    if (code := array.get("code")) is not None:
        return decoded(code, (array.text or "").strip(), where)
    return tuple((one.text or "").strip() for one in array)


def decoded(code: str, text: str, where: str) -> tuple[float, ...]:
    """Return the numbers of an array in base64.

    Parameters
    ----------
    code : {"float64", "float32", "int32"}
    text : str
    where : str
        In front of messages.

    Examples
    --------
    >>> decoded("float64", "AAAAAAAA8D8AAAAAAAAAQA==", "model")
    (1.0, 2.0)
    """
    require((code in CODES, f"{where}: found the code {code!r:.40}; allowed {', '.join(CODES)}"))
    size = struct.calcsize(f"<{CODES[code]}")
    try:
        content = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError) as error:
        raise InputError(f"{where}: not base64: {error}") from None
    require((len(content) % size == 0, f"{where}: found {len(content)} bytes; allowed multiples of {size}"))
    return struct.unpack(f"<{len(content) // size}{CODES[code]}", content)


def _json(content: bytes, source: str) -> dict[str, Any]:
    """All of a file in JSON, which has a model."""
    try:
        whole = json.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise InputError(f"{source}: not a text file in UTF-8") from None
    except RecursionError:
        raise InputError(f"{source}: nested too deeply") from None
    except ValueError as error:
        raise InputError(f"{source}: not JSON: {error}") from None
    model = _part(whole, "model", dict, source)
    require((model is not None, f'{source}: model: missing; a REXS file in JSON is {{"model": ...}}'))
    return dict(whole)


def _of_json(content: bytes, source: str) -> Model:
    model = _json(content, source)["model"]
    components = [
        Component(
            str(_key(one, "id", source)),
            str(_key(one, "type", source)),
            str(one.get("name") or ""),
            _json_attributes(one, source),
        )
        for one in _tables(model, "components", source)
    ]
    relations = tuple(
        Relation(
            str(_key(one, "type", source)),
            {str(_key(ref, "role", source)): str(_key(ref, "id", source)) for ref in _tables(one, "refs", source)},
            _order(one.get("order") or 0, source),
        )
        for one in _tables(model, "relations", source)
    )
    spectra = model.get("load_spectrum") or []
    cases = [
        LoadCase(
            str(_key(case, "id", source)),
            str(spectrum.get("id", 1)),
            {
                str(_key(one, "id", source)): _json_attributes(one, source)
                for one in _tables(case, "components", source)
            },
        )
        for spectrum in (spectra if isinstance(spectra, list) else [spectra])
        for case in _tables(spectrum, "load_cases", source)
    ]
    return Model(str(model.get("version", "")), _by_id(components, source), relations, tuple(cases), source)


def _part(table: Any, name: str, kind: type, source: str) -> Any:
    """A part of a table of JSON, of a kind; None where it is missing."""
    require((isinstance(table, dict), f"{source}: found {table!r:.40} where an object with {name} should be"))
    part = table.get(name)
    right = part is None or isinstance(part, kind)
    require((right, f"{source}: {name}: found {part!r:.40}; allowed a JSON {'array' if kind is list else 'object'}"))
    return part


def _tables(table: Any, name: str, source: str) -> Iterator[dict[str, Any]]:
    for one in _part(table, name, list, source) or []:
        require((isinstance(one, dict), f"{source}: {name}: found {one!r:.40}; allowed JSON objects"))
        yield one


def _key(table: dict[str, Any], name: str, source: str) -> Any:
    require((table.get(name) is not None, f"{source}: {str(table)[:60]}: {name}: missing"))
    return table[name]


def _json_attributes(component: dict[str, Any], source: str) -> dict[str, Attribute]:
    """Attributes of a component: the value of each is under the name of its kind, as "floating_point"."""
    attributes = {}
    for one in _tables(component, "attributes", source):
        name = str(_key(one, "id", source))
        kinds = [kind for kind in one if kind not in ("id", "unit")]
        if not kinds:
            continue
        value = one[kinds[0]]
        if isinstance(value, dict):
            code, text = str(value.get("code")), str(value.get("value", ""))
            value = decoded(code, text, f"{source}: component {component.get('id')}: {name}")
        if value is not None:
            attributes[name] = Attribute(_frozen(value), str(one.get("unit") or "none"))
    return attributes


def _frozen(value: Any) -> Value:
    if isinstance(value, list | tuple):
        return tuple(_frozen(one) for one in value)
    return value if isinstance(value, bool | int | float) else str(value)


def _order(value: Any, source: str) -> int:
    try:
        return round(number_in(value) if isinstance(value, str) else float(value))
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{source}: relation: order: found {value!r:.40}; allowed a number") from None


def _by_id(components: list[Component], source: str) -> dict[str, Component]:
    """Components by id, which no two share."""
    by_id: dict[str, Component] = {}
    for one in components:
        require((one.id not in by_id, f"{source}: component {one.id}: found twice; allowed once"))
        by_id[one.id] = one
    return by_id
