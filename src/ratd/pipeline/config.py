"""Configs of any experiment: YAML is read, one file laid over another, and checked against its JSON schema.

A schema says in words what each key may hold, so that every error is one sentence: where, what, what is allowed.
"""

import math
from pathlib import Path

import jsonschema
import yaml

from ratd.base.errors import FileError, InputError
from ratd.base.materials import MATERIALS, Material, mix
from ratd.base.units import GPA, MJ_PER_M2, NM, PS

# 10.0 is no whole number here: it would not do as the length of a list
_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine(
        "integer", lambda checker, value: isinstance(value, int) and not isinstance(value, bool)
    ),
)

OWN_FOLDERS = ("benchmarks", "config", "docs", "examples", "profiles", "src", "tests", "workflow")
"""Folders of the project, in which no results may lie."""

LONGEST = 120
"""Characters of a wrong value that a message repeats."""
_MATERIALS_LAYOUT = Path(__file__).with_name("materials.schema.yaml")
_MATERIAL_KEYS = {
    "surface_energy_mJ_m2": ("surface_energy", MJ_PER_M2),
    "youngs_modulus_GPa": ("youngs_modulus", GPA),
    "poisson_number": ("poisson_number", 1.0),
    "density_kg_m3": ("density", 1.0),
    "critical_rolling_displacement_nm": ("critical_rolling_displacement", NM),
    "viscous_time_ps": ("viscous_time", PS),
}
"""Key in materials.yaml -> attribute of `Material` and its unit in SI."""


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
    """YAML in which no key stands twice in one mapping; by libyaml where it is there, in a tenth of the time."""

    def construct_mapping(self, node, deep=False):
        known = set()
        for key, _ in node.value:
            # keys that are merged in with << may be given again
            if key.tag != "tag:yaml.org,2002:merge":
                name = self.construct_object(key, deep=True)
                if name in known:
                    raise yaml.constructor.ConstructorError(
                        None,
                        None,
                        f"the key {name!r} stands in one mapping twice; allowed: each key once",
                        key.start_mark,
                    )
                known.add(name)
        return super().construct_mapping(node, deep)


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
    FileError
        If it cannot be read.
    InputError
        One sentence with the file, and the line where it is not YAML, or where a key stands for the second time.
    """
    try:
        return yaml.load(Path(path).read_text(encoding="utf-8"), _Loader)
    except OSError as error:
        raise FileError(f"{path}: cannot be read ({error.strerror})") from error
    # PyYAML lets the errors of a key that cannot be one, and of a day that is none, through as they are
    except (yaml.YAMLError, UnicodeDecodeError, TypeError, ValueError) as error:
        place = getattr(error, "problem_mark", None)
        where = f"line {place.line + 1}: " if place else ""
        problem = getattr(error, "problem", None) or error
        if isinstance(error, yaml.constructor.ConstructorError):  # such as a key that stands twice
            raise InputError(f"{path}: {where}{problem}") from error
        raise InputError(f"{path}: {where}is not YAML ({problem})") from error


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
        One sentence for each mistake, with the key, its value and what is allowed.
    """
    errors = sorted(_Validator(layout).iter_errors(content), key=lambda error: [str(p) for p in error.absolute_path])
    sentences = dict.fromkeys(f"{where}: {_sentence(error, layout, inside)}" for error in errors)
    if sentences:
        raise InputError("\n".join(sentences))


def _sentence(error, layout, inside):
    """What is wrong, from an error of jsonschema."""
    key = _dotted((*inside, *error.absolute_path))
    if "propertyNames" in error.absolute_schema_path:
        place = f" in {key}" if key else ""
        return f"the key {error.instance!r}{place} is no name; allowed: {error.schema['description']}"
    if error.validator == "additionalProperties":
        unknown = sorted(set(error.instance) - set(error.schema["properties"]), key=str)
        place = f" in {key}" if key else ""
        named = f"key {unknown[0]!r}{place} is" if len(unknown) == 1 else f"keys {', '.join(unknown)}{place} are"
        return f"the {named} unknown; allowed: {', '.join(error.schema['properties'])}"
    if error.validator == "required":
        # jsonschema has one error for each missing key, and says which only in its words
        missing = next(name for name in error.validator_value if error.message.startswith(f"{name!r} "))
        part = error.schema.get("properties", {}).get(missing, error.schema)
        if "$ref" in part:
            part = layout["$defs"][part["$ref"].rpartition("/")[2]]
        return f"the key {f'{key}.{missing}' if key else missing} is missing; allowed: {part['description']}"
    value = repr(error.instance)
    if len(value) > LONGEST:
        value = f"{value[:LONGEST]} ..."
    return f"{key or 'it'} is {value}{_text(error)}; allowed: {error.schema.get('description', error.message)}"


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


