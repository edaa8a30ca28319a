# Work-precision diagrams: each method's error against its time, measured on the spot.
# Not part of the default run: `snakemake --cores 1 speed_against_error`. A job takes all cores, so
# that nothing runs beside it.

SPEED = config["speed_against_error"]
# what is drawn against what
AXES = {diagram: {"x": "seconds", "y": "error"} for diagram in ("pde", "monte_carlo", "crossing")}
AXES |= {
    "growth": {"x": "seconds", "y": "error"},
    "pathwise": {"x": "size", "y": "error"},
    "cost": {"x": "size", "y": "seconds"},
}
PEERS = sorted(str(path) for path in Path("benchmarks/peers").glob("*.py"))
# python of the peers' environment, if there is one
PEERS_PYTHON = SPEED["peers"] if Path(SPEED["peers"]).exists() else None


rule measure_pde:
    input:
        modules=sources("workflow/scripts/speed_against_error/pde.py") + PEERS,
    output:
        ensure(f"{RESULTS}/speed_against_error/pde.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/speed_against_error/pde.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_against_error/pde.tsv"
    conda:
        "../envs/environment.yaml"
    threads: workflow.cores
    params:
        **SPEED["pde"],
        rounds=SPEED["rounds"],
        python=PEERS_PYTHON,
    message:
        "Measure solvers for the variance"
    script:
        "../scripts/speed_against_error/pde.py"


rule measure_monte_carlo:
    input:
        modules=sources("workflow/scripts/speed_against_error/monte_carlo.py") + PEERS,
    output:
        ensure(f"{RESULTS}/speed_against_error/monte_carlo.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/speed_against_error/monte_carlo.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_against_error/monte_carlo.tsv"
    conda:
        "../envs/environment.yaml"
    threads: workflow.cores
    params:
        **SPEED["monte_carlo"],
        rounds=SPEED["rounds"],
        python=PEERS_PYTHON,
    message:
        "Measure schemes of Monte Carlo"
    script:
        "../scripts/speed_against_error/monte_carlo.py"


rule measure_crossing:
    input:
        modules=sources("workflow/scripts/speed_against_error/crossing.py"),
    output:
        ensure(f"{RESULTS}/speed_against_error/crossing.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/speed_against_error/crossing.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_against_error/crossing.tsv"
    conda:
        "../envs/environment.yaml"
    threads: workflow.cores
    params:
        **SPEED["crossing"],
        rounds=SPEED["rounds"],
    message:
        "Measure methods for crossing probabilities"
    script:
        "../scripts/speed_against_error/crossing.py"


rule measure_growth:
    input:
        solved=expand(
            "{results}/growth/{scene}.nc", results=RESULTS, scene=config["growth"]["scenes"]
        ),
        modules=sources("workflow/scripts/speed_against_error/growth.py"),
    output:
        ensure(f"{RESULTS}/speed_against_error/growth.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/speed_against_error/growth.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_against_error/growth.tsv"
    conda:
        "../envs/environment.yaml"
    threads: workflow.cores
    params:
        **SPEED["growth"],
        names=lookup(dpath="growth/scenes", within=config),
        scenes=lookup(dpath="sweep/scenes", within=config),
    message:
        "Measure gamma^2 of every scene"
    script:
        "../scripts/speed_against_error/growth.py"


rule measure_pathwise:
    input:
        modules=sources("workflow/scripts/speed_against_error/pathwise.py"),
    output:
        ensure(f"{RESULTS}/speed_against_error/pathwise.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/speed_against_error/pathwise.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_against_error/pathwise.tsv"
    conda:
        "../envs/environment.yaml"
    threads: workflow.cores
    params:
        **SPEED["pathwise"],
        rounds=SPEED["rounds"],
    message:
        "Measure strong errors"
    script:
        "../scripts/speed_against_error/pathwise.py"


rule measure_cost:
    input:
        modules=sources("workflow/scripts/speed_against_error/cost.py"),
    output:
        ensure(f"{RESULTS}/speed_against_error/cost.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/speed_against_error/cost.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_against_error/cost.tsv"
    conda:
        "../envs/environment.yaml"
    threads: workflow.cores
    params:
        **SPEED["cost"],
        scenes=lookup(dpath="sweep/scenes", within=config),
        rounds=SPEED["rounds"],
    message:
        "Measure how the time grows"
    script:
        "../scripts/speed_against_error/cost.py"


rule figure_speed:
    input:
        measurements=f"{RESULTS}/speed_against_error/{{diagram}}.nc",
        modules=sources("workflow/scripts/speed_against_error/figure.py"),
    output:
        multiext(f"{RESULTS}/figures/speed_{{diagram}}", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figures/speed_{{diagram}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/speed_{{diagram}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        x=lambda wildcards: AXES[wildcards.diagram]["x"],
        y=lambda wildcards: AXES[wildcards.diagram]["y"],
    message:
        "Draw the work-precision diagram {wildcards.diagram}"
    script:
        "../scripts/speed_against_error/figure.py"


rule table_speed:
    input:
        measurements=f"{RESULTS}/speed_against_error/{{diagram}}.nc",
        modules=sources("workflow/scripts/speed_against_error/table.py"),
    output:
        multiext(f"{RESULTS}/tables/speed_{{diagram}}", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/speed_{{diagram}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/speed_{{diagram}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        x=lambda wildcards: AXES[wildcards.diagram]["x"],
        y=lambda wildcards: AXES[wildcards.diagram]["y"],
    message:
        "Typeset the measurements {wildcards.diagram}"
    script:
        "../scripts/speed_against_error/table.py"


rule speed_against_error:
    input:
        expand("{results}/figures/speed_{diagram}.pdf", results=RESULTS, diagram=SPEED["diagrams"]),
        expand("{results}/tables/speed_{diagram}.csv", results=RESULTS, diagram=SPEED["diagrams"]),
