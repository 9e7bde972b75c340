# Validation: checks of the model, one job an independent piece, one figure and one section of text a check.
from ratd.validation.data import FOLDER as CHECKED, lacking, present, read_pieces
from ratd.validation.plan import EXTENTS

ASKED = CHECKS.pieces[CHECKS.docs]

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


# The tables of docs/validation.md, of the extent that config/validation.yaml names. Only what they lack is computed.
#
# They are no output: with a rule behind them, writing the document would compute them. A rule without any is run each
# time, which it has to be: whether something is lacking, the tables themselves say.
rule validation_data:
    input:
        unpack(
            lambda w: {
                check: CHECKS.files(CHECKS.docs, check, names)
                for check, pieces in ASKED.items()
                if (names := lacking(read_pieces(CHECKED, check), pieces))
            }
        ),
    log:
        f"{CHECKS.results}/logs/data.log",
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=CODE["validation_data"],
        settings={
            "folder": CHECKED,
            "checks": ASKED,
            "command": "snakemake --cores 2 validation_data",
        },
    message:
        "Collect the data of docs/validation.md"
    script:
        "../scripts/validation_data.py"


rule validation_report:
    input:
        present(CHECKED, ASKED),
    output:
        text="docs/validation.md",
        figures=expand("docs/validation/{check}.png", check=ASKED),
    log:
        f"{CHECKS.results}/logs/report.log",
    benchmark:
        f"{CHECKS.results}/benchmarks/report.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=CODE["validation_report"],
        settings={
            "folder": CHECKED,
            "checks": ASKED,
            "command": "snakemake --cores 2 validation_report",
        },
    message:
        "Write docs/validation.md"
    script:
        "../scripts/validation_report.py"
