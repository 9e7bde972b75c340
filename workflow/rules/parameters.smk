# Figure 9: rolling displacement and viscous time varied, one job all ways of a type and size.
PARAMETER_WAYS = PLAN.parameter_ways

if PARAMETER_WAYS:

    rule parameters:
        output:
            expand(
                "<results>/parameters/{{drive}}/{{type}}/{{size}}nm/{label}.nc",
                label=[way["label"] for way in PARAMETER_WAYS],
            ),
        log:
            "<results>/logs/parameters/{drive}/{type}/{size}nm.log",
        benchmark:
            "<results>/benchmarks/parameters/{drive}/{type}/{size}nm.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=1440,
        params:
            code=CODE["parameters"],
            settings=lambda w: PLAN.parameters(w.drive, w.type, w.size),
        message:
            "Vary rolling displacement and viscous time: {wildcards.type} {wildcards.size} nm ({wildcards.drive})"
        script:
            "../scripts/parameters.py"

    rule parameter_table:
        input:
            lambda w: PLAN.parameter_files(
                "<results>/parameters/{drive}/{type}/{size}nm/{label}.nc", w.drive
            ),
        output:
            nc="<results>/parameters/{drive}.nc",
            csv=report(
                "<results>/parameters/{drive}.csv",
                caption="../report/parameters.rst",
                category="Tables",
                labels={"table": "Runs of figure 9", "drive": "{drive}"},
            ),
        log:
            "<results>/logs/parameters/{drive}.log",
        benchmark:
            "<results>/benchmarks/parameters/{drive}.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1000,
            runtime=30,
        params:
            code=CODE["parameter_table"],
            settings=lambda w, input: {
                "parameters": [
                    PARAMETER_WAYS[k % len(PARAMETER_WAYS)]["parameter"]
                    for k in range(len(input))
                ]
            },
        message:
            "Tabulate the runs of figure 9 ({wildcards.drive})"
        script:
            "../scripts/parameter_table.py"

    rule figure9:
        input:
            "<results>/parameters/{drive}.nc",
        output:
            pdf=report(
                "<results>/figures/figure9_{drive}.pdf",
                caption="../report/figure9.rst",
                category="Figures",
                labels={"figure": "9", "drive": "{drive}", "format": "PDF"},
            ),
            png=report(
                "<results>/figures/figure9_{drive}.png",
                caption="../report/figure9.rst",
                category="Figures",
                labels={"figure": "9", "drive": "{drive}", "format": "PNG"},
            ),
        log:
            "<results>/logs/figures/figure9_{drive}.log",
        benchmark:
            "<results>/benchmarks/figures/figure9_{drive}.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=30,
        params:
            code=CODE["figure9"],
            settings=lambda w: PLAN.figure(9, w.drive),
        message:
            "Draw figure 9, rolling displacement and viscous time ({wildcards.drive})"
        script:
            "../scripts/figure9.py"
