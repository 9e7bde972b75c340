# Spin-up: runs, marks of disruption, the ensemble with its fit, and the studies beside it.
from ratd.experiments.spin_up.plan import RUNS

MARKS = "<results>/disruption/{drive}/{material}/{type}/{size}nm.nc"
TABLE_3 = "<results>/ensemble/{drive}/table3.csv"


rule spin_up:
    input:
        # a drive may want fewer seeds than are grown
        lambda w: PLAN.file(
            GRAINS,
            (w.material, w.type, w.size),
            seeds=PLAN.grown_block((w.material, w.type, w.size), w.seeds),
        ),
    output:
        RUNS,
    log:
        "<results>/logs/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.log",
    benchmark:
        "<results>/benchmarks/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.tsv"
    wildcard_constraints:
        **NAMES,
    priority: lambda w: float(w.size)
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=lambda w, attempt: PLAN.spin_up_minutes(w.size, w.seeds, attempt),
    params:
        task=task("run", "ratd.experiments.spin_up.spin:block", "spinup"),
        settings=lambda w: PLAN.spin_up(w.drive, w.material, w.type, w.size, w.seeds),
    message:
        "Spin up {wildcards.material} {wildcards.type} {wildcards.size} nm, seeds {wildcards.seeds} ({wildcards.drive})"
    script:
        "../scripts/run.py"


rule disrupt:
    input:
        lambda w: PLAN.run_files(RUNS, (w.material, w.type, w.size), w.drive),
    output:
        disruption=MARKS,
    log:
        "<results>/logs/disruption/{drive}/{material}/{type}/{size}nm.log",
    benchmark:
        "<results>/benchmarks/disruption/{drive}/{material}/{type}/{size}nm.tsv"
    wildcard_constraints:
        **NAMES,
    # a matter of seconds, and a result
    priority: 10000
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.spin_up.disrupt:disrupt", "disruption"),
        settings={},
    message:
        "Find where {wildcards.material} {wildcards.type} {wildcards.size} nm is disrupted ({wildcards.drive})"
    script:
        "../scripts/analyse.py"


# The table of all grains, statistics per cell, and the fit beside Table 3.
rule ensemble:
    input:
        grains=lambda w: PLAN.grown_files(GRAINS, w.drive),
        marks=lambda w: PLAN.mark_files(MARKS, w.drive),
    output:
        table="<results>/ensemble/{drive}/grains.nc",
        table_csv="<results>/ensemble/{drive}/grains.csv",
        cells="<results>/ensemble/{drive}/cells.nc",
        cells_csv="<results>/ensemble/{drive}/cells.csv",
        fit="<results>/ensemble/{drive}/table3.nc",
        fit_csv=report(
            TABLE_3,
            caption="../report/table3.rst",
            category="Tables",
            labels={"table": "Table 3, drive {drive}"},
        ),
    log:
        "<results>/logs/ensemble/{drive}.log",
    benchmark:
        "<results>/benchmarks/ensemble/{drive}.tsv"
    wildcard_constraints:
        **NAMES,
    conda:
        "../envs/ratd.yaml"
    resources:
        mem_mb=3000,
        runtime=60,
    params:
        task=task(
            "analyse",
            "ratd.experiments.spin_up.tables:ensemble",
            "table",
            "cells",
            "fit",
        ),
        settings=lambda w: PLAN.ensemble(w.drive),
    message:
        "Fit the ensemble ({wildcards.drive})"
    script:
        "../scripts/analyse.py"


# All grains of the config as grown, those too that `seeds.fewer` leaves out: what needs no spin-up is known of them.
rule grown:
    input:
        PLAN.all_files(GRAINS),
    output:
        table="<results>/ensemble/grown.nc",
        table_csv="<results>/ensemble/grown.csv",
    log:
        "<results>/logs/ensemble/grown.log",
    benchmark:
        "<results>/benchmarks/ensemble/grown.tsv"
    conda:
        "../envs/ratd.yaml"
    resources:
        mem_mb=3000,
        runtime=60,
    params:
        task=task("analyse", "ratd.experiments.spin_up.tables:grown", "table"),
        settings={},
    message:
        "Tabulate the grown grains"
    script:
        "../scripts/analyse.py"


