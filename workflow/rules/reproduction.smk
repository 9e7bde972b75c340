# The reproduction document: its data, collected from the results of the config in use, and what is drawn from them.
# Grains that the data hold already need no results.
#
# `redraw` knows the data as files without a rule behind them, so that it never starts a simulation.
from ratd.provenance import file_hash
from ratd.reproduction.data import FIRM_BOUNDS, FROM_RESULTS, Data

DATA = Data()
DOCS = str(Path(FOLDER).parent)


rule reproduction_data:
    input:
        grown=[] if COLLECTED.grown else [rules.grown.output.table],
        runs=[
            PLAN.file(
                f"<results>/spinup/{drive}/{{material}}/{{type}}/{{size}}nm/seeds_{{seeds}}.nc",
                cell,
                seeds=block,
            )
            for drive in PLAN.config["drives"]
            for cell, block in COLLECTED.missing(drive)
        ],
        firm_bounds=(
            []
            if COLLECTED.grown and DATA.has(FIRM_BOUNDS)
            else [
                f"<results>/firm_bounds/{material}/{type}.nc"
                for material in PLAN.config["materials"]
                for type in PLAN.config["types"]
            ]
        ),
        grains=rules.figure1.input,
        pairs=[
            f"<results>/pairs/{material}.nc"
            for material in PLAN.config["materials"]
            if 10 in PLAN.common_figures
        ],
    output:
        # the other files of the folder are left out here: they would have a rule behind them
        f"{FOLDER}/README.md",
    log:
        "<results>/logs/reproduction_data.log",
    benchmark:
        "<results>/benchmarks/reproduction_data.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        code=CODE["reproduction_data"],
        # what there is of studies, which are not computed for this, with the hash of each file
        settings=lambda w: {
            "config": PLAN.config,
            "studies": {
                name.format(drive=drive): {path: file_hash(path)}
                for drive in PLAN.config["drives"]
                for below, name in FROM_RESULTS.items()
                for path in [f"{PLAN.results}/{below.format(drive=drive)}"]
                if Path(path).is_file()
            },
            "command": "snakemake --cores 2 reproduction_data --configfile CONFIG",
        },
    message:
        "Collect the data of docs/reproduction.md"
    script:
        "../scripts/reproduction_data.py"


rule redraw_figure:
    input:
        unpack(lambda w: DATA.figure_files(int(w.number), w.drive)),
    output:
        f"{DOCS}/figure{{number}}_{{drive}}.png",
    log:
        "<results>/logs/redraw/figure{number}_{drive}.log",
    benchmark:
        "<results>/benchmarks/redraw/figure{number}_{drive}.tsv"
    wildcard_constraints:
        number=r"\d+",
        drive="|".join(DATA.drives) or "none",
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=lambda w: CODE[f"figure{w.number}"],
        script=lambda w: f"figure{w.number}",
        settings=lambda w: DATA.plan.figure(int(w.number), w.drive),
    message:
        "Redraw figure {wildcards.number} ({wildcards.drive})"
    script:
        "../scripts/figure{wildcards.number}.py"


rule redraw_common_figure:
    input:
        unpack(lambda w: DATA.figure_files(int(w.number))),
    output:
        f"{DOCS}/figure{{number}}.png",
    log:
        "<results>/logs/redraw/figure{number}.log",
    benchmark:
        "<results>/benchmarks/redraw/figure{number}.tsv"
    wildcard_constraints:
        number=r"\d+",
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=lambda w: CODE[f"figure{w.number}"],
        script=lambda w: f"figure{w.number}",
        settings=lambda w: DATA.plan.figure(int(w.number)),
    message:
        "Redraw figure {wildcards.number}"
    script:
        "../scripts/figure{wildcards.number}.py"


# What the paper does not have: both drives and bounds beside Table 3, fragments, checks of the validation.
rule redraw_argument:
    input:
        DATA.files,
    output:
        expand(f"{DOCS}/{{name}}.png", name=DATA.further_figures),
    log:
        "<results>/logs/redraw/argument.log",
    benchmark:
        "<results>/benchmarks/redraw/argument.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=CODE["redraw_argument"],
        settings={"folder": FOLDER},
    message:
        "Draw the further figures of docs/reproduction.md"
    script:
        "../scripts/redraw_argument.py"


rule redraw:
    input:
        data=DATA.files or [DATA.path("config.yaml")],
        figures=expand(f"{DOCS}/{{name}}.png", name=DATA.figures),
        further=rules.redraw_argument.output,
        captions=sorted(
            {f"workflow/report/{name.partition('_')[0]}.rst" for name in DATA.figures}
        ),
    output:
        "docs/reproduction.md",
    log:
        "<results>/logs/redraw/reproduction.log",
    benchmark:
        "<results>/benchmarks/redraw/reproduction.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=CODE["redraw"],
        settings={"folder": FOLDER, "pictures": Path(DOCS).name},
    message:
        "Write docs/reproduction.md"
    script:
        "../scripts/redraw.py"
