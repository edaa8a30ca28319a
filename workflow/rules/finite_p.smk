# Crossing probabilities at finite p without Monte Carlo, the corrected formulas, and figure 2b.


rule finite_p_exact:
    input:
        modules=sources("workflow/scripts/finite_p/exact.py"),
    output:
        ensure(f"{RESULTS}/finite_p/p={{p}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/finite_p/p={{p}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/finite_p/p={{p}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="crossing/scene", within=config),
        threshold=lookup(dpath="crossing/threshold", within=config),
        horizon=lookup(dpath="crossing/horizon", within=config),
        outputs=lookup(dpath="crossing/outputs", within=config),
        first_time=lookup(dpath="finite_p/first_time", within=config),
        tolerance=lookup(dpath="finite_p/tolerance", within=config),
        p=lambda wildcards: float(wildcards.p),
    message:
        "Solve for the crossing probabilities at p = {wildcards.p}"
    script:
        "../scripts/finite_p/exact.py"


rule check_finite_p:
    input:
        monte_carlo=rules.check_crossing.input.monte_carlo,
        exact=expand(
            "{results}/finite_p/p={p}.nc", results=RESULTS, p=map(label, config["crossing"]["p"])
        ),
        modules=sources("workflow/scripts/finite_p/check.py"),
    output:
        ensure(f"{RESULTS}/finite_p/check.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/finite_p/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/finite_p/check.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        seed=lookup(dpath="seed", within=config),
    message:
        "Check that the bands of figure 2b contain the exact curves"
    script:
        "../scripts/finite_p/check.py"


rule figure_2b:
    input:
        monte_carlo=rules.check_crossing.input.monte_carlo,
        exact=rules.check_finite_p.input.exact,
        asymptotic=rules.crossing_asymptotic.output[0],
        check=rules.check_crossing.output[0],
        contained=rules.check_finite_p.output[0],
        modules=sources("workflow/scripts/crossing/figure_2b.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_2b", ".pdf", ".png"),
            caption="../report/figure_2b.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_2b.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_2b.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Draw figure 2b"
    script:
        "../scripts/crossing/figure_2b.py"


rule finite_p_formulas:
    input:
        modules=sources("workflow/scripts/finite_p/formulas.py"),
    output:
        ensure(f"{RESULTS}/finite_p/formulas.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/finite_p/formulas.log",
    benchmark:
        f"{RESULTS}/benchmarks/finite_p/formulas.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="crossing/scene", within=config),
        threshold=lookup(dpath="crossing/threshold", within=config),
        horizons=lookup(dpath="finite_p/horizons", within=config),
        p=lookup(dpath="finite_p/p", within=config),
        fit_from=lookup(dpath="finite_p/fit_from", within=config),
    message:
        "Evaluate the corrected formulas against the exact probabilities"
    script:
        "../scripts/finite_p/formulas.py"


rule figure_10:
    input:
        formulas=rules.finite_p_formulas.output[0],
        modules=sources("workflow/scripts/finite_p/figure_10.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_10", ".pdf", ".png"),
            caption="../report/figure_10.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_10.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_10.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        fit_from=lookup(dpath="finite_p/fit_from", within=config),
    message:
        "Draw figure 10, the errors of the formulas"
    script:
        "../scripts/finite_p/figure_10.py"


rule table_9:
    input:
        formulas=rules.finite_p_formulas.output[0],
        monte_carlo=rules.check_crossing.input.monte_carlo,
        modules=sources("workflow/scripts/finite_p/table_9.py"),
    output:
        multiext(f"{RESULTS}/tables/table_9", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_9.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_9.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        horizon=lookup(dpath="finite_p/tabulated", within=config),
    message:
        "Typeset table 9, exact and approximate crossing probabilities"
    script:
        "../scripts/finite_p/table_9.py"
