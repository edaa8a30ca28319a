# The sweep: gamma^2 and crossing probabilities of every scene by Monte Carlo.


rule sweep_variance:
    input:
        modules=sources("workflow/scripts/sweep/variance.py"),
    output:
        ensure(f"{RESULTS}/sweep/{{scene}}/variance.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/sweep/{{scene}}_variance.log",
    benchmark:
        f"{RESULTS}/benchmarks/sweep/{{scene}}_variance.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="sweep/scenes/{scene}/scene", within=config),
        times=lookup(dpath="sweep/variance/times", within=config),
        step=lookup(dpath="sweep/step", within=config),
        paths=lookup(dpath="sweep/variance/paths", within=config),
        halving_paths=lookup(dpath="sweep/variance/halving_paths", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Estimate gamma^2 of {wildcards.scene} by Monte Carlo"
    script:
        "../scripts/sweep/variance.py"


rule sweep_crossing:
    input:
        modules=sources("workflow/scripts/sweep/crossing.py"),
    output:
        ensure(f"{RESULTS}/sweep/{{scene}}/p={{p}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/sweep/{{scene}}_p={{p}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/sweep/{{scene}}_p={{p}}.tsv"
    # the longest jobs come first
    priority: 100
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="sweep/scenes/{scene}/scene", within=config),
        threshold=lookup(dpath="sweep/scenes/{scene}/threshold", within=config),
        horizon=lookup(dpath="sweep/horizon", within=config),
        outputs=lookup(dpath="sweep/outputs", within=config),
        step=lookup(dpath="sweep/step", within=config),
        paths=lookup(dpath="sweep/paths", within=config),
        halving_paths=lambda wildcards: sweep_halving(config["sweep"], wildcards.p),
        seed=lookup(dpath="seed", within=config),
        p=lambda wildcards: float(wildcards.p),
    message:
        "Simulate the crossings of {wildcards.scene} at p = {wildcards.p}"
    script:
        "../scripts/sweep/crossing.py"


rule sweep_limit:
    input:
        variance=expand(
            "{results}/sweep/{scene}/variance.nc",
            results=RESULTS,
            scene=swept(config),
        ),
        solved=rules.table_5.input.solved,
        modules=sources("workflow/scripts/sweep/limit.py"),
    output:
        ensure(f"{RESULTS}/sweep/limit.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/sweep/limit.log",
    benchmark:
        f"{RESULTS}/benchmarks/sweep/limit.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=swept(config),
        names=lookup(dpath="growth/scenes", within=config),
        horizon=lookup(dpath="sweep/horizon", within=config),
        outputs=lookup(dpath="sweep/outputs", within=config),
    message:
        "Evaluate the asymptotic formula of every scene"
    script:
        "../scripts/sweep/limit.py"


rule figure_6:
    input:
        crossing=expand(
            "{results}/sweep/{scene}/p={p}.nc",
            results=RESULTS,
            scene=swept(config),
            p=map(label, config["sweep"]["p"]),
        ),
        limit=rules.sweep_limit.output[0],
        modules=sources("workflow/scripts/sweep/figure_6.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_6", ".pdf", ".png"),
            caption="../report/figure_6.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_6.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_6.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=swept(config),
        p=lookup(dpath="sweep/p", within=config),
    message:
        "Draw figure 6, the crossing probabilities of every scene"
    script:
        "../scripts/sweep/figure_6.py"


rule table_6:
    input:
        variance=rules.sweep_limit.input.variance,
        crossing=rules.figure_6.input.crossing,
        limit=rules.figure_6.input.limit,
        modules=sources("workflow/scripts/sweep/table_6.py"),
    output:
        multiext(f"{RESULTS}/tables/table_6", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_6.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_6.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=swept(config),
        p=lookup(dpath="sweep/p", within=config),
    message:
        "Typeset table 6, every scene by Monte Carlo"
    script:
        "../scripts/sweep/table_6.py"
