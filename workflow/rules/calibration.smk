# The one free number of the drive literal, from the onset of mass loss in Fig. 4.
CALIBRATION = PLAN.calibration_labels

if CALIBRATION:

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
        threads: 1
        resources:
            mem_mb=1500,
            runtime=1440,
        params:
            code=CODE["calibration_runs"],
            settings=lambda w: PLAN.calibration_runs(w.pace),
        message:
            "Spin up the cell of the calibration at d omega/dt, f = {wildcards.pace} (literal)"
        script:
            "../scripts/calibration_runs.py"

    rule calibration:
        input:
            expand("<results>/calibration/{pace}.nc", pace=CALIBRATION),
        output:
            nc="<results>/calibration/fit.nc",
            csv=report(
                "<results>/calibration/fit.csv",
                caption="../report/calibration.rst",
                category="Tables",
                labels={"table": "Calibration", "drive": "literal"},
            ),
        log:
            "<results>/logs/calibration/fit.log",
        benchmark:
            "<results>/benchmarks/calibration/fit.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=30,
        params:
            code=CODE["calibration"],
            settings={
                "omega_onset": PLAN.config["figures"]["calibration"]["omega_onset"]
            },
        message:
            "Calibrate the drive literal on the onset of mass loss"
        script:
            "../scripts/calibration.py"

    rule calibration_figure:
        input:
            "<results>/calibration/fit.nc",
        output:
            pdf=report(
                "<results>/figures/calibration.pdf",
                caption="../report/calibration.rst",
                category="Figures",
                labels={
                    "figure": "calibration",
                    "drive": "literal",
                    "format": "PDF",
                },
            ),
            png=report(
                "<results>/figures/calibration.png",
                caption="../report/calibration.rst",
                category="Figures",
                labels={
                    "figure": "calibration",
                    "drive": "literal",
                    "format": "PNG",
                },
            ),
        log:
            "<results>/logs/figures/calibration.log",
        benchmark:
            "<results>/benchmarks/figures/calibration.tsv"
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=30,
        params:
            code=CODE["calibration_figure"],
            settings={},
        message:
            "Draw the calibration of the drive literal"
        script:
            "../scripts/calibration_figure.py"
