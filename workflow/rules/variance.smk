# Figure 2a: v(0, tau)/tau by spectral elements, by the paper's scheme and by Monte Carlo.


rule variance_spectral:
    input:
        modules=sources("workflow/scripts/variance/spectral.py"),
    output:
        ensure(f"{RESULTS}/variance/spectral.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/variance/spectral.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/spectral.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        tolerance=lookup(dpath="variance/spectral/tolerance", within=config),
    message:
        "Solve for the variance by spectral elements"
    script:
        "../scripts/variance/spectral.py"


rule variance_finite_difference:
    input:
        modules=sources("workflow/scripts/variance/finite_difference.py"),
    output:
        ensure(f"{RESULTS}/variance/finite_difference.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/variance/finite_difference.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/finite_difference.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        half_width=lookup(dpath="variance/finite_difference/half_width", within=config),
        nodes=lookup(dpath="variance/finite_difference/nodes", within=config),
        time_step=lookup(dpath="variance/finite_difference/time_step", within=config),
    message:
        "March the paper's finite differences"
    script:
        "../scripts/variance/finite_difference.py"


rule variance_shard:
    input:
        modules=sources("workflow/scripts/variance/shard.py"),
    output:
        ensure(f"{RESULTS}/variance/shards/{{shard}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/variance/shard_{{shard}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/shard_{{shard}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        step=lookup(dpath="variance/monte_carlo/step", within=config),
        part=lambda wildcards: part(config["variance"]["monte_carlo"], wildcards.shard),
        seed=lookup(dpath="seed", within=config),
    message:
        "Simulate shard {wildcards.shard} of the variance"
    script:
        "../scripts/variance/shard.py"


rule variance_halving:
    input:
        modules=sources("workflow/scripts/variance/halving.py"),
    output:
        ensure(f"{RESULTS}/variance/halving.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/variance/halving.log",
    benchmark:
        f"{RESULTS}/benchmarks/variance/halving.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="variance/scene", within=config),
        first_time=lookup(dpath="variance/first_time", within=config),
        horizon=lookup(dpath="variance/horizon", within=config),
        points=lookup(dpath="variance/times", within=config),
        step=lookup(dpath="variance/monte_carlo/step", within=config),
        paths=lookup(dpath="variance/monte_carlo/halving_paths", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Halve the time step of the variance's Monte Carlo"
    script:
        "../scripts/variance/halving.py"


rule variance_monte_carlo:
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
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Merge the shards of the variance"
    script:
        "../scripts/variance/monte_carlo.py"


rule check_variance:
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
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Check that the three methods agree within their stated errors"
    script:
        "../scripts/variance/check.py"


rule figure_2a:
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
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Draw figure 2a"
    script:
        "../scripts/variance/figure_2a.py"
