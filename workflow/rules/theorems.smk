# The paper's Lemma 2 and Theorems 4 and 5, tested: the drift condition of every scene, rates of
# decay and bounds of the Poisson solution.


rule drift_condition:
    """Search for violations of the drift condition"""
    output:
        "<results>/theorems/drift_condition.nc",
    params:
        **settings("theorems", "potentials", "langevin", "damping", "n", "points", "reach"),
    script:
        "../scripts/theorems/drift_condition.py"


rule table_7:
    """Typeset table 7, the margins of the drift condition"""
    input:
        drift_condition=rules.drift_condition.output[0],
        printed=own("paper/printed.yaml"),
    output:
        table("table_7"),
    script:
        "../scripts/theorems/table_7.py"


rule ergodicity:
    """Measure how fast scenes forget their start"""
    output:
        "<results>/theorems/ergodicity.nc",
    params:
        **settings("theorems/ergodicity", "tolerance", "step", "enlargement"),
        scenes=ergodic_scenes(config),
    script:
        "../scripts/theorems/ergodicity.py"


rule table_7b:
    """Typeset table 7b, rates of decay and bounds of the Poisson solution"""
    input:
        ergodicity=rules.ergodicity.output[0],
    output:
        table("table_7b"),
    params:
        scenes=ergodic_scenes(config),
    script:
        "../scripts/theorems/table_7b.py"
