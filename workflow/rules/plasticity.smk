# Figure 9, an example: the permanent deformation of a yielding structure in an earthquake.


rule plasticity_variance:
    """Compute gamma^2 and kappa of the permanent deformation"""
    output:
        "<results>/plasticity/variance.nc",
    # one long job, which must not be the last
    priority: 150
    params:
        **settings("plasticity", "ground", "oscillator", "tolerance"),
        seed=config["seed"],
    script:
        "../scripts/plasticity/variance.py"


rule plasticity_crossing:
    """Simulate when the permanent deformation exceeds {wildcards.limit}"""
    output:
        "<results>/plasticity/limit={limit}.nc",
    params:
        **settings("plasticity", "ground", "oscillator", "duration", "outputs", "step", "paths"),
        seed=config["seed"],
        limit=number("limit"),
    script:
        "../scripts/plasticity/crossing.py"


rule check_plasticity:
    """Compare the formulas for the permanent deformation with Monte Carlo"""
    input:
        variance=rules.plasticity_variance.output[0],
        monte_carlo=expand(
            "<results>/plasticity/limit={limit}.nc",
            limit=map(label, config["plasticity"]["limits"]),
        ),
    output:
        "<results>/plasticity/check.nc",
    script:
        "../scripts/plasticity/check.py"


rule figure_9:
    """Draw figure 9, the probability of exceeding a permanent deformation"""
    input:
        monte_carlo=rules.check_plasticity.input.monte_carlo,
        check=rules.check_plasticity.output[0],
    output:
        figure("figure_9"),
    params:
        **settings("plasticity", "oscillator"),
    script:
        "../scripts/plasticity/figure_9.py"
