# Figures of the paper, PDF for print and PNG for the screen.
#
# What needs no spin-up is said of all grown grains where no grain is grown for that alone (`grown` of figures 7 and 8).


rule figure1:
    input:
        PLAN.figure1_files(
            "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc"
        ),
    output:
        pdf=report(
            "<results>/figures/figure1.pdf",
            caption="../report/figure1.rst",
            category="Figures",
            labels={"figure": "1", "drive": "none", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure1.png",
            caption="../report/figure1.rst",
            category="Figures",
            labels={"figure": "1", "drive": "none", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure1.log",
    benchmark:
        "<results>/benchmarks/figures/figure1.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure1"],
        settings=PLAN.figure(1),
    message:
        "Draw figure 1, what the grains look like"
    script:
        "../scripts/figure1.py"


rule figure2:
    input:
        "<results>/ensemble/{drive}/grains.nc",
    output:
        pdf=report(
            "<results>/figures/figure2_{drive}.pdf",
            caption="../report/figure2.rst",
            category="Figures",
            labels={"figure": "2", "drive": "{drive}", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure2_{drive}.png",
            caption="../report/figure2.rst",
            category="Figures",
            labels={"figure": "2", "drive": "{drive}", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure2_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/figure2_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure2"],
        settings=lambda w: PLAN.figure(2, w.drive),
    message:
        "Draw figure 2, the grains as grown ({wildcards.drive})"
    script:
        "../scripts/figure2.py"


rule figure4:
    input:
        lambda w: PLAN.figure4_files(
            f"<results>/spinup/{w.drive}/{{material}}/{{type}}/{{size}}nm/seeds_{{seeds}}.nc",
            w.drive,
        ),
    output:
        pdf=report(
            "<results>/figures/figure4_{drive}.pdf",
            caption="../report/figure4.rst",
            category="Figures",
            labels={"figure": "4", "drive": "{drive}", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure4_{drive}.png",
            caption="../report/figure4.rst",
            category="Figures",
            labels={"figure": "4", "drive": "{drive}", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure4_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/figure4_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure4"],
        settings=lambda w: PLAN.figure(4, w.drive),
    message:
        "Draw figure 4, one cell coming apart ({wildcards.drive})"
    script:
        "../scripts/figure4.py"


rule figure5:
    input:
        lambda w: PLAN.figure5_files(
            f"<results>/spinup/{w.drive}/{{material}}/{{type}}/{{size}}nm/seeds_{{seeds}}.nc",
            w.drive,
        ),
    output:
        pdf=report(
            "<results>/figures/figure5_{drive}.pdf",
            caption="../report/figure5.rst",
            category="Figures",
            labels={"figure": "5", "drive": "{drive}", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure5_{drive}.png",
            caption="../report/figure5.rst",
            category="Figures",
            labels={"figure": "5", "drive": "{drive}", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure5_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/figure5_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure5"],
        settings=lambda w: PLAN.figure(5, w.drive),
    message:
        "Draw figure 5, one grain coming apart ({wildcards.drive})"
    script:
        "../scripts/figure5.py"


rule grain_page:
    input:
        lambda w: PLAN.figure5_files(
            f"<results>/spinup/{w.drive}/{{material}}/{{type}}/{{size}}nm/seeds_{{seeds}}.nc",
            w.drive,
        ),
    output:
        report(
            "<results>/figures/grain_{drive}.html",
            caption="../report/grain_page.rst",
            category="Interactive",
            labels={"page": "one grain coming apart", "drive": "{drive}"},
        ),
    log:
        "<results>/logs/figures/grain_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/grain_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["grain_page"],
        settings=lambda w: PLAN.figure(5, w.drive),
    message:
        "Make the page of one grain coming apart ({wildcards.drive})"
    script:
        "../scripts/grain_page.py"


rule figure6:
    input:
        "<results>/ensemble/{drive}/grains.nc",
    output:
        pdf=report(
            "<results>/figures/figure6_{drive}.pdf",
            caption="../report/figure6.rst",
            category="Figures",
            labels={"figure": "6", "drive": "{drive}", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure6_{drive}.png",
            caption="../report/figure6.rst",
            category="Figures",
            labels={"figure": "6", "drive": "{drive}", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure6_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/figure6_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure6"],
        settings=lambda w: PLAN.figure(6, w.drive),
    message:
        "Draw figure 6, axis ratios ({wildcards.drive})"
    script:
        "../scripts/figure6.py"


rule figure7:
    input:
        table="<results>/ensemble/{drive}/grains.nc",
        fit="<results>/ensemble/{drive}/table3.nc",
        grown=[rules.grown.output.table] if PLAN.grows_more_anyway else [],
    output:
        pdf=report(
            "<results>/figures/figure7_{drive}.pdf",
            caption="../report/figure7.rst",
            category="Figures",
            labels={"figure": "7", "drive": "{drive}", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure7_{drive}.png",
            caption="../report/figure7.rst",
            category="Figures",
            labels={"figure": "7", "drive": "{drive}", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure7_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/figure7_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure7"],
        settings=lambda w: PLAN.figure(7, w.drive),
    message:
        "Draw figure 7, omega of disruption against size ({wildcards.drive})"
    script:
        "../scripts/figure7.py"


rule figure8:
    input:
        table="<results>/ensemble/{drive}/grains.nc",
        grown=[rules.grown.output.table] if PLAN.grows_more_anyway else [],
    output:
        pdf=report(
            "<results>/figures/figure8_{drive}.pdf",
            caption="../report/figure8.rst",
            category="Figures",
            labels={"figure": "8", "drive": "{drive}", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure8_{drive}.png",
            caption="../report/figure8.rst",
            category="Figures",
            labels={"figure": "8", "drive": "{drive}", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure8_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/figure8_{drive}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure8"],
        settings=lambda w: PLAN.figure(8, w.drive),
    message:
        "Draw figure 8, tensile strengths ({wildcards.drive})"
    script:
        "../scripts/figure8.py"


rule pairs:
    output:
        "<results>/pairs/{material}.nc",
    log:
        "<results>/logs/pairs/{material}.log",
    benchmark:
        "<results>/benchmarks/pairs/{material}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=60,
    params:
        code=CODE["pairs"],
        settings=lambda w: PLAN.pairs(w.material),
    message:
        "Spin up pairs of {wildcards.material} monomers"
    script:
        "../scripts/pairs.py"


rule figure10:
    input:
        expand("<results>/pairs/{material}.nc", material=PLAN.config["materials"]),
    output:
        pdf=report(
            "<results>/figures/figure10.pdf",
            caption="../report/figure10.rst",
            category="Figures",
            labels={"figure": "10", "drive": "prescribed", "format": "PDF"},
        ),
        png=report(
            "<results>/figures/figure10.png",
            caption="../report/figure10.rst",
            category="Figures",
            labels={"figure": "10", "drive": "prescribed", "format": "PNG"},
        ),
    log:
        "<results>/logs/figures/figure10.log",
    benchmark:
        "<results>/benchmarks/figures/figure10.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["figure10"],
        settings=PLAN.figure(10),
    message:
        "Draw figure 10, pairs that part"
    script:
        "../scripts/figure10.py"


rule figures:
    input:
        expand(
            "<results>/figures/figure{number}_{drive}.{format}",
            number=PLAN.figures,
            drive=PLAN.config["drives"],
            format=["pdf", "png"],
        ),
        expand(
            "<results>/figures/figure{number}.{format}",
            number=PLAN.common_figures,
            format=["pdf", "png"],
        ),
        expand(
            "<results>/figures/grain_{drive}.html",
            drive=PLAN.config["drives"] if 5 in PLAN.figures else [],
        ),
        rules.calibration_figure.output if CALIBRATION else [],
        rules.formula_figure.output if FORMULAE else [],
