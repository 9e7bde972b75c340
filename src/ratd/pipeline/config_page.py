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
        about = _whole(about, layout)
        allowed = " ".join(about.get("description", "").split())
        yield f"| `{inside}{key}` | {about.get('title', '')} | {allowed} |\n"
        yield from _rows(about.get("properties", {}), layout, f"{inside}{key}.")
        items = _whole(about.get("items", {}), layout)
        yield from _rows(items.get("properties", {}), layout, f"{inside}{key}[].")


def _whole(about, layout):
    """What a schema says of a key, with what it refers to."""
    if "$ref" not in about:
        return about
    return layout["$defs"][about["$ref"].rpartition("/")[2]] | about


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
