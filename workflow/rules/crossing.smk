# Figure 2b: W(sqrt(p) b, p T) by Monte Carlo and its limit W_star(b / gamma, T).


rule crossing_shard:
    """Simulate shard {wildcards.shard} of the crossings at p = {wildcards.p}"""
    output:
        "<results>/crossing/shards/p={p}/{shard}.nc",
    # the longest jobs come first
    priority: 100
    params:
        **settings("crossing", "scene", "threshold", "horizon", "outputs", "step"),
        part=lambda wildcards: part(config["crossing"], wildcards.shard),
        seed=config["seed"],
        p=number("p"),
    script:
        "../scripts/crossing/shard.py"


rule crossing_halving:
    """Halve the time step of the crossings at p = {wildcards.p}"""
    output:
        "<results>/crossing/halving/p={p}.nc",
    priority: 50
    params:
        **settings("crossing", "scene", "threshold", "horizon", "step"),
        paths=lambda wildcards: halving_paths(config["crossing"], wildcards.p),
        seed=config["seed"],
        p=number("p"),
    script:
        "../scripts/crossing/halving.py"


rule crossing_gamma2:
    """Halve the time step in gamma^2"""
    output:
        "<results>/crossing/gamma2.nc",
    params:
        **settings("crossing", "scene", "step"),
        **settings("crossing/halving", time="gamma2_time", paths="gamma2_paths"),
        seed=config["seed"],
    script:
        "../scripts/crossing/gamma2.py"


rule crossing_monte_carlo:
    """Merge the shards of the crossings at p = {wildcards.p}"""
    input:
        shards=expand(
            "<results>/crossing/shards/p={{p}}/{shard}.nc", shard=shards(config["crossing"])
        ),
        halving=rules.crossing_halving.output[0],
    output:
        "<results>/crossing/p={p}.nc",
    localrule: True
    params:
        p=number("p"),
    script:
        "../scripts/crossing/monte_carlo.py"


rule crossing_asymptotic:
    """Evaluate the asymptotic formula"""
    output:
        "<results>/crossing/asymptotic.nc",
    localrule: True
    params:
        **settings("crossing", "scene", "threshold", "horizon", "outputs"),
    script:
        "../scripts/crossing/asymptotic.py"


rule check_crossing:
    """Check that the time step's bias is below the standard error"""
    input:
        monte_carlo=expand("<results>/crossing/p={p}.nc", p=map(label, config["crossing"]["p"])),
        asymptotic=rules.crossing_asymptotic.output[0],
        gamma2=rules.crossing_gamma2.output[0],
    output:
        "<results>/crossing/check.nc",
    script:
        "../scripts/crossing/check.py"


rule figure_2b:
    """Draw figure 2b"""
    input:
        monte_carlo=rules.check_crossing.input.monte_carlo,
        exact=expand("<results>/finite_p/p={p}.nc", p=map(label, config["crossing"]["p"])),
        asymptotic=rules.crossing_asymptotic.output[0],
        check=rules.check_crossing.output[0],
        contained="<results>/finite_p/check.nc",
    output:
        figure("figure_2b"),
    script:
        "../scripts/crossing/figure_2b.py"


rule table_time_step:
    """Typeset the table of the time step's bias"""
    input:
        check=rules.check_crossing.output[0],
    output:
        table("table_time_step"),
    script:
        "../scripts/crossing/table_time_step.py"
