# Figure 12, tables 10 and 12: distances of penalized scenes to their limits n -> infinity.


rule measure_rates:
    """Measure the distances to the non-smooth limit"""
    output:
        "<results>/rates/rates.nc",
    # one long job, which must not be the last
    priority: 150
    params:
        **settings("rates", "scenes", "horizon", "resolution", "paths", "weak"),
        **settings("rates", "level", longest="longest_step"),
        seed=config["seed"],
    script:
        "../scripts/rates/measure.py"


rule figure_12:
    """Draw figure 12, distances to the non-smooth limit"""
    input:
        rates=rules.measure_rates.output[0],
    output:
        figure("figure_12"),
    params:
        **settings("rates", "scenes"),
    script:
        "../scripts/rates/figure_12.py"


rule table_10:
    """Typeset table 10, rates of convergence to the non-smooth limit"""
    input:
        rates=rules.measure_rates.output[0],
    output:
        table("table_10"),
    params:
        **settings("rates", "scenes"),
    script:
        "../scripts/rates/table_10.py"


rule rates_crossing:
    """Solve for crossing probabilities of {wildcards.scene} at growing n"""
    output:
        "<results>/rates/crossing/{scene}.nc",
    # with two variables it takes long, and must not be the last
    priority: 150
    params:
        **settings("rates/scenes/{scene}", "scene"),
        **settings("rates/crossing", "p", "horizon", "ratio", "points", first="smallest/{scene}"),
        **settings("rates/crossing", threshold="thresholds/{scene}", tol="tolerances/{scene}"),
    script:
        "../scripts/rates/crossing.py"


rule table_12:
    """Typeset table 12, crossing probabilities as n grows"""
    input:
        crossing=expand(
            "<results>/rates/crossing/{scene}.nc", scene=config["rates"]["crossing"]["scenes"]
        ),
    output:
        table("table_12"),
    params:
        **settings("rates", "scenes"),
        **settings("rates/crossing", "thresholds", names="scenes"),
    script:
        "../scripts/rates/table_12.py"


rule rates:
    input:
        rules.figure_12.output,
        rules.table_10.output,
        rules.table_12.output,
