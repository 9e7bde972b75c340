# The pipeline: grow grains, spin them up, find where each is disrupted, fit the ensemble, draw the figures.
#
#     snakemake --cores 2                                      the full paper
#     snakemake --cores 2 --configfile config/quick.yaml       minutes
#
# Settings of Snakemake itself are in profiles/default, which it finds by its name.
import sys
from pathlib import Path

from snakemake.utils import min_version

from ratd.pipeline import jobs
from ratd.pipeline.config import check, read_yaml
from ratd.base.errors import InputError
from ratd.pipeline.partial import tidy
from ratd.validation.plan import Plan

min_version("9.27")


# Snakemake reads it too, but does not say in which line it is no YAML.
try:
    read_yaml("config/config.yaml")
except InputError as error:
    sys.exit(str(error))


configfile: "config/config.yaml"


try:
    PLAN = check(config)
    CHECKS = Plan("config/validation.yaml")
except InputError as error:
    sys.exit(str(error))

jobs.release_stale_locks()
CODE = jobs.code_hashes(Path(workflow.basedir, "workflow", "scripts"))


pathvars:
    results=PLAN.results,


wildcard_constraints:
    drive=PLAN.pattern("drives"),
    material=PLAN.pattern("materials"),
    type=PLAN.pattern("types"),
    size=PLAN.pattern("sizes"),
    seeds=PLAN.pattern("blocks"),


include: "workflow/rules/grains.smk"
include: "workflow/rules/spinup.smk"
include: "workflow/rules/disruption.smk"
include: "workflow/rules/ensemble.smk"
include: "workflow/rules/parameters.smk"
include: "workflow/rules/calibration.smk"
include: "workflow/rules/formulae.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/validation.smk"


rule all:
    default_target: True
    input:
        "<results>/config.yaml",
        rules.tables.input,
        rules.figures.input,


rule write_config:
    output:
        "<results>/config.yaml",
    log:
        "<results>/logs/write_config.log",
    benchmark:
        "<results>/benchmarks/write_config.tsv"
    conda:
        "workflow/envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        code=CODE["write_config"],
        settings=PLAN.config,
    message:
        "Write down the config"
    script:
        "workflow/scripts/write_config.py"


# What is finished needs no pieces any more: a forced rerun is to compute it anew.
onsuccess:
    tidy(PLAN.results)


onerror:
    tidy(PLAN.results)
