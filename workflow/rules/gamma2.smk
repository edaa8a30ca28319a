# Tables 5, 5b: gamma^2 by the Poisson equation beside gamma^2 by Monte Carlo.


rule gamma2:
    """Solve the Poisson equation of {wildcards.scene}"""
    output:
        "<results>/gamma2/{scene}.nc",
    # with four variables these are the longest jobs of all
    priority: 200
    params:
        **settings("sweep/scenes/{scene}", "scene"),
        **settings("gamma2", "tolerance"),
    script:
        "../scripts/gamma2/solve.py"


rule table_5:
    """Typeset table 5, gamma^2 of every scene by two methods"""
    input:
        solved=expand("<results>/gamma2/{scene}.nc", scene=config["gamma2"]["scenes"]),
        sampled=expand("<results>/sweep/{scene}/variance.nc", scene=config["gamma2"]["scenes"]),
    output:
        table("table_5"),
    params:
        **settings("gamma2", names="scenes"),
        **settings("sweep", "scenes"),
    script:
        "../scripts/gamma2/table_5.py"


rule potentials:
    """Solve and simulate scenes with general potentials"""
    output:
        "<results>/gamma2/potentials/gamma2.nc",
    # one long job, which must not be the last
    priority: 150
    params:
        **settings("gamma2/potentials", "scenes", "tolerance"),
        **settings("gamma2/potentials", "times", "paths", "halving_paths", "step"),
        seed=config["seed"],
    script:
        "../scripts/gamma2/potentials.py"


rule table_potentials:
    """Typeset table 5b, gamma^2 under general potentials by two methods"""
    input:
        found=rules.potentials.output[0],
    output:
        table("table_potentials"),
    params:
        **settings("gamma2/potentials", "scenes"),
    script:
        "../scripts/gamma2/table_potentials.py"
