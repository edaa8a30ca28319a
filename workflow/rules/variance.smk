# Figure 2a: v(0, tau)/tau by spectral elements, by the paper's scheme and by Monte Carlo.


rule variance_spectral:
    """Solve for the variance by spectral elements"""
    output:
        "<results>/variance/spectral.nc",
    params:
        **settings("variance", "scene", "first_time", "horizon", points="times"),
        **settings("variance/spectral", "tolerance"),
    script:
        "../scripts/variance/spectral.py"


rule variance_finite_difference:
    """March the paper's finite differences"""
    output:
        "<results>/variance/finite_difference.nc",
    params:
        **settings("variance", "scene", "first_time", "horizon", points="times"),
        **settings("variance/finite_difference", "half_width", "nodes", "time_step"),
    script:
        "../scripts/variance/finite_difference.py"


rule variance_shard:
    """Simulate shard {wildcards.shard} of the variance"""
    output:
        "<results>/variance/shards/{shard}.nc",
    params:
        **settings("variance", "scene", "first_time", "horizon", points="times"),
        **settings("variance/monte_carlo", "step"),
        part=lambda wildcards: part(config["variance"]["monte_carlo"], wildcards.shard),
        seed=config["seed"],
    script:
        "../scripts/variance/shard.py"


rule variance_halving:
    """Halve the time step of the variance's Monte Carlo"""
    output:
        "<results>/variance/halving.nc",
    params:
        **settings("variance", "scene", "first_time", "horizon", points="times"),
        **settings("variance/monte_carlo", "step", paths="halving_paths"),
        seed=config["seed"],
    script:
        "../scripts/variance/halving.py"


rule variance_monte_carlo:
    """Merge the shards of the variance"""
    input:
        shards=expand(
            "<results>/variance/shards/{shard}.nc", shard=shards(config["variance"]["monte_carlo"])
        ),
        halving=rules.variance_halving.output[0],
    output:
        "<results>/variance/monte_carlo.nc",
    localrule: True
    script:
        "../scripts/variance/monte_carlo.py"


rule check_variance:
    """Check that the three methods agree within their stated errors"""
    input:
        spectral=rules.variance_spectral.output[0],
        finite_difference=rules.variance_finite_difference.output[0],
        monte_carlo=rules.variance_monte_carlo.output[0],
    output:
        "<results>/variance/check.nc",
    script:
        "../scripts/variance/check.py"


rule figure_2a:
    """Draw figure 2a"""
    input:
        spectral=rules.variance_spectral.output[0],
        finite_difference=rules.variance_finite_difference.output[0],
        monte_carlo=rules.variance_monte_carlo.output[0],
        check=rules.check_variance.output[0],
    output:
        figure("figure_2a"),
    script:
        "../scripts/variance/figure_2a.py"
