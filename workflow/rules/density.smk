# Invariant densities of scenes of the sweep: by the solvers and as histograms.


rule density:
    input:
        modules=sources("workflow/scripts/density/solve.py"),
    output:
        ensure(f"{RESULTS}/density/{{scene}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/density/{{scene}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/density/{{scene}}.tsv"
    priority: 50
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="sweep/scenes/{scene}/scene", within=config),
        tolerances=lookup(dpath="density/tolerances", within=config),
        bins=lookup(dpath="density/bins", within=config),
        step=lookup(dpath="density/step", within=config),
        time=lookup(dpath="density/time", within=config),
        paths=lookup(dpath="density/paths", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Solve for and sample the invariant density of {wildcards.scene}"
    script:
        "../scripts/density/solve.py"


rule figure_7:
    input:
        densities=expand(
            "{results}/density/{scene}.nc", results=RESULTS, scene=config["density"]["scenes"]
        ),
        modules=sources("workflow/scripts/density/figure_7.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_7", ".pdf", ".png"),
            caption="../report/figure_7.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_7.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_7.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="sweep/scenes", within=config),
        names=lookup(dpath="density/scenes", within=config),
    message:
        "Draw figure 7, the invariant density of every scene"
    script:
        "../scripts/density/figure_7.py"