# What the contacts of all grown grains hold at most, pulled, sideways and pushed.
rule firm_bounds:
    input:
        lambda w: PLAN.all_files(GRAINS, w.material, w.type),
    output:
        firm_bounds="<results>/firm_bounds/{material}/{type}.nc",
    log:
        "<results>/logs/firm_bounds/{material}/{type}.log",
    benchmark:
        "<results>/benchmarks/firm_bounds/{material}/{type}.tsv"
    wildcard_constraints:
        **NAMES,
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=60,
    params:
        task=task("analyse", "ratd.experiments.spin_up.firm_bound:table", "firm_bounds"),
        settings={},
    message:
        "Bounds of {wildcards.material} {wildcards.type} from what contacts hold pulled, sideways and pushed"
    script:
        "../scripts/analyse.py"


# What the monomers are made of: nothing in the config decides it.
rule composition:
    output:
        table1="<results>/tables/table1.nc",
        table1_csv=report(
            "<results>/tables/table1.csv",
            caption="../report/table1.rst",
            category="Tables",
            labels={"table": "Table 1"},
        ),
        table2="<results>/tables/table2.nc",
        table2_csv=report(
            "<results>/tables/table2.csv",
            caption="../report/table2.rst",
            category="Tables",
            labels={"table": "Table 2"},
        ),
    log:
        "<results>/logs/tables/composition.log",
    benchmark:
        "<results>/benchmarks/tables/composition.tsv"
    conda:
        "../envs/ratd.yaml"
    resources:
        mem_mb=500,
        runtime=5,
    params:
        task=task(
            "analyse",
            "ratd.experiments.spin_up.composition:tables",
            "table1",
            "table2",
        ),
        settings={},
    message:
        "Tables 1 and 2, what the monomers are made of"
    script:
        "../scripts/analyse.py"


# Pairs of equal monomers that part (Fig. 10).
rule pairs:
    output:
        pairs="<results>/pairs/{material}.nc",
    log:
        "<results>/logs/pairs/{material}.log",
    benchmark:
        "<results>/benchmarks/pairs/{material}.tsv"
    wildcard_constraints:
        **NAMES,
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=60,
    params:
        task=task("analyse", "ratd.experiments.spin_up.pairs:table", "pairs"),
        settings=lambda w: PLAN.pairs(w.material),
    message:
        "Spin up pairs of {wildcards.material} monomers"
    script:
        "../scripts/analyse.py"


# Rolling displacement and viscous time varied (Fig. 9), one job all ways of a type and size.
rule parameters:
    output:
        [
            f"<results>/parameters/{{drive}}/{{type}}/{{size}}nm/{way['label']}.nc"
            for way in PLAN.parameter_ways
        ],
    log:
        "<results>/logs/parameters/{drive}/{type}/{size}nm.log",
    benchmark:
        "<results>/benchmarks/parameters/{drive}/{type}/{size}nm.tsv"
    wildcard_constraints:
        **NAMES,
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=1440,
    params:
        task=task("run", "ratd.experiments.spin_up.same_grains:vary", "disruption"),
        settings=lambda w: PLAN.parameters(w.drive, w.type, w.size),
    message:
        "Vary rolling displacement and viscous time: {wildcards.type} {wildcards.size} nm ({wildcards.drive})"
    script:
        "../scripts/run.py"


