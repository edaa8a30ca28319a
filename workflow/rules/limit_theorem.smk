# Figure 8: the functional central limit theorem, by which Xi_p tends to gamma W, for scenes of the
# sweep.


rule limit_theorem_samples:
    """Simulate the scaled integrals of {wildcards.scene}"""
    output:
        "<results>/limit_theorem/samples/{scene}.nc",
    priority: 50
    params:
        **settings("sweep/scenes/{scene}", "scene"),
        **settings("limit_theorem", "p", "paths"),
        steps=lambda wildcards: [
            step_at(config, "limit_theorem", wildcards.scene, p)
            for p in config["limit_theorem"]["p"]
        ],
        seed=config["seed"],
    script:
        "../scripts/limit_theorem/simulate.py"


rule check_limit_theorem:
    """Check that every scene approaches the limit of the central limit theorem"""
    input:
        samples=expand(
            "<results>/limit_theorem/samples/{scene}.nc", scene=config["limit_theorem"]["scenes"]
        ),
        limit="<results>/sweep/limit.nc",
    output:
        "<results>/limit_theorem/check.nc",
    params:
        **settings("limit_theorem", "scenes", "level"),
    script:
        "../scripts/limit_theorem/check.py"


rule figure_8:
    """Draw figure 8, the central limit theorem for every scene"""
    input:
        check=rules.check_limit_theorem.output[0],
    output:
        figure("figure_8"),
    params:
        **settings("sweep", "scenes"),
    script:
        "../scripts/limit_theorem/figure_8.py"
