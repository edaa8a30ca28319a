# An example: the permanent deformation of a yielding structure in an earthquake.


rule plasticity_variance:
    input:
        modules=sources("workflow/scripts/plasticity/variance.py"),
    output:
        ensure(f"{RESULTS}/plasticity/variance.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/plasticity/variance.log",
    benchmark:
        f"{RESULTS}/benchmarks/plasticity/variance.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        ground=lookup(dpath="plasticity/ground", within=config),
        oscillator=lookup(dpath="plasticity/oscillator", within=config),
        tolerance=lookup(dpath="plasticity/tolerance", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Compute gamma^2 and kappa of the permanent deformation"
    script:
        "../scripts/plasticity/variance.py"


rule plasticity_crossing:
    input:
        modules=sources("workflow/scripts/plasticity/crossing.py"),
    output:
        ensure(f"{RESULTS}/plasticity/limit={{limit}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/plasticity/limit={{limit}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/plasticity/limit={{limit}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        ground=lookup(dpath="plasticity/ground", within=config),
        oscillator=lookup(dpath="plasticity/oscillator", within=config),
        duration=lookup(dpath="plasticity/duration", within=config),
        outputs=lookup(dpath="plasticity/outputs", within=config),
        step=lookup(dpath="plasticity/step", within=config),
        paths=lookup(dpath="plasticity/paths", within=config),
        seed=lookup(dpath="seed", within=config),
        limit=lambda wildcards: float(wildcards.limit),
    message:
        "Simulate when the permanent deformation exceeds {wildcards.limit}"
    script:
        "../scripts/plasticity/crossing.py"


rule check_plasticity:
    input:
        variance=rules.plasticity_variance.output[0],
        monte_carlo=expand(
            "{results}/plasticity/limit={limit}.nc",
            results=RESULTS,
            limit=map(label, config["plasticity"]["limits"]),
        ),
        modules=sources("workflow/scripts/plasticity/check.py"),
    output:
        ensure(f"{RESULTS}/plasticity/check.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/plasticity/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/plasticity/check.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Compare the formulas for the permanent deformation with Monte Carlo"
    script:
        "../scripts/plasticity/check.py"


rule figure_9:
    input:
        monte_carlo=rules.check_plasticity.input.monte_carlo,
        check=rules.check_plasticity.output[0],
        modules=sources("workflow/scripts/plasticity/figure_9.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_9", ".pdf", ".png"),
            caption="../report/figure_9.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_9.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_9.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        oscillator=lookup(dpath="plasticity/oscillator", within=config),
    message:
        "Draw figure 9, the probability of exceeding a permanent deformation"
    script:
        "../scripts/plasticity/figure_9.py"
