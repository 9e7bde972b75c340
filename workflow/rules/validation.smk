# Validation: checks of the model, one job an independent piece, one figure and one section of text a check.
from ratd.validation.plan import EXTENTS

for check in CHECKS.pieces["full"]:

    rule:
        name:
            f"validation_{check}"
        output:
            f"{CHECKS.results}/{{extent}}/{{check}}/{{piece}}.nc",
        log:
            f"{CHECKS.results}/{{extent}}/logs/{{check}}/{{piece}}.log",
        benchmark:
            f"{CHECKS.results}/{{extent}}/benchmarks/{{check}}/{{piece}}.tsv"
        wildcard_constraints:
            extent="|".join(EXTENTS),
            check=check,
        conda:
            "../envs/ratd.yaml"
        threads: 1
        resources:
            mem_mb=1500,
            runtime=120,
        params:
            code=CODE[f"validation_{check}"],
            settings=lambda w: CHECKS.pieces[w.extent][w.check][w.piece],
        message:
            "Validate {wildcards.check}: {wildcards.piece} ({wildcards.extent})"
        script:
            "../scripts/validation_{wildcards.check}.py"


rule validation_show:
    input:
        lambda w: CHECKS.files(w.extent, w.check),
    output:
        pdf=f"{CHECKS.results}/{{extent}}/{{check}}.pdf",
        png=f"{CHECKS.results}/{{extent}}/{{check}}.png",
        text=f"{CHECKS.results}/{{extent}}/{{check}}.md",
    log:
        f"{CHECKS.results}/{{extent}}/logs/{{check}}.log",
    benchmark:
        f"{CHECKS.results}/{{extent}}/benchmarks/{{check}}.tsv"
    wildcard_constraints:
        extent="|".join(EXTENTS),
        check="|".join(CHECKS.pieces["full"]),
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["validation_show"],
        settings={},
    message:
        "Show the check {wildcards.check} ({wildcards.extent})"
    script:
        "../scripts/validation_show.py"


rule validation:
    input:
        expand(
            f"{CHECKS.results}/full/{{check}}.{{format}}",
            check=CHECKS.pieces["full"],
            format=["md", "pdf", "png"],
        ),


rule validation_quick:
    input:
        expand(
            f"{CHECKS.results}/quick/{{check}}.{{format}}",
            check=CHECKS.pieces["quick"],
            format=["md", "pdf", "png"],
        ),


# docs/validation.md and its figures, of the extent that config/validation.yaml names.
rule validation_report:
    input:
        sections=expand(
            f"{CHECKS.results}/{CHECKS.docs}/{{check}}.md",
            check=CHECKS.pieces[CHECKS.docs],
        ),
        figures=expand(
            f"{CHECKS.results}/{CHECKS.docs}/{{check}}.png",
            check=CHECKS.pieces[CHECKS.docs],
        ),
    output:
        text="docs/validation.md",
        figures=expand("docs/{check}.png", check=CHECKS.pieces[CHECKS.docs]),
    log:
        f"{CHECKS.results}/logs/report.log",
    benchmark:
        f"{CHECKS.results}/benchmarks/report.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=CODE["validation_report"],
        settings={
            "extent": CHECKS.docs,
            "results": CHECKS.results,
            "command": "snakemake --cores 2 validation_report",
        },
    message:
        "Write docs/validation.md"
    script:
        "../scripts/validation_report.py"
