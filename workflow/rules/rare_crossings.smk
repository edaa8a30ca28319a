# Figure 13, table 11: rare crossings of every scene by importance sampling.


rule rare_crossing:
    """Lead paths of {wildcards.scene} to far thresholds"""
    output:
        "<results>/rare_crossings/{scene}.nc",
    params:
        **settings("sweep/scenes/{scene}", "scene"),
        **settings("rare_crossings", "p", "horizon", thresholds="thresholds/{scene}"),
        seed=config["seed"],
    script:
        "../scripts/rare_crossings/sample.py"


rule rare_formulas:
    """Evaluate the formulas for far thresholds"""
    input:
        limit=rules.sweep_limit.output[0],
    output:
        "<results>/rare_crossings/formulas.nc",
    params:
        **settings("rare_crossings", "p", "horizon"),
        scenes=rare(config),
    script:
        "../scripts/rare_crossings/formulas.py"


rule figure_13:
    """Draw figure 13, rare crossings of every scene"""
    input:
        sampled=expand(
            "<results>/rare_crossings/{scene}.nc", scene=config["rare_crossings"]["scenes"]
        ),
        formulas=rules.rare_formulas.output[0],
    output:
        figure("figure_13"),
    params:
        **settings("rare_crossings", "p", "horizon"),
        scenes=rare(config),
    script:
        "../scripts/rare_crossings/figure_13.py"


rule table_11:
    """Typeset table 11, rare crossings of every scene"""
    input:
        sampled=rules.figure_13.input.sampled,
    output:
        table("table_11"),
    params:
        scenes=rare(config),
    script:
        "../scripts/rare_crossings/table_11.py"
