"""Settings: Python values become the text of a scene file, whose keys the library checks."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping
from typing import Any, ClassVar

from ._errors import InputError
from ._pinhole import keys_of, keys_of_data, short_forms

#: Keys that say how a file is read, which are arguments of ``read`` under their own names, or tables of arrays.
_READING = {"format", "frame", "topology", "columns", "radius"}

#: The keys of a scene file that are about data. They are arguments of ``Spheres`` and ``read``.
DATA_KEYS = tuple(key for key in (*keys_of_data(), "elements", "materials") if key not in _READING)

#: The keys of a scene file that are about pictures. They are arguments of ``render``.
PICTURE_KEYS = tuple(
    key for key in keys_of("") if key not in {*DATA_KEYS, *_READING, "data", "kind", "spheres", "cylinders", "cones", "tubes", "camera_path"}
)

#: Short forms of keys of tables, which are called like the flags of the program.
SHORT = {name: (table, key) for name, table, key in short_forms()}

#: A text, with the argument of each of its lines, and the kind of data that was asked for.
Text = tuple[str, list[str], "str | None"]


def value(item: Any, argument: str) -> str:
    """Writes a value in TOML."""
    if hasattr(item, "tolist"):  # NumPy arrays and scalars
        item = item.tolist()
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, int):
        return str(item)
    if isinstance(item, float):
        if math.isnan(item):
            return "nan"
        return repr(item) if math.isfinite(item) else ("inf" if item > 0 else "-inf")
    if isinstance(item, str):
        return quoted(item)
    if isinstance(item, Mapping):
        pairs = (f"{bare(key)} = {value(of, f'{argument}.{key}')}" for key, of in item.items() if of is not None)
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(item, (list, tuple)):
        return "[" + ", ".join(value(of, argument) for of in item) + "]"
    if hasattr(item, "__fspath__"):
        return quoted(str(item))
    raise InputError(
        f"{argument}: {type(item).__name__} cannot be a setting; write a number, a text, a list or a dict"
    )


def quoted(text: str) -> str:
    """Writes a text in TOML."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04X}" for c in escaped) + '"'


def bare(key: object) -> str:
    """Writes a key in TOML."""
    text = str(key)
    return text if re.fullmatch("[A-Za-z0-9_-]+", text) else quoted(text)


def scene_text(settings: Mapping[str, Any]) -> Text:
    """Writes the text of a scene file, and returns the argument of each line as well."""
    lines: list[tuple[str, str]] = []
    tables: list[tuple[str, str]] = []
    for key, item in settings.items():
        if item is None or key == "kind":
            continue
        if isinstance(item, Mapping):
            tables.append((f"[{key}]", key))
            for inner, of in item.items():
                if of is not None:
                    argument = f"{key}.{inner}"
                    tables.append((f"{bare(inner)} = {value(of, argument)}", argument))
        elif isinstance(item, (list, tuple)) and item and all(isinstance(of, Mapping) for of in item):
            for index, of in enumerate(item):
                argument = f"{key}[{index}]"
                tables.append((f"[[{key}]]", argument))
                for inner, inside in of.items():
                    if inside is not None:
                        tables.append((f"{bare(inner)} = {value(inside, argument)}", f"{argument}.{inner}"))
        else:
            lines.append((f"{key} = {value(item, key)}", key))
    all_lines = lines + tables
    text = "".join(f"{line}\n" for line, _ in all_lines)
    return text, [argument for _, argument in all_lines], settings.get("kind")


class Tagged(dict[str, Any]):
    """A table with the name of the argument that takes it."""

    #: The argument that takes the table, or a list of such tables.
    argument: ClassVar[str] = ""


def refuse_misplaced(argument: str, item: Any) -> None:
    """Refuses a table, or a list of tables, that belongs to another argument."""
    for of in item if isinstance(item, (list, tuple)) else (item,):
        if isinstance(of, Tagged) and of.argument != argument:
            raise InputError(f"{argument}: the table {type(of).__name__} is for {of.argument}")


def refuse_unknown(settings: Mapping[str, Any], known: tuple[str, ...], other: tuple[str, ...], where: str) -> None:
    """Refuses arguments that do not exist, and tables of other arguments."""
    for name, item in settings.items():
        if name in known:
            refuse_misplaced(name, item)
            continue
        if name in other:
            raise InputError(f"{name} is not an argument here; give it to {where}")
        close = difflib.get_close_matches(name, known, n=1)
        hint = f"; did you mean {close[0]}?" if close else f"; the settings are {', '.join(known)}"
        raise InputError(f"there is no argument {name}{hint}")


