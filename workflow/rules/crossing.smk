# Figure 2b: W(sqrt(p) b, p T) by Monte Carlo and its limit W_star(b / gamma, T).


rule crossing_shard:
    input:
        modules=sources("workflow/scripts/crossing/shard.py"),
    output:
        ensure(f"{RESULTS}/crossing/shards/p={{p}}/{{shard}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/crossing/p={{p}}_shard_{{shard}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/crossing/p={{p}}_shard_{{shard}}.tsv"
    # the longest jobs come first
    priority: 100
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="crossing/scene", within=config),
        threshold=lookup(dpath="crossing/threshold", within=config),
        horizon=lookup(dpath="crossing/horizon", within=config),
        outputs=lookup(dpath="crossing/outputs", within=config),
        step=lookup(dpath="crossing/step", within=config),
        part=lambda wildcards: part(config["crossing"], wildcards.shard),
        seed=lookup(dpath="seed", within=config),
        p=lambda wildcards: float(wildcards.p),
    message:
        "Simulate shard {wildcards.shard} of the crossings at p = {wildcards.p}"
    script:
        "../scripts/crossing/shard.py"


rule crossing_halving:
    input:
        modules=sources("workflow/scripts/crossing/halving.py"),
    output:
        ensure(f"{RESULTS}/crossing/halving/p={{p}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/crossing/p={{p}}_halving.log",
    benchmark:
        f"{RESULTS}/benchmarks/crossing/p={{p}}_halving.tsv"
    priority: 50
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="crossing/scene", within=config),
        threshold=lookup(dpath="crossing/threshold", within=config),
        horizon=lookup(dpath="crossing/horizon", within=config),
        step=lookup(dpath="crossing/step", within=config),
        paths=lambda wildcards: halving_paths(config["crossing"], wildcards.p),
        seed=lookup(dpath="seed", within=config),
        p=lambda wildcards: float(wildcards.p),
    message:
        "Halve the time step of the crossings at p = {wildcards.p}"
    script:
        "../scripts/crossing/halving.py"


rule crossing_growth:
    input:
        modules=sources("workflow/scripts/crossing/growth.py"),
    output:
        ensure(f"{RESULTS}/crossing/growth.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/crossing/growth.log",
    benchmark:
        f"{RESULTS}/benchmarks/crossing/growth.tsv"
    # a single job of its kind: it compiles one kernel while another core compiles the other
    priority: 200
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="crossing/scene", within=config),
        time=lookup(dpath="crossing/halving/growth_time", within=config),
        step=lookup(dpath="crossing/step", within=config),
        paths=lookup(dpath="crossing/halving/growth_paths", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Halve the time step in the growth of the variance"
    script:
        "../scripts/crossing/growth.py"


rule crossing_monte_carlo:
    input:
        shards=expand(
            "{results}/crossing/shards/p={{p}}/{shard}.nc",
            results=RESULTS,
            shard=shards(config["crossing"]),
        ),
        halving=rules.crossing_halving.output[0],
        modules=sources("workflow/scripts/crossing/monte_carlo.py"),
    output:
        ensure(f"{RESULTS}/crossing/p={{p}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/crossing/p={{p}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/crossing/p={{p}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        p=lambda wildcards: float(wildcards.p),
    message:
        "Merge the shards of the crossings at p = {wildcards.p}"
    script:
        "../scripts/crossing/monte_carlo.py"


rule crossing_asymptotic:
    input:
        modules=sources("workflow/scripts/crossing/asymptotic.py"),
    output:
        ensure(f"{RESULTS}/crossing/asymptotic.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/crossing/asymptotic.log",
    benchmark:
        f"{RESULTS}/benchmarks/crossing/asymptotic.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="crossing/scene", within=config),
        threshold=lookup(dpath="crossing/threshold", within=config),
        horizon=lookup(dpath="crossing/horizon", within=config),
        outputs=lookup(dpath="crossing/outputs", within=config),
    message:
        "Evaluate the asymptotic formula"
    script:
        "../scripts/crossing/asymptotic.py"


rule check_crossing:
    input:
        monte_carlo=expand(
            "{results}/crossing/p={p}.nc", results=RESULTS, p=map(label, config["crossing"]["p"])
        ),
        asymptotic=rules.crossing_asymptotic.output[0],
        growth=rules.crossing_growth.output[0],
        modules=sources("workflow/scripts/crossing/check.py"),
    output:
        ensure(f"{RESULTS}/crossing/check.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/crossing/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/crossing/check.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Check that the time step's bias is below the standard error"
    script:
        "../scripts/crossing/check.py"


rule table_time_step:
    input:
        check=rules.check_crossing.output[0],
        modules=sources("workflow/scripts/crossing/table_time_step.py"),
    output:
        multiext(f"{RESULTS}/tables/table_time_step", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_time_step.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_time_step.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset the table of the time step's bias"
    script:
        "../scripts/crossing/table_time_step.py"
