# Figure 7: invariant densities of scenes of the sweep, solved for and as histograms.


rule density:
    """Solve for and sample the invariant density of {wildcards.scene}"""
    output:
        "<results>/density/{scene}.nc",
    priority: 50
    params:
        **settings("sweep/scenes/{scene}", "scene"),
        **settings("density", "tolerances", "bins", "reach", "step", "time", "paths"),
        seed=config["seed"],
    script:
        "../scripts/density/solve.py"


rule figure_7:
    """Draw figure 7, the invariant density of every scene"""
    input:
        densities=expand("<results>/density/{scene}.nc", scene=config["density"]["scenes"]),
    output:
        figure("figure_7"),
    params:
        **settings("sweep", "scenes"),
        **settings("density", names="scenes"),
    script:
        "../scripts/density/figure_7.py"