def data_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Returns checked settings about data."""
    refuse_unknown(settings, (*DATA_KEYS, "kind"), (*PICTURE_KEYS, *SHORT, "size"), "render(...)")
    settings = {key: item for key, item in settings.items() if item is not None}
    if "select" in settings:
        settings["select"] = selection(settings["select"])
    if not isinstance(settings.get("select", ""), str):
        raise InputError('select is not a text; write one such as "x > 0", or leave out rows before: positions[mask]')
    if not isinstance(settings.get("kind", ""), str):
        raise InputError(f'kind is {settings["kind"]!r}; write the name of a kind, such as "crystal", or "plain"')
    if "show" in settings:
        settings["show"] = show_tables(settings["show"])
    material = settings.get("material")
    if isinstance(material, (list, tuple)):
        raise InputError("material: values for each sphere are an argument of Spheres(...); give one Material")
    if isinstance(material, Mapping):
        # A material given directly becomes a named material, as in a scene file.
        settings["materials"] = {**settings.get("materials", {}), "given": dict(material)}
        settings["material"] = "given"
    return settings


def selection(given: Any) -> Any:
    """A selection as a text. A dict such as ``{"resn": "HEM", "chain": ["A", "B"]}`` is one, too."""
    if not isinstance(given, Mapping):
        return given
    values = ((key, of if isinstance(of, (list, tuple)) else [of]) for key, of in given.items())
    return " and ".join(f"{key} {' '.join(str(one) for one in of)}" for key, of in values)


def show_tables(given: Any) -> list[Mapping[str, Any]]:
    """Returns rules for what is drawn as tables. A rule may be a style, or a selection, a style and perhaps a dict."""
    is_one = isinstance(given, (str, Mapping)) or (isinstance(given, tuple) and given and isinstance(given[0], str))
    rules: list[Mapping[str, Any]] = []
    for rule in [given] if is_one else given:
        if isinstance(rule, Mapping):
            rules.append(rule)
        elif isinstance(rule, str):
            rules.append({"as": rule})
        elif isinstance(rule, (list, tuple)) and len(rule) in (2, 3):
            chosen, style, *more = rule
            rules.append({"select": selection(chosen), "as": style, **(more[0] if more else {})})
        else:
            raise InputError(f"show: {rule!r} is no rule; write one such as (\"resname HEM\", \"sticks\")")
    return rules


def material_tables(given: list[Any], known: Any) -> tuple[dict[str, Any], list[str]]:
    """Adds materials of single spheres, names or tables, to the table ``materials``. Returns it and their names."""
    tables: dict[str, Any] = {} if known is None else dict(known)
    names = []
    for index, one in enumerate(given):
        if isinstance(one, str):
            if one not in tables:
                there = ", ".join(tables) or "none"
                raise InputError(f"material: there is no material {one!r}; materials has {there}")
            names.append(str(one))
            continue
        refuse_misplaced("material", one)
        name = f"given {index}"
        tables[name] = dict(one)
        names.append(name)
    return tables, names


def data_text(settings: Mapping[str, Any]) -> Text:
    """Writes settings about data as the text of a scene file."""
    if not settings.keys() - {"kind"}:
        return ("", [], settings.get("kind"))
    return scene_text({"data": "spheres", **settings})


def picture_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Returns checked settings about a picture, with short forms in their tables."""
    refuse_unknown(settings, (*PICTURE_KEYS, *SHORT, "size", "light"), (*DATA_KEYS, "kind"), "Spheres(...), read(...) or with_(...)")
    tables: dict[str, Any] = {key: item for key, item in settings.items() if key in PICTURE_KEYS and item is not None}
    for name in ("legend", "scale_bar", "axes"):
        if isinstance(tables.get(name), bool) and tables.pop(name):
            tables[name] = {}
    for name in ("labels", "lights"):
        if isinstance(tables.get(name), (str, Mapping)):
            tables[name] = [tables[name]]
    if isinstance(tables.get("labels"), (list, tuple)):
        tables["labels"] = [{"text": label} if isinstance(label, str) else label for label in tables["labels"]]
    light = settings.get("light")
    if light is not None:
        if "integrator" in tables:
            raise InputError("light and integrator say the same; remove one of them")
        tables["integrator"] = light
    size = settings.get("size")
    if size is not None:
        try:
            width, height = size
        except (TypeError, ValueError):
            raise InputError(f"size is {size!r}; write (width, height) in pixels") from None
        tables["film"] = {**tables.get("film", {}), "width": width, "height": height}
    for name, (table, key) in SHORT.items():
        if settings.get(name) is None:
            continue
        inside = tables.setdefault(table, {})
        if not isinstance(inside, Mapping):
            raise InputError(f"{table} is {inside!r}; it must be a dict")
        if key in inside:
            raise InputError(f"{name} is given twice, also in {table}; remove one of them")
        tables[table] = {**inside, key: settings[name]}
    if tables.get("style") == "path" and "integrator" not in tables and "studio" not in tables:
        # Materials and samples without an integrator would choose a studio.
        tables["integrator"] = "path"
    return tables


def style_of(tables: Mapping[str, Any]) -> Any:
    """Returns the style of a picture. The default is that of a data file in the program."""
    if "style" in tables:
        return tables["style"]
    integrator = tables.get("integrator")
    if integrator == "primary":
        return "fast"
    if integrator == "path" or (integrator is None and ("path" in tables or "sky" in tables)):
        return "path"
    return "default"
