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


rule check_density:
    """Check that the histograms of figure 7 agree with the solved densities"""
    input:
        densities=expand("<results>/density/{scene}.nc", scene=config["density"]["scenes"]),
    output:
        "<results>/density/check/agreement.nc",
    params:
        **settings("density", "paths", names="scenes"),
    script:
        "../scripts/density/check.py"


rule figure_7:
    """Draw figure 7, the invariant density of every scene"""
    input:
        densities=rules.check_density.input.densities,
        check=rules.check_density.output[0],
    output:
        figure("figure_7"),
    params:
        **settings("sweep", "scenes"),
        **settings("density", names="scenes"),
    script:
        "../scripts/density/figure_7.py"
