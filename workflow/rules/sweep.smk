# Figure 6, table 6: gamma^2 and crossing probabilities of every scene by Monte Carlo.


rule sweep_variance:
    """Estimate gamma^2 of {wildcards.scene} by Monte Carlo"""
    output:
        "<results>/sweep/{scene}/variance.nc",
    params:
        **settings("sweep/scenes/{scene}", "scene", step="long_step"),
        **settings("sweep/variance", "times", "paths", "halving_paths"),
        seed=config["seed"],
    script:
        "../scripts/sweep/variance.py"


rule sweep_crossing:
    """Simulate the crossings of {wildcards.scene} at p = {wildcards.p}"""
    output:
        "<results>/sweep/{scene}/p={p}.nc",
    # the longest jobs come first
    priority: 100
    params:
        **settings("sweep/scenes/{scene}", "scene", "threshold"),
        **settings("sweep", "horizon", "outputs", "measured", "paths", "halving_paths"),
        step=lambda wildcards: step_at(config, "sweep", wildcards.scene, float(wildcards.p)),
        seed=config["seed"],
        p=number("p"),
    script:
        "../scripts/sweep/crossing.py"


rule sweep_limit:
    """Evaluate the asymptotic formula of every scene"""
    input:
        variance=expand("<results>/sweep/{scene}/variance.nc", scene=swept(config)),
        solved=expand("<results>/gamma2/{scene}.nc", scene=config["gamma2"]["scenes"]),
    output:
        "<results>/sweep/limit.nc",
    localrule: True
    params:
        **settings("gamma2", names="scenes"),
        **settings("sweep", "horizon", "outputs"),
        scenes=swept(config),
    script:
        "../scripts/sweep/limit.py"


rule check_sweep:
    """Check that the time step's bias of every scene is not above the standard error"""
    input:
        crossing=expand(
            "<results>/sweep/{scene}/p={p}.nc",
            scene=swept(config),
            p=map(label, config["sweep"]["p"]),
        ),
    output:
        "<results>/sweep/check.nc",
    params:
        **settings("sweep", "p"),
        scenes=swept(config),
    script:
        "../scripts/sweep/check.py"


rule figure_6:
    """Draw figure 6, the crossing probabilities of every scene"""
    input:
        crossing=rules.check_sweep.input.crossing,
        limit=rules.sweep_limit.output[0],
        check=rules.check_sweep.output[0],
    output:
        figure("figure_6"),
    params:
        **settings("sweep", "p"),
        scenes=swept(config),
    script:
        "../scripts/sweep/figure_6.py"


rule table_6:
    """Typeset table 6, every scene by Monte Carlo"""
    input:
        variance=rules.sweep_limit.input.variance,
        crossing=rules.check_sweep.input.crossing,
        limit=rules.sweep_limit.output[0],
        check=rules.check_sweep.output[0],
    output:
        table("table_6"),
    params:
        **settings("sweep", "p"),
        scenes=swept(config),
    script:
        "../scripts/sweep/table_6.py"
