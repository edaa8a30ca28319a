# Figure 2a: v(0, tau)/tau by spectral elements, by the paper's scheme and by Monte Carlo.


rule variance_spectral:
    message:
        "Solve for the variance by spectral elements"
    input:
        modules=sources("workflow/scripts/variance/spectral.py"),
    output:
        ensure(f"{RESULTS}/variance/spectral.nc", non_empty=True),
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        tolerance=lookup(dpath="variance/spectral/tolerance", within=config),
    log:
        f"{RESULTS}/logs/variance/spectral.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/spectral.tsv"
    threads: 1
    script:
        "../scripts/variance/spectral.py"


rule variance_finite_difference:
    message:
        "March the paper's finite differences"
    input:
        modules=sources("workflow/scripts/variance/finite_difference.py"),
    output:
        ensure(f"{RESULTS}/variance/finite_difference.nc", non_empty=True),
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        half_width=lookup(dpath="variance/finite_difference/half_width", within=config),
        nodes=lookup(dpath="variance/finite_difference/nodes", within=config),
        time_step=lookup(dpath="variance/finite_difference/time_step", within=config),
    log:
        f"{RESULTS}/logs/variance/finite_difference.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/finite_difference.tsv"
    threads: 1
    script:
        "../scripts/variance/finite_difference.py"


rule variance_shard:
    message:
        "Simulate shard {wildcards.shard} of the variance"
    input:
        modules=sources("workflow/scripts/variance/shard.py"),
    output:
        ensure(f"{RESULTS}/variance/shards/{{shard}}.nc", non_empty=True),
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        step=lookup(dpath="variance/monte_carlo/step", within=config),
        shard=lookup(dpath="variance/monte_carlo/shard", within=config),
        paths=lookup(dpath="variance/monte_carlo/paths", within=config),
        seed=lookup(dpath="seed", within=config),
        index=lambda wildcards: int(wildcards.shard),
    log:
        f"{RESULTS}/logs/variance/shard_{{shard}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/shard_{{shard}}.tsv"
    threads: 1
    script:
        "../scripts/variance/shard.py"


rule variance_halving:
    message:
        "Halve the time step of the variance's Monte Carlo"
    input:
        modules=sources("workflow/scripts/variance/halving.py"),
    output:
        ensure(f"{RESULTS}/variance/halving.nc", non_empty=True),
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        step=lookup(dpath="variance/monte_carlo/step", within=config),
        paths=lookup(dpath="variance/monte_carlo/halving_paths", within=config),
        seed=lookup(dpath="seed", within=config),
    log:
        f"{RESULTS}/logs/variance/halving.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/halving.tsv"
    threads: 1
    script:
        "../scripts/variance/halving.py"


rule variance_monte_carlo:
    message:
        "Merge the shards of the variance"
    input:
        shards=expand(
            "{results}/variance/shards/{shard}.nc",
            results=RESULTS,
            shard=shards(config["variance"]["monte_carlo"]),
        ),
        halving=rules.variance_halving.output[0],
        modules=sources("workflow/scripts/variance/monte_carlo.py"),
    output:
        ensure(f"{RESULTS}/variance/monte_carlo.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/variance/monte_carlo.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/monte_carlo.tsv"
    threads: 1
    script:
        "../scripts/variance/monte_carlo.py"


rule check_variance:
    message:
        "Check that the three methods agree within their stated errors"
    input:
        spectral=rules.variance_spectral.output[0],
        finite_difference=rules.variance_finite_difference.output[0],
        monte_carlo=rules.variance_monte_carlo.output[0],
        modules=sources("workflow/scripts/variance/check.py"),
    output:
        ensure(f"{RESULTS}/variance/check.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/variance/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/check.tsv"
    threads: 1
    script:
        "../scripts/variance/check.py"


rule figure_2a:
    message:
        "Draw figure 2a"
    input:
        spectral=rules.variance_spectral.output[0],
        finite_difference=rules.variance_finite_difference.output[0],
        monte_carlo=rules.variance_monte_carlo.output[0],
        check=rules.check_variance.output[0],
        modules=sources("workflow/scripts/variance/figure_2a.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_2a", ".pdf", ".png"),
            caption="../report/figure_2a.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_2a.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_2a.tsv"
    threads: 1
    script:
        "../scripts/variance/figure_2a.py"
