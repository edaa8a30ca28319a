# Figures 3, 4, 5: one path of each model for several penalizations.


rule trajectories:
    """Simulate the {wildcards.model} trajectories"""
    output:
        "<results>/trajectories/{model}.nc",
    params:
        **settings("trajectories", "n", "horizon", "step", "outputs"),
        **settings("trajectories/models/{model}", "potential", "damping", "path"),
        model="{model}",
        seed=config["seed"],
    script:
        "../scripts/trajectories/simulate.py"


rule figure_3:
    input:
        trajectories="<results>/trajectories/elasto_plastic.nc",
    output:
        figure("figure_3", caption="trajectories"),
    params:
        model="elasto_plastic",
    message:
        "Draw the trajectories of {params.model}, {rule}"
    script:
        "../scripts/trajectories/figure.py"


use rule figure_3 as figure_4 with:
    input:
        trajectories="<results>/trajectories/obstacle.nc",
    output:
        figure("figure_4", caption="trajectories"),
    params:
        model="obstacle",


use rule figure_3 as figure_5 with:
    input:
        trajectories="<results>/trajectories/friction.nc",
    output:
        figure("figure_5", caption="trajectories"),
    params:
        model="friction",
