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


rule validation:
    input:
        [CHECKS.files("full", check) for check in CHECKS.pieces["full"]],


rule validation_quick:
    input:
        [CHECKS.files("quick", check) for check in CHECKS.pieces["quick"]],
