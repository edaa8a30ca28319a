# gamma^2 of the scenes of the sweep without Monte Carlo, and beside it.


rule growth_rate:
    input:
        modules=sources("workflow/scripts/growth/solve.py"),
    output:
        ensure(f"{RESULTS}/growth/{{scene}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/growth/{{scene}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/growth/{{scene}}.tsv"
    # with four variables these are the longest jobs of all
    priority: 200
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="sweep/scenes/{scene}/scene", within=config),
        tolerance=lookup(dpath="growth/tolerance", within=config),
    message:
        "Solve the Poisson equation of {wildcards.scene}"
    script:
        "../scripts/growth/solve.py"


rule table_5:
    input:
        solved=expand(
            "{results}/growth/{scene}.nc", results=RESULTS, scene=config["growth"]["scenes"]
        ),
        sampled=expand(
            "{results}/sweep/{scene}/variance.nc",
            results=RESULTS,
            scene=config["growth"]["scenes"],
        ),
        modules=sources("workflow/scripts/growth/table_5.py"),
    output:
        multiext(f"{RESULTS}/tables/table_5", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_5.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_5.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        names=lookup(dpath="growth/scenes", within=config),
        scenes=lookup(dpath="sweep/scenes", within=config),
    message:
        "Typeset table 5, gamma^2 of every scene by two methods"
    script:
        "../scripts/growth/table_5.py"