def read_materials(path):
    """The materials of ratd together with those of a file.

    Parameters
    ----------
    path : path-like
        Such as `config/materials.yaml`; what it may hold stands in `src/ratd/pipeline/materials.schema.yaml`.

    Returns
    -------
    dict of str to Material

    Raises
    ------
    FileError
        If it cannot be read.
    InputError
        One sentence with the file, the material and the key.
    """
    content = read_yaml(path)
    check_layout(content, read_yaml(_MATERIALS_LAYOUT), str(path))
    table = dict(MATERIALS)
    for name, entry in (content or {}).items():
        if name in MATERIALS:
            raise InputError(f"{path}: {name!r} is a material of ratd already; allowed: any other name")
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


def together(*steps):
    """Take some steps, and only then raise what was refused.

    Parameters
    ----------
    *steps : callable
        Without arguments.

    Returns
    -------
    list
        What each step gave.

    Raises
    ------
    InputError
        The sentences of all steps that were refused, a line each, none twice.
    """
    results, sentences = [], {}
    for step in steps:
        try:
            results.append(step())
        except (FileError, InputError) as error:
            sentences |= dict.fromkeys(str(error).splitlines())
    if sentences:
        raise InputError("\n".join(sentences))
    return results


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
        Those of ratd and of the user.

    Raises
    ------
    InputError
        One sentence for each key that is wrong, and what is allowed.
    """
    schemas = Path(schemas)
    layout = read_yaml(schemas / "config.schema.yaml")
    _check_finite(config, ())
    if name not in config:
        raise InputError(f"config: the key {name} is missing; allowed: {layout['properties'][name]['description']}")
    own = config[name]
    shared = {key: value for key, value in config.items() if key in layout["required"]}
    *_, materials = together(
        lambda: check_layout(config, layout, "config"),
        lambda: check_layout(own, read_yaml(schemas / f"{name}.schema.yaml"), "config", inside=(name,)),
        lambda: check_results_folder(shared.get("results")),
        lambda: _materials_of(shared.get("materials_file")),
    )
    shared["results"] = shared["results"].rstrip("/") or "/"
    return shared, own, materials


def _materials_of(path):
    """Materials of the user's file; a path that is none is told by the schema."""
    if isinstance(path, str):
        return read_materials(path)


def base(name, schemas="config/schema"):
    """Keys of one experiment in the file that comes with ratd, beside the folder of the schemas."""
    return read_yaml(Path(schemas).parent / f"{name}.yaml")[name]


def with_parts(own, parts):
    """Keys of an experiment in which null for a whole part stands for null for each of its entries.

    Parameters
    ----------
    own : dict
    parts : dict of str to sequence of str
        Such as ``figures`` -> the names of all figures.

    Returns
    -------
    dict
    """
    return own | {name: dict.fromkeys(entries) for name, entries in parts.items() if own[name] is None}


def left_out(where, mistake):
    """What to say of a part of a base file that names what the config does not have.

    Parameters
    ----------
    where : str
        The part.
    mistake : str
        What would be said were the part the user's own: key, value and what is allowed.

    Returns
    -------
    str
    """
    return f"config: {where} is left out, since the config has no such grains ({mistake.partition(';')[0].lstrip('.')})"


def check_results_folder(results, project="."):
    """Raise InputError unless a folder of results is one of its own: whatever lies in it may be made anew.

    Parameters
    ----------
    results : object
        What is no path, or none at all, is told by the schema.
    project : path-like, optional
        Folder of the project, whose own folders hold no results.
    """
    if not isinstance(results, str) or not results:
        return
    project = Path(project).resolve()
    folder = (project / results).resolve()
    inside = folder.relative_to(project).parts[:1] if folder.is_relative_to(project) else ()
    holds_others = project.is_relative_to(folder) or Path.home().is_relative_to(folder)
    if holds_others or set(inside) & set(OWN_FOLDERS) or inside and inside[0].startswith("."):
        raise InputError(
            f"config: results is {results!r}; allowed: the path of a folder that holds nothing else, such as "
            f"results/mine, and neither {', '.join(OWN_FOLDERS)} nor what this project or your home lies in"
        )


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
