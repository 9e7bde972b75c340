"""The results of a run described as an RO-Crate, a page of metadata that archives and other programs read.

After the profile Process Run Crate: which files were made, from which config, with which software.
"""

import json
import mimetypes
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

import netCDF4
from rocrate.model.contextentity import ContextEntity
from rocrate.rocrate import ROCrate

from ratd import __version__

__all__ = ["describe"]

PROFILE = "https://w3id.org/ro/wfrun/process/0.5"
NETCDF = "application/x-netcdf"
HELD = (".nc", ".csv", ".pdf", ".png", ".svg")
"""Ends of the names of tables and figures."""


def describe(files, settings, say):
    """The output ``crate`` of a job of the pipeline.

    Parameters
    ----------
    files : sequence of path-like
        The config, and what is to be there; all tables and figures below the folder of the first are described.
    settings : dict
        Empty.
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        ``crate`` -> JSON, to be written as ``ro-crate-metadata.json`` beside the first file, the config.
    """
    config = Path(files[0])
    held = {path for suffix in HELD for path in config.parent.rglob(f"*{suffix}")}
    finished = {path for path in held if not any(part.endswith(".partial") for part in path.parts)}
    results = sorted(({Path(path) for path in files} | finished) - {config})
    crate = ROCrate()
    crate.name = f"Results of ratd in {config.parent.name}"
    crate.description = "Dust aggregates, every monomer integrated: data, tables and figures of a run of the pipeline"
    crate.license = "https://spdx.org/licenses/MIT"
    newest = max(path.stat().st_mtime for path in (config, *results))
    crate.datePublished = datetime.fromtimestamp(newest, UTC).isoformat(timespec="seconds")
    crate.root_dataset["conformsTo"] = {"@id": PROFILE}
    crate.add(ContextEntity(crate, PROFILE, {"@type": "CreativeWork", "name": "Process Run Crate", "version": "0.5"}))
    programs = [
        _software(crate, "ratd", __version__),
        _software(crate, "snakemake", metadata.version("snakemake")),
    ]
    given = _file(crate, config, config.parent)
    made = [_file(crate, path, config.parent) for path in results]
    action = {
        "@type": "CreateAction",
        "name": "Run of the pipeline",
        "endTime": crate.datePublished.isoformat(timespec="seconds"),
    }
    action = crate.add(ContextEntity(crate, "#run", action))
    action["instrument"], action["object"], action["result"] = programs[0], [given], made
    programs[0]["softwareRequirements"] = programs[1]
    crate.root_dataset["mentions"] = [action]
    say(f"{len(made)} files described")
    return {"crate": json.dumps(crate.metadata.generate(), indent=2, ensure_ascii=False) + "\n"}


def _software(crate, name, version):
    about = {"@type": "SoftwareApplication", "name": name, "softwareVersion": version}
    return crate.add(ContextEntity(crate, f"#{name}", about))


def _file(crate, path, folder):
    """One file, with what a netCDF file says of itself."""
    form = NETCDF if path.suffix == ".nc" else mimetypes.guess_type(path.name)[0] or "application/yaml"
    about = {"name": path.name, "encodingFormat": form, "contentSize": str(path.stat().st_size)}
    if path.suffix == ".nc":
        with netCDF4.Dataset(path) as file:
            about["name"] = f"{file.title} ({path.name})"
            about["identifier"] = file.content_hash
            about["description"] = f"settings {file.settings_hash}, source {file.code_hash}, {file.versions}"
    return crate.add_file(path, str(path.relative_to(folder)), properties=about)
