# Figure 10, table 9: crossing probabilities at finite p without Monte Carlo, and the corrected formulas.


rule finite_p_exact:
    """Solve for the crossing probabilities at p = {wildcards.p}"""
    output:
        "<results>/finite_p/p={p}.nc",
    params:
        **settings("crossing", "scene", "threshold", "horizon", "outputs"),
        **settings("finite_p", "first_time", "tolerance"),
        p=number("p"),
    script:
        "../scripts/finite_p/exact.py"


rule check_finite_p:
    """Check that the bands of figure 2b contain the exact curves"""
    input:
        monte_carlo=rules.figure_2b.input.monte_carlo,
        exact=rules.figure_2b.input.exact,
    output:
        "<results>/finite_p/check.nc",
    params:
        seed=config["seed"],
    script:
        "../scripts/finite_p/check.py"


rule finite_p_formulas:
    """Evaluate the corrected formulas against the exact probabilities"""
    output:
        "<results>/finite_p/formulas.nc",
    params:
        **settings("crossing", "scene", "threshold"),
        **settings("finite_p", "horizons", "p", "fit_from", "exact_tolerance", "resolved"),
    script:
        "../scripts/finite_p/formulas.py"


rule figure_10:
    """Draw figure 10, the errors of the formulas"""
    input:
        formulas=rules.finite_p_formulas.output[0],
    output:
        figure("figure_10"),
    params:
        **settings("finite_p", "fit_from"),
    script:
        "../scripts/finite_p/figure_10.py"


rule table_9:
    """Typeset table 9, exact and approximate crossing probabilities"""
    input:
        formulas=rules.finite_p_formulas.output[0],
        monte_carlo=rules.figure_2b.input.monte_carlo,
        check=rules.check_finite_p.output[0],
    output:
        table("table_9"),
    params:
        **settings("finite_p", horizon="tabulated"),
    script:
        "../scripts/finite_p/table_9.py"
