# What single formulae of the paper change: one job a formula.
FORMULAE = PLAN.formulae

if FORMULAE:
    OF_FORMULA = [
        f"<results>/formulae/{{formula}}/{kind}/{size}nm.nc"
        for kind, size in PLAN.formula_cells
    ]

    rule formulae:
        output:
            OF_FORMULA,
        log:
            "<results>/logs/formulae/{formula}.log",
        benchmark:
            "<results>/benchmarks/formulae/{formula}.tsv"
        wildcard_constraints:
            formula="|".join(FORMULAE),
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=1440,
        params:
            code=CODE["formulae"],
            settings=lambda w: PLAN.formula_runs(w.formula),
        message:
            "Spin grains up with one formula as printed: {wildcards.formula}"
        script:
            "../scripts/formulae.py"

    rule formula_table:
        input:
            [
                path.format(formula=formula)
                for formula in FORMULAE
                for path in OF_FORMULA
            ],
        output:
            nc="<results>/formulae/table.nc",
            csv=report(
                "<results>/formulae/table.csv",
                caption="../report/formulae.rst",
                category="Tables",
                labels={"table": "Single formulae as printed", "drive": "prescribed"},
            ),
        log:
            "<results>/logs/formulae/table.log",
        benchmark:
            "<results>/benchmarks/formulae/table.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1000,
            runtime=30,
        params:
            code=CODE["formula_table"],
            settings={
                "formulae": [
                    formula for formula in FORMULAE for cell in PLAN.formula_cells
                ]
            },
        message:
            "Tabulate the runs with single formulae as printed"
        script:
            "../scripts/formula_table.py"

    rule formula_figure:
        input:
            "<results>/formulae/table.nc",
        output:
            pdf=report(
                "<results>/figures/formulae.pdf",
                caption="../report/formulae.rst",
                category="Figures",
                labels={
                    "figure": "formulae",
                    "drive": "prescribed",
                    "format": "PDF",
                },
            ),
            png=report(
                "<results>/figures/formulae.png",
                caption="../report/formulae.rst",
                category="Figures",
                labels={
                    "figure": "formulae",
                    "drive": "prescribed",
                    "format": "PNG",
                },
            ),
        log:
            "<results>/logs/figures/formulae.log",
        benchmark:
            "<results>/benchmarks/figures/formulae.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=30,
        params:
            code=CODE["formula_figure"],
            settings={},
        message:
            "Draw what single formulae change when they are used as printed"
        script:
            "../scripts/formula_figure.py"
