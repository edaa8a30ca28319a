# The functional central limit theorem for scenes of the sweep: Xi_p against gamma W.


rule limit_theorem_samples:
    input:
        modules=sources("workflow/scripts/limit_theorem/simulate.py"),
    output:
        ensure(f"{RESULTS}/limit_theorem/samples/{{scene}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/limit_theorem/{{scene}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/limit_theorem/{{scene}}.tsv"
    priority: 50
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="sweep/scenes/{scene}/scene", within=config),
        p=lookup(dpath="limit_theorem/p", within=config),
        step=lookup(dpath="limit_theorem/step", within=config),
        paths=lookup(dpath="limit_theorem/paths", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Simulate the scaled integrals of {wildcards.scene}"
    script:
        "../scripts/limit_theorem/simulate.py"


rule check_limit_theorem:
    input:
        samples=expand(
            "{results}/limit_theorem/samples/{scene}.nc",
            results=RESULTS,
            scene=config["limit_theorem"]["scenes"],
        ),
        limit=rules.sweep_limit.output[0],
        modules=sources("workflow/scripts/limit_theorem/check.py"),
    output:
        ensure(f"{RESULTS}/limit_theorem/check.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/limit_theorem/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/limit_theorem/check.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="limit_theorem/scenes", within=config),
    message:
        "Check that every scene approaches the limit of the central limit theorem"
    script:
        "../scripts/limit_theorem/check.py"


rule figure_8:
    input:
        check=rules.check_limit_theorem.output[0],
        modules=sources("workflow/scripts/limit_theorem/figure_8.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_8", ".pdf", ".png"),
            caption="../report/figure_8.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_8.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_8.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="sweep/scenes", within=config),
    message:
        "Draw figure 8, the central limit theorem for every scene"
    script:
        "../scripts/limit_theorem/figure_8.py"
