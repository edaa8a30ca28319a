# Figure 1: the rheological models.


rule figure_1:
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
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Draw figure 1, the rheological models"
    script:
        "../scripts/rheology/figure_1.py"
