# Figures, PDF for print and PNG for the screen: one rule each, of the name of the figure.
from ratd.experiments.spin_up.plan import COMMON_FIGURES, FIGURES, TITLES

for name in (*FIGURES, *COMMON_FIGURES):
    stem = f"{name}_{{drive}}" if name in FIGURES else name
    of_drive = {"drive": "{drive}"} if name in FIGURES else {}

    rule:
        name:
            f"draw_{name}" if name in ("calibration", "formulae") else name
        input:
            unpack(figure_input(name)),
        output:
            **{
                form: report(
                    f"<results>/figures/{stem}.{form}",
                    caption=f"../report/{name}.rst",
                    category="Spin-up",
                    labels=figure_labels(name, TITLES[name], form) | of_drive,
                )
                for form in ("pdf", "png")
            },
        log:
            f"<results>/logs/figures/{stem}.log",
        benchmark:
            f"<results>/benchmarks/figures/{stem}.tsv"
        wildcard_constraints:
            **NAMES,
        conda:
            "../envs/ratd.yaml"
        params:
            task=task("figure", f"ratd.experiments.spin_up.figures.{name}:draw"),
            settings=figure_settings(name),
        message:
            f"Draw {stem.replace('_', ', ').replace('{', '{wildcards.')}"
        script:
            "../scripts/figure.py"


rule grain_page:
    input:
        unpack(figure_input("figure5")),
    output:
        page=report(
            "<results>/figures/grain_{drive}.html",
            caption="../report/grain_page.rst",
            category="Interactive",
            labels={"page": "one grain coming apart", "drive": "{drive}"},
        ),
    log:
        "<results>/logs/figures/grain_{drive}.log",
    benchmark:
        "<results>/benchmarks/figures/grain_{drive}.tsv"
    wildcard_constraints:
        **NAMES,
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.spin_up.figures.page:page"),
        settings=figure_settings("figure5"),
    message:
        "Make the page of one grain coming apart ({wildcards.drive})"
    script:
        "../scripts/analyse.py"


rule figures:
    input:
        expand(
            "<results>/figures/{figure}_{drive}.{form}",
            figure=PLAN.figures,
            drive=PLAN.config["drives"],
            form=["pdf", "png"],
        ),
        expand(
            "<results>/figures/{figure}.{form}",
            figure=PLAN.common_figures,
            form=["pdf", "png"],
        ),
        expand(
            "<results>/figures/grain_{drive}.html",
            drive=PLAN.config["drives"] if "figure5" in PLAN.figures else [],
        ),
