# Validation: checks of the model, one job an independent piece, one table a check.
CHECKS = checked(Checks, "config/validation.yaml")
PIECE = f"{CHECKS.results}/{{extent}}/{{check}}/{{piece}}"

for check in CHECKS.names:
    kind = f"validation_{check}"

    rule:
        name:
            f"check_{check}"
        output:
            **{kind: f"{CHECKS.results}/{{extent}}/{check}/{{piece}}.nc"},
        log:
            f"{CHECKS.results}/{{extent}}/logs/{check}/{{piece}}.log",
        benchmark:
            f"{CHECKS.results}/{{extent}}/benchmarks/{check}/{{piece}}.tsv"
        wildcard_constraints:
            extent=any_of(CHECKS.pieces),
        conda:
            "../envs/ratd.yaml"
        resources:
            runtime=120,
        params:
            task=task("check", f"ratd.validation.{check}:compute", kind),
            settings=piece_settings(check),
        message:
            f"Check {check}: {{wildcards.piece}} ({{wildcards.extent}})"
        script:
            "../scripts/check.py"


rule check_table:
    input:
        lambda w: checked(CHECKS.files, w.extent, w.check),
    output:
        csv=f"{CHECKS.results}/{{extent}}/{{check}}.csv",
    log:
        f"{CHECKS.results}/{{extent}}/logs/{{check}}.log",
    benchmark:
        f"{CHECKS.results}/{{extent}}/benchmarks/{{check}}.tsv"
    wildcard_constraints:
        extent=any_of(CHECKS.pieces),
        check=any_of(CHECKS.names),
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.validation.tables:table"),
        settings=lambda w: {"kind": f"validation_{w.check}"},
    message:
        "Tabulate the check {wildcards.check} ({wildcards.extent})"
    script:
        "../scripts/analyse.py"


rule validation:
    input:
        # asked for only where it is wanted: it needs LAMMPS
        lambda w: checked(CHECKS.tables, "full"),


rule validation_quick:
    input:
        # asked for only where it is wanted: it needs LAMMPS
        lambda w: checked(CHECKS.tables, "quick"),