rule parameter_table:
    input:
        lambda w: PLAN.parameter_files(
            "<results>/parameters/{drive}/{type}/{size}nm/{label}.nc", w.drive
        ),
    output:
        parameters="<results>/parameters/{drive}.nc",
        parameters_csv=report(
            "<results>/parameters/{drive}.csv",
            caption="../report/parameters.rst",
            category="Tables",
            labels={"table": "Runs of figure 9, drive {drive}"},
        ),
    log:
        "<results>/logs/parameters/{drive}.log",
    benchmark:
        "<results>/benchmarks/parameters/{drive}.tsv"
    wildcard_constraints:
        **NAMES,
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.spin_up.parameters:table", "parameters"),
        settings=lambda w: PLAN.parameter_table(w.drive),
    message:
        "Tabulate the runs of figure 9 ({wildcards.drive})"
    script:
        "../scripts/analyse.py"


# The one free number of the drive literal, from the onset of mass loss in Fig. 4.
rule calibration_runs:
    output:
        "<results>/calibration/{pace}.nc",
    log:
        "<results>/logs/calibration/{pace}.log",
    benchmark:
        "<results>/benchmarks/calibration/{pace}.tsv"
    wildcard_constraints:
        pace=PLAN.pattern("calibration_labels"),
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=1440,
    params:
        task=task("run", "ratd.experiments.spin_up.same_grains:calibrate", "spinup"),
        settings=lambda w: PLAN.calibration_runs(w.pace),
    message:
        "Spin up the cell of the calibration at d omega/dt, f = {wildcards.pace} (literal)"
    script:
        "../scripts/run.py"


rule calibration:
    input:
        expand("<results>/calibration/{pace}.nc", pace=PLAN.calibration_labels),
    output:
        calibration="<results>/calibration/fit.nc",
        calibration_csv=report(
            "<results>/calibration/fit.csv",
            caption="../report/calibration.rst",
            category="Tables",
            labels={"table": "Calibration of the drive literal"},
        ),
    log:
        "<results>/logs/calibration/fit.log",
    benchmark:
        "<results>/benchmarks/calibration/fit.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.spin_up.calibration:fit", "calibration"),
        settings=PLAN.calibration_fit,
    message:
        "Calibrate the drive literal on the onset of mass loss"
    script:
        "../scripts/analyse.py"


# What single formulae of the paper change: one job a formula.
rule formulae:
    output:
        [
            f"<results>/formulae/{{formula}}/{kind}/{size}nm.nc"
            for kind, size in PLAN.formula_cells
        ],
    log:
        "<results>/logs/formulae/{formula}.log",
    benchmark:
        "<results>/benchmarks/formulae/{formula}.tsv"
    wildcard_constraints:
        formula=any_of(PLAN.formulae),
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=1440,
    params:
        task=task("run", "ratd.experiments.spin_up.formula_runs:run", "disruption"),
        settings=lambda w: PLAN.formula_runs(w.formula),
    message:
        "Spin grains up with one formula as printed: {wildcards.formula}"
    script:
        "../scripts/run.py"


rule formula_table:
    input:
        [
            f"<results>/formulae/{formula}/{kind}/{size}nm.nc"
            for formula in PLAN.formulae
            for kind, size in PLAN.formula_cells
        ],
    output:
        formulae="<results>/formulae/table.nc",
        formulae_csv=report(
            "<results>/formulae/table.csv",
            caption="../report/formulae.rst",
            category="Tables",
            labels={"table": "Single formulae as printed"},
        ),
    log:
        "<results>/logs/formulae/table.log",
    benchmark:
        "<results>/benchmarks/formulae/table.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.spin_up.formulae:table", "formulae"),
        settings=PLAN.formula_table,
    message:
        "Tabulate the runs with single formulae as printed"
    script:
        "../scripts/analyse.py"


rule spinups:
    input:
        [
            path
            for drive in PLAN.config["drives"]
            for path in PLAN.run_files(RUNS, drive=drive)
        ],


rule disruptions:
    input:
        [
            path
            for drive in PLAN.config["drives"]
            for path in PLAN.mark_files(MARKS, drive)
        ],


rule tables:
    input:
        expand("<results>/tables/table{number}.csv", number=[1, 2]),
        expand(TABLE_3, drive=PLAN.config["drives"]),
