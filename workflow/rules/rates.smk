# The limit n -> infinity: distances of penalized scenes to their non-smooth limits.


rule measure_rates:
    input:
        modules=sources("workflow/scripts/rates/measure.py"),
    output:
        ensure(f"{RESULTS}/rates/rates.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/rates/measure.log",
    benchmark:
        f"{RESULTS}/benchmarks/rates/measure.tsv"
    priority: 50
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="rates/scenes", within=config),
        horizon=lookup(dpath="rates/horizon", within=config),
        resolution=lookup(dpath="rates/resolution", within=config),
        longest=lookup(dpath="rates/longest_step", within=config),
        paths=lookup(dpath="rates/paths", within=config),
        weak=lookup(dpath="rates/weak", within=config),
        seed=lookup(dpath="seed", within=config),
    message:
        "Measure the distances to the non-smooth limit"
    script:
        "../scripts/rates/measure.py"


rule figure_12:
    input:
        rates=rules.measure_rates.output[0],
        modules=sources("workflow/scripts/rates/figure_12.py"),
    output:
        report(
            multiext(f"{RESULTS}/figures/figure_12", ".pdf", ".png"),
            caption="../report/figure_12.rst",
            category="Figures",
        ),
    log:
        f"{RESULTS}/logs/figures/figure_12.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/figure_12.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="rates/scenes", within=config),
    message:
        "Draw figure 12, distances to the non-smooth limit"
    script:
        "../scripts/rates/figure_12.py"


rule table_10:
    input:
        rates=rules.measure_rates.output[0],
        modules=sources("workflow/scripts/rates/table_10.py"),
    output:
        multiext(f"{RESULTS}/tables/table_10", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_10.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_10.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=lookup(dpath="rates/scenes", within=config),
    message:
        "Typeset table 10, rates of convergence to the non-smooth limit"
    script:
        "../scripts/rates/table_10.py"


rule rates:
    input:
        rules.figure_12.output,
        rules.table_10.output,
