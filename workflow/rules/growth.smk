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


rule potentials:
    input:
        modules=sources("workflow/scripts/growth/potentials.py"),
    output:
        ensure(f"{RESULTS}/growth/potentials/growth.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/growth/potentials.log",
    benchmark:
        f"{RESULTS}/benchmarks/growth/potentials.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="growth/potentials/scenes", within=config),
        tolerance=lookup(dpath="growth/potentials/tolerance", within=config),
        times=lookup(dpath="growth/potentials/times", within=config),
        paths=lookup(dpath="growth/potentials/paths", within=config),
        halving_paths=lookup(dpath="growth/potentials/halving_paths", within=config),
        step=lookup(dpath="growth/potentials/step", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Solve and simulate scenes with general potentials"
    script:
        "../scripts/growth/potentials.py"


rule table_potentials:
    input:
        found=rules.potentials.output[0],
        modules=sources("workflow/scripts/growth/table_potentials.py"),
    output:
        multiext(f"{RESULTS}/tables/table_potentials", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_potentials.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_potentials.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="growth/potentials/scenes", within=config),
    message:
        "Typeset table 5b, gamma^2 under general potentials by two methods"
    script:
        "../scripts/growth/table_potentials.py"


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
