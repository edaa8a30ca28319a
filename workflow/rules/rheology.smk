# Figure 1: the rheological models.


rule figure_1:
    """Draw figure 1, the rheological models"""
    output:
        figure("figure_1"),
    script:
        "../scripts/rheology/figure_1.py"
