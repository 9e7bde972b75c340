"""Configs of any experiment: YAML is read, one file laid over another, and checked against its JSON schema.

A schema says in words what each key may hold, so that every error is one sentence: where, what, what is allowed.
"""

import math
from pathlib import Path

import jsonschema
import yaml

from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS, Material, mix
from ratd.base.units import GPA, MJ_PER_M2, NM, PS

# 10.0 is no whole number here: it would not do as the length of a list
_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine(
        "integer", lambda checker, value: isinstance(value, int) and not isinstance(value, bool)
    ),
)

_MATERIAL_KEYS = {
    "surface_energy_mJ_m2": ("surface_energy", MJ_PER_M2),
    "youngs_modulus_GPa": ("youngs_modulus", GPA),
    "poisson_number": ("poisson_number", 1.0),
    "density_kg_m3": ("density", 1.0),
    "critical_rolling_displacement_nm": ("critical_rolling_displacement", NM),
    "viscous_time_ps": ("viscous_time", PS),
}
"""Key in materials.yaml -> attribute of `Material` and its unit in SI."""


def read_yaml(path):
    """Content of a YAML file.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    object

    Raises
    ------
    InputError
        One sentence with the file, and the line where it is not YAML.
    """
    try:
        return yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        place = getattr(error, "problem_mark", None)
        where = f"line {place.line + 1}: " if place else ""
        raise InputError(f"{path}: {where}is not YAML ({getattr(error, 'problem', error)})") from error


def merge(base, over):
    """Config with some keys replaced, as Snakemake does with `--configfile`: mappings key by key, lists as a whole.

    Parameters
    ----------
    base, over : dict

    Returns
    -------
    dict
    """
    result = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(base.get(key), dict)
        result[key] = merge(base[key], value) if both else value
    return result


def check_layout(content, layout, where, inside=()):
    """Raise an error unless some content is laid out as a JSON schema says.

    Parameters
    ----------
    content : object
        Of a YAML file.
    layout : dict
        The JSON schema; each part has a `description` that says what is allowed.
    where : str
        Name of the content, for the message.
    inside : tuple of str, optional
        Keys that lead to the content, for the message.

    Raises
    ------
    InputError
        One sentence with the key, its value and what is allowed.
    """
    errors = _Validator(layout).iter_errors(content)
    for error in sorted(errors, key=lambda error: [str(part) for part in error.absolute_path]):
        raise InputError(f"{where}: {_sentence(error, layout, inside)}")


def _sentence(error, layout, inside):
    """What is wrong, from an error of jsonschema."""
    key = _dotted((*inside, *error.absolute_path))
    if error.validator == "additionalProperties":
        unknown = sorted(set(error.instance) - set(error.schema["properties"]), key=str)[0]
        place = f" in {key}" if key else ""
        return f"the key {unknown!r}{place} is unknown; allowed: {', '.join(error.schema['properties'])}"
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in error.instance)
        part = error.schema.get("properties", {}).get(missing, error.schema)
        if "$ref" in part:
            part = layout["$defs"][part["$ref"].rpartition("/")[2]]
        return f"the key {f'{key}.{missing}' if key else missing} is missing; allowed: {part['description']}"
    return (
        f"{key or 'it'} is {error.instance!r}{_text(error)}; allowed: {error.schema.get('description', error.message)}"
    )


def _text(error):
    """A hint where a number without a point, such as 1e14, was taken for text, which YAML 1.1 does."""
    if error.validator != "type" or not isinstance(error.instance, str):
        return ""
    try:
        number = float(error.instance)
    except ValueError:
        return ""
    mantissa, e, exponent = repr(number).partition("e")
    written = f"{mantissa}{'' if '.' in mantissa else '.0'}{e}{exponent}"
    return f" (text for YAML; as a number it is written {written})" if math.isfinite(number) else ""


def _dotted(path):
    """A place in nested mappings and lists, such as ``snapshots.grains[0].seed``."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.removeprefix(".")


def read_materials(path, layout):
    """Materials of Table 2 together with those of a file.

    Parameters
    ----------
    path : path-like
        Such as `config/materials.yaml`.
    layout : dict
        Its JSON schema.

    Returns
    -------
    dict of str to Material

    Raises
    ------
    InputError
        One sentence with the file, the material and the key.
    """
    content = read_yaml(path)
    check_layout(content, layout, str(path))
    table = dict(MATERIALS)
    for name, entry in (content or {}).items():
        if name in MATERIALS:
            raise InputError(f"{path}: {name!r} is a material of Table 2 already; allowed: any other name")
        try:
            if "mix" in entry:
                table[name] = mix(name, entry["mix"], table)
            else:
                values = {_MATERIAL_KEYS[key][0]: value * _MATERIAL_KEYS[key][1] for key, value in entry.items()}
                table[name] = Material(name, **values)
        except InputError as error:
            raise InputError(f"{path}: {name}: {error}") from error
    return table


def load(*paths):
    """Content of some config files, each of which stands over those before it.

    Parameters
    ----------
    *paths : path-like

    Returns
    -------
    dict

    Raises
    ------
    InputError
        If one is no mapping.
    """
    merged = {}
    for path in paths:
        content = read_yaml(path)
        if not isinstance(content, dict):
            raise InputError(f"{path}: is {content!r}; allowed: a mapping of keys, see config/README.md")
        merged = merge(merged, content)
    return merged


def section(config, name, schemas="config/schema"):
    """Keys of one experiment, checked as far as its schema says, together with the keys that all share.

    Parameters
    ----------
    config : dict
        The merged config.
    name : str
        Of the experiment: its key in the config, and the name of its schema.
    schemas : path-like, optional
        Folder of the JSON schemas.

    Returns
    -------
    shared : dict
        The config without the experiments; ``results`` without a slash at its end.
    own : dict
        The keys of the experiment.
    materials : dict of str to Material
        Table 2 and the materials of the user.

    Raises
    ------
    InputError
        One sentence that names the first key that is wrong, and what is allowed.
    """
    schemas = Path(schemas)
    layout = read_yaml(schemas / "config.schema.yaml")
    _check_finite(config, ())
    check_layout(config, layout, "config")
    if name not in config:
        raise InputError(f"config: the key {name} is missing; allowed: {layout['properties'][name]['description']}")
    own = config[name]
    check_layout(own, read_yaml(schemas / f"{name}.schema.yaml"), "config", inside=(name,))
    shared = {key: value for key, value in config.items() if key in layout["required"]}
    shared["results"] = shared["results"].rstrip("/") or "/"
    return shared, own, read_materials(config["materials_file"], read_yaml(schemas / "materials.schema.yaml"))


def _check_finite(value, path):
    """YAML has .nan and .inf, which no key may hold and which pass for numbers."""
    if isinstance(value, dict):
        for key, part in value.items():
            _check_finite(part, (*path, key))
    elif isinstance(value, list):
        for k, part in enumerate(value):
            _check_finite(part, (*path, k))
    elif isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"config: {_dotted(path)} is {value}; allowed: finite numbers")


def as_text(files, settings, say):
    """The merged config as YAML, the output ``config`` of a job of the pipeline."""
    return {"config": yaml.safe_dump(settings, sort_keys=False, allow_unicode=True)}
