# Ensemble: the table of all grains, statistics per cell, and the fit beside Table 3.


rule ensemble:
    input:
        grains=lambda w: PLAN.grown_files(
            "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc", w.drive
        ),
        marks=lambda w: [
            f"<results>/disruption/{w.drive}/{material}/{type}/{size}nm.nc"
            for material, type, size in PLAN.cells_of(w.drive)
        ],
    output:
        table="<results>/ensemble/{drive}/grains.nc",
        table_csv="<results>/ensemble/{drive}/grains.csv",
        cells="<results>/ensemble/{drive}/cells.nc",
        cells_csv="<results>/ensemble/{drive}/cells.csv",
        fit="<results>/ensemble/{drive}/table3.nc",
        fit_csv=report(
            "<results>/ensemble/{drive}/table3.csv",
            caption="../report/table3.rst",
            category="Tables",
            labels={"table": "Table 3", "drive": "{drive}"},
        ),
    log:
        "<results>/logs/ensemble/{drive}.log",
    benchmark:
        "<results>/benchmarks/ensemble/{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=3000,
        runtime=60,
    params:
        code=CODE["ensemble"],
        settings=lambda w: PLAN.ensemble(w.drive),
    message:
        "Fit the ensemble ({wildcards.drive})"
    script:
        "../scripts/ensemble.py"


# All grains of the config as grown, those too that `seeds.fewer` leaves out: what needs no spin-up is known of them.
rule grown:
    input:
        PLAN.all_files("<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc"),
    output:
        table="<results>/ensemble/grown.nc",
        table_csv="<results>/ensemble/grown.csv",
    log:
        "<results>/logs/ensemble/grown.log",
    benchmark:
        "<results>/benchmarks/ensemble/grown.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=3000,
        runtime=60,
    params:
        code=CODE["grown"],
        settings={},
    message:
        "Tabulate the grown grains"
    script:
        "../scripts/grown.py"


# What the monomers are made of: nothing in the config decides it.
rule composition:
    output:
        table1_nc="<results>/tables/table1.nc",
        table1_csv=report(
            "<results>/tables/table1.csv",
            caption="../report/table1.rst",
            category="Tables",
            labels={"table": "Table 1", "drive": "none"},
        ),
        table1_md="<results>/tables/table1.md",
        table2_nc="<results>/tables/table2.nc",
        table2_csv=report(
            "<results>/tables/table2.csv",
            caption="../report/table2.rst",
            category="Tables",
            labels={"table": "Table 2", "drive": "none"},
        ),
        table2_md="<results>/tables/table2.md",
    log:
        "<results>/logs/tables/composition.log",
    benchmark:
        "<results>/benchmarks/tables/composition.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        code=CODE["composition"],
        settings={},
    message:
        "Tables 1 and 2, what the monomers are made of"
    script:
        "../scripts/composition.py"


rule tables:
    input:
        expand("<results>/tables/table{number}.csv", number=[1, 2]),
        expand("<results>/ensemble/{drive}/table3.csv", drive=PLAN.config["drives"]),
