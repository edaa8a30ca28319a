# The paper: every figure, every table, every number, typeset.

FIGURES = [
    *["figure_1", "figure_2a", "figure_2b", "figure_3", "figure_4", "figure_5", "figure_6"],
    *["figure_7", "figure_8", "figure_9", "figure_10", "figure_12", "figure_13"],
]
TABLES = [
    *["table_1", "table_2", "table_3", "table_4", "table_5", "table_6", "table_7"],
    *["table_7b", "table_9", "table_10", "table_11", "table_12"],
    *["table_errata", "table_potentials", "table_time_step"],
]


rule figures:
    input:
        expand("<results>/figures/{figure}.{ext}", figure=FIGURES, ext=["pdf", "png"]),


rule tables:
    input:
        expand("<results>/tables/{table}.{ext}", table=TABLES, ext=["csv", "tex", "typ"]),


rule values:
    """Collect the numbers that the text quotes"""
    input:
        spectral=rules.variance_spectral.output[0],
        monte_carlo=rules.variance_monte_carlo.output[0],
        agreement=rules.check_variance.output[0],
        crossing=rules.check_crossing.output[0],
        contained=rules.check_finite_p.output[0],
        formulas=rules.finite_p_formulas.output[0],
        limit=rules.sweep_limit.output[0],
        rare=rules.table_11.input.sampled,
        convergence=rules.table_4.input.spectral,
        convergence_check=rules.check_convergence.output[0],
        drift_condition=rules.drift_condition.output[0],
        ergodicity=rules.ergodicity.output[0],
        errata=rules.errata.output[0],
        theorem=rules.check_limit_theorem.output[0],
        deformation=rules.check_plasticity.output[0],
        deformation_variance=rules.plasticity_variance.output[0],
        rates=rules.measure_rates.output[0],
        crossing_rates=rules.table_12.input.crossing,
        printed=own("paper/printed.yaml"),
    output:
        "<results>/paper/values.json",
        "<results>/paper/numbers.json",
    localrule: True
    params:
        variance=config["variance"],
        sweep=config["crossing"],
        finite_p=config["finite_p"],
        horizon=config["convergence"]["horizon"],
        scheme=config["convergence"]["finite_difference"],
        trajectories=config["trajectories"],
        scenes=config["sweep"],
        rare_crossings=config["rare_crossings"],
        theorems=config["theorems"],
        density=config["density"],
        limit_theorem=config["limit_theorem"],
        plasticity=config["plasticity"],
        limits=config["rates"],
        seed=config["seed"],
    script:
        "../scripts/paper/values.py"


rule paper:
    """Typeset the paper"""
    input:
        figures=rules.figures.input,
        tables=rules.tables.input,
        values=rules.values.output[0],
        template=own("paper/paper.typ"),
        printed=own("paper/printed.yaml"),
        recorded=[own("docs/speed_pde.pdf"), own("docs/speed_crossing.pdf")],
    output:
        report(PAPER, caption="../report/paper.rst", category="Paper"),
    localrule: True
    params:
        results=subpath(input.values, ancestor=2),
    script:
        "../scripts/paper/typeset.py"
