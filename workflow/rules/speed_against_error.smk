# Work-precision diagrams: each method's error against its time, measured on this machine.
# Not part of the default run: `snakemake --cores 1 speed_against_error`. A job takes all cores, so
# that nothing else runs at the same time.

SPEED = config["speed_against_error"]
# what each diagram draws: y against x
AXES = {diagram: {"x": "seconds", "y": "error"} for diagram in SPEED["diagrams"]}
AXES |= {"pathwise": {"x": "size", "y": "error"}, "cost": {"x": "size", "y": "seconds"}}
# sources of the other libraries' programs, and the python of their environment if there is one
PEERS = sorted(
    own(f"benchmarks/peers/{path.name}") for path in (ROOT / "benchmarks/peers").glob("*.py")
)
PEERS_PYTHON = SPEED["peers"] if Path(SPEED["peers"]).exists() else None


rule measure_pde:
    """Measure solvers for the variance"""
    input:
        peers=PEERS,
    output:
        "<results>/speed_against_error/pde.nc",
    threads: workflow.cores
    params:
        **SPEED["pde"],
        rounds=SPEED["rounds"],
        python=PEERS_PYTHON,
    script:
        "../scripts/speed_against_error/pde.py"


rule measure_monte_carlo:
    """Measure schemes of Monte Carlo"""
    input:
        peers=PEERS,
    output:
        "<results>/speed_against_error/monte_carlo.nc",
    threads: workflow.cores
    params:
        **SPEED["monte_carlo"],
        rounds=SPEED["rounds"],
        python=PEERS_PYTHON,
    script:
        "../scripts/speed_against_error/monte_carlo.py"


rule measure_crossing:
    """Measure methods for crossing probabilities"""
    output:
        "<results>/speed_against_error/crossing.nc",
    threads: workflow.cores
    params:
        **SPEED["crossing"],
        rounds=SPEED["rounds"],
    script:
        "../scripts/speed_against_error/crossing.py"


rule measure_rare:
    """Measure methods for rare crossings"""
    input:
        peers=PEERS,
    output:
        "<results>/speed_against_error/rare.nc",
    threads: workflow.cores
    params:
        **SPEED["rare"],
        rounds=SPEED["rounds"],
        python=PEERS_PYTHON,
    script:
        "../scripts/speed_against_error/rare.py"


rule measure_gamma2:
    """Measure gamma^2 of every scene"""
    input:
        solved=rules.table_5.input.solved,
    output:
        "<results>/speed_against_error/gamma2.nc",
    threads: workflow.cores
    params:
        **SPEED["gamma2"],
        **settings("gamma2", names="scenes"),
        **settings("sweep", "scenes"),
    script:
        "../scripts/speed_against_error/gamma2.py"


rule measure_pathwise:
    """Measure strong errors"""
    output:
        "<results>/speed_against_error/pathwise.nc",
    threads: workflow.cores
    params:
        **SPEED["pathwise"],
        rounds=SPEED["rounds"],
    script:
        "../scripts/speed_against_error/pathwise.py"


rule measure_cost:
    """Measure how the time grows"""
    output:
        "<results>/speed_against_error/cost.nc",
    threads: workflow.cores
    params:
        **SPEED["cost"],
        **settings("sweep", "scenes"),
        rounds=SPEED["rounds"],
    script:
        "../scripts/speed_against_error/cost.py"


rule figure_speed:
    """Draw the work-precision diagram {wildcards.diagram}"""
    input:
        measurements="<results>/speed_against_error/{diagram}.nc",
    output:
        multiext("<results>/figures/speed_{diagram}", ".pdf", ".png"),
    params:
        x=lambda wildcards: AXES[wildcards.diagram]["x"],
        y=lambda wildcards: AXES[wildcards.diagram]["y"],
    script:
        "../scripts/speed_against_error/figure.py"


rule table_speed:
    """Typeset the measurements {wildcards.diagram}"""
    input:
        measurements=rules.figure_speed.input.measurements,
    output:
        table("speed_{diagram}"),
    params:
        x=rules.figure_speed.params.x,
        y=rules.figure_speed.params.y,
    script:
        "../scripts/speed_against_error/table.py"


rule speed_against_error:
    input:
        expand("<results>/figures/speed_{diagram}.pdf", diagram=SPEED["diagrams"]),
        expand("<results>/tables/speed_{diagram}.csv", diagram=SPEED["diagrams"]),
