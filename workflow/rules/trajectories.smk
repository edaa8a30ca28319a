# Figures 3, 4, 5: one path of each model for several penalizations.


rule trajectories:
    input:
        modules=sources("workflow/scripts/trajectories/simulate.py"),
    output:
        ensure(f"{RESULTS}/trajectories/{{model}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/trajectories/{{model}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/trajectories/{{model}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        model="{model}",
        potential=lookup(dpath="trajectories/models/{model}/potential", within=config),
        damping=lookup(dpath="trajectories/models/{model}/damping", within=config),
        path=lookup(dpath="trajectories/models/{model}/path", within=config),
        n=lookup(dpath="trajectories/n", within=config),
        horizon=lookup(dpath="trajectories/horizon", within=config),
        step=lookup(dpath="trajectories/step", within=config),
        outputs=lookup(dpath="trajectories/outputs", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Simulate the {wildcards.model} trajectories"
    script:
        "../scripts/trajectories/simulate.py"


rule figure_3:
    input:
        trajectories=f"{RESULTS}/trajectories/elasto_plastic.nc",
        modules=sources("workflow/scripts/trajectories/figure_3.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_3", ".pdf", ".png"),
            caption="../report/trajectories.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_3.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_3.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Draw figure 3, the elasto-plastic trajectories"
    script:
        "../scripts/trajectories/figure_3.py"


rule figure_4:
    input:
        trajectories=f"{RESULTS}/trajectories/obstacle.nc",
        modules=sources("workflow/scripts/trajectories/figure_4.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_4", ".pdf", ".png"),
            caption="../report/trajectories.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_4.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_4.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Draw figure 4, the obstacle trajectories"
    script:
        "../scripts/trajectories/figure_4.py"


rule figure_5:
    input:
        trajectories=f"{RESULTS}/trajectories/friction.nc",
        modules=sources("workflow/scripts/trajectories/figure_5.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_5", ".pdf", ".png"),
            caption="../report/trajectories.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_5.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_5.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Draw figure 5, the friction trajectories"
    script:
        "../scripts/trajectories/figure_5.py"
