# The pipeline: grow grains, spin them up, find where each is disrupted, fit the ensemble, draw the figures.
#
#     snakemake --cores 2                                      the full paper
#     snakemake --cores 2 --configfile config/quick.yaml       minutes, as with the next two
#     snakemake --cores 2 compression                          another experiment: its own target, its own configs
#     snakemake --cores 2 collision                            collisions of clusters
#
# Settings of Snakemake itself are in profiles/default, which it finds by its name; keys of the config in
# config/README.md.


include: "workflow/rules/common.smk"


configfile: "config/config.yaml"
configfile: "config/spin_up.yaml"
configfile: "config/compression.yaml"
configfile: "config/collision.yaml"


# What is wrong in any experiment is told at once.
PLAN, COMPRESSION, COLLISIONS = checked(
    together,
    *(
        partial(plan, config)
        for plan in (spin_up_plan, compression_plan, collision_plan)
    ),
)
say([*PLAN.notes, *COLLISIONS.notes])


pathvars:
    results=results_folder(config),


report: "workflow/report/workflow.rst"


include: "workflow/rules/aggregates.smk"
include: "workflow/rules/spin_up.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/compression.smk"
include: "workflow/rules/collision.smk"
include: "workflow/rules/collision_document.smk"
include: "workflow/rules/validation.smk"


rule all:
    default_target: True
    input:
        "<results>/config.yaml",
        rules.tables.input,
        rules.figures.input,


rule write_config:
    output:
        config="<results>/config.yaml",
    log:
        "<results>/logs/write_config.log",
    benchmark:
        "<results>/benchmarks/write_config.tsv"
    conda:
        "workflow/envs/ratd.yaml"
    resources:
        mem_mb=500,
        runtime=5,
    params:
        task=task("analyse", "ratd.pipeline.config:as_text"),
        settings=config,
    message:
        "Write down the config"
    script:
        "workflow/scripts/analyse.py"


# What the folder of results holds, from what, with what, for archives: `snakemake --cores 2 crate`.
rule crate:
    input:
        rules.write_config.output.config,
        rules.grains.input,
        rules.spinups.input,
        rules.disruptions.input,
        rules.tables.input,
        rules.figures.input,
    output:
        crate="<results>/ro-crate-metadata.json",
    log:
        "<results>/logs/crate.log",
    benchmark:
        "<results>/benchmarks/crate.tsv"
    conda:
        "workflow/envs/ratd.yaml"
    resources:
        mem_mb=500,
        runtime=30,
    params:
        task=task("analyse", "ratd.pipeline.crate:describe"),
        settings={},
    message:
        "Describe the results as an RO-Crate"
    script:
        "workflow/scripts/analyse.py"


# Snakemake compares results with what it wrote down of them, where it did.
if workflow.is_main_process and not {"--forceall", "-F"} & set(sys.argv):
    # what is forced is known to Snakemake only after it has read this file
    forced = sys.argv if {"--forcerun", "-R"} & set(sys.argv) else ()
    checked(unrecorded.check, workflow.rules, config["results"], forced)


# What is finished needs no pieces any more: a forced rerun is to compute it anew. The clusters of the document on
# collisions are in a folder of their own.
FOLDERS = config["results"], Path(page.SAMPLES).parent


onsuccess:
    tidy(*FOLDERS)


onerror:
    tidy(*FOLDERS)
