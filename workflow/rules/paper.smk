# The paper: every figure, every table, every number, typeset.

FIGURES = [
    *["figure_1", "figure_2a", "figure_2b", "figure_3", "figure_4", "figure_5", "figure_6"],
    *["figure_7", "figure_8", "figure_9", "figure_10", "figure_12"],
]
TABLES = [
    *["table_1", "table_2", "table_3", "table_4", "table_5", "table_6", "table_7"],
    *["table_7b", "table_9", "table_10", "table_errata", "table_potentials", "table_time_step"],
]


rule figures:
    input:
        expand(
            "{results}/figures/{figure}.{ext}", results=RESULTS, figure=FIGURES, ext=["pdf", "png"]
        ),


rule tables:
    input:
        expand(
            "{results}/tables/{table}.{ext}",
            results=RESULTS,
            table=TABLES,
            ext=["csv", "tex", "typ"],
        ),


rule values:
    input:
        spectral=rules.variance_spectral.output[0],
        monte_carlo=rules.variance_monte_carlo.output[0],
        agreement=rules.check_variance.output[0],
        crossing=rules.check_crossing.output[0],
        contained=rules.check_finite_p.output[0],
        formulas=rules.finite_p_formulas.output[0],
        limit=rules.sweep_limit.output[0],
        convergence=rules.table_4.input.spectral,
        drift_condition=rules.drift_condition.output[0],
        ergodicity=rules.ergodicity.output[0],
        errata=rules.errata.output[0],
        theorem=rules.check_limit_theorem.output[0],
        deformation=rules.check_plasticity.output[0],
        deformation_variance=rules.plasticity_variance.output[0],
        rates=rules.measure_rates.output[0],
        modules=[*sources("workflow/scripts/paper/values.py"), "paper/printed.yaml"],
    output:
        ensure(f"{RESULTS}/paper/values.json", non_empty=True),
    log:
        f"{RESULTS}/logs/paper/values.log",
    benchmark:
        f"{RESULTS}/benchmarks/paper/values.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        variance=lookup(dpath="variance", within=config),
        sweep=lookup(dpath="crossing", within=config),
        finite_p=lookup(dpath="finite_p", within=config),
        horizon=lookup(dpath="convergence/horizon", within=config),
        scheme=lookup(dpath="convergence/finite_difference", within=config),
        trajectories=lookup(dpath="trajectories", within=config),
        scenes=lookup(dpath="sweep", within=config),
        theorems=lookup(dpath="theorems", within=config),
        density=lookup(dpath="density", within=config),
        limit_theorem=lookup(dpath="limit_theorem", within=config),
        plasticity=lookup(dpath="plasticity", within=config),
        limits=lookup(dpath="rates", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Collect the numbers that the text quotes"
    script:
        "../scripts/paper/values.py"


rule paper:
    input:
        figures=rules.figures.input,
        tables=rules.tables.input,
        values=rules.values.output[0],
        template="paper/paper.typ",
        recorded=["docs/speed_pde.pdf", "docs/speed_crossing.pdf"],
        modules=sources("workflow/scripts/paper/typeset.py"),
    output:
        report(ensure(PAPER, non_empty=True), caption="../report/paper.rst", category="Paper"),
    log:
        f"{RESULTS}/logs/paper/paper.log",
    benchmark:
        f"{RESULTS}/benchmarks/paper/paper.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        results=subpath(input.values, ancestor=2),
    message:
        "Typeset the paper"
    script:
        "../scripts/paper/typeset.py"
