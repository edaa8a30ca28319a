# Tables 1, 2, 3: the models and noises, typeset from their definitions.


rule table_1:
    """Typeset table 1, the variational inequalities and penalties"""
    output:
        table("table_1"),
    script:
        "../scripts/scenes/table_1.py"


rule table_2:
    """Typeset table 2, drift and diffusion for each noise"""
    output:
        table("table_2"),
    script:
        "../scripts/scenes/table_2.py"


rule table_3:
    """Typeset table 3, penalty functions and potential of each model"""
    output:
        table("table_3"),
    script:
        "../scripts/scenes/table_3.py"
