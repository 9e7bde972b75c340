"""The tables of config/README.md, made from the schemas: every key, what it is, and what it may hold.

    python -m ratd.pipeline.config_page        # writes them anew

A schema says in `title` what a key is and in `description` what is allowed. An experiment is a key of
`config.schema.yaml` with a schema of its own.
"""

from pathlib import Path

from ratd.pipeline.atomic import write_text
from ratd.pipeline.config import read_yaml

BEGIN, END = "<!-- keys: written by python -m ratd.pipeline.config_page -->\n", "<!-- end of keys -->\n"
HEAD = "| key | what it is | allowed |\n|---|---|---|\n"


def tables(schemas="config/schema"):
    """Tables of all keys: those that all experiments share, then one experiment after the other.

    Parameters
    ----------
    schemas : path-like, optional
        Folder of the JSON schemas.

    Returns
    -------
    str
        Markdown.
    """
    schemas = Path(schemas)
    shared = read_yaml(schemas / "config.schema.yaml")
    experiments = [name for name in shared["properties"] if (schemas / f"{name}.schema.yaml").is_file()]
    common = {key: about for key, about in shared["properties"].items() if key not in experiments}
    parts = ["## Shared keys\n\n" + HEAD + "".join(_rows(common, shared))]
    for name in experiments:
        layout = read_yaml(schemas / f"{name}.schema.yaml")
        parts.append(f"## `{name}`\n\n" + HEAD + "".join(_rows(layout["properties"], layout)))
    return "\n".join(parts)


def _rows(properties, layout, inside=""):
    """A row for each key, and after it for those within it."""
    for key, about in properties.items():
        if about is True:  # another part of the schema says what it is
            continue
        about = _whole(about, layout)
        allowed = " ".join(about.get("description", "").split())
        yield f"| `{inside}{key}` | {about.get('title', '')} | {allowed} |\n"
        for within, sign in (("", "."), ("items", "[]."), ("additionalProperties", ".NAME.")):
            part = about.get(within) if within else about
            # what is only referred to, entry by entry, stands on the page where it is meant for all
            if isinstance(part, dict) and not (within == "additionalProperties" and "$ref" in part):
                yield from _rows(_properties(part, layout), layout, f"{inside}{key}{sign}")


def _properties(about, layout):
    """Keys of a mapping, those too that it has in one case or another."""
    about = _whole(about, layout)
    found = dict(about.get("properties", {}))
    for case in ("then", "else"):
        for key, part in about.get(case, {}).get("properties", {}).items():
            if part is not True:
                part = _whole(part, layout)
                said = found.get(key, {}).get("description", part["description"])
                both = said if said == part["description"] else f"{said}; or {part['description']}"
                found[key] = part | found.get(key, {}) | {"description": both}
    return found


def _whole(about, layout):
    """What a schema says of a key, with what it refers to."""
    for reference in (about, *about.get("allOf", ())):
        if "$ref" in reference:
            about = layout["$defs"][reference["$ref"].rpartition("/")[2]] | about
    return about


def page(text, schemas="config/schema"):
    """A page with the tables between its two marks made anew.

    Parameters
    ----------
    text : str
        The page.
    schemas : path-like, optional

    Returns
    -------
    str
    """
    before, _, rest = text.partition(BEGIN)
    return f"{before}{BEGIN}\n{tables(schemas)}\n{END}{rest.partition(END)[2]}"


if __name__ == "__main__":
    readme = Path("config", "README.md")
    write_text(readme, page(readme.read_text(encoding="utf-8")))
