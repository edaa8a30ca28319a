# Figure 1: the rheological models.


rule figure_1:
    message:
        "Draw figure 1, the rheological models"
    input:
        modules=sources("workflow/scripts/rheology/figure_1.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_1", ".pdf", ".png"),
            caption="../report/figure_1.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_1.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_1.tsv"
    threads: 1
    script:
        "../scripts/rheology/figure_1.py"
