# Tables 1, 2, 3: the models and noises, typeset from their definitions.


rule table_1:
    input:
        modules=sources("workflow/scripts/scenes/table_1.py"),
    output:
        multiext(f"{RESULTS}/tables/table_1", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_1.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_1.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset table 1, the variational inequalities and penalties"
    script:
        "../scripts/scenes/table_1.py"


rule table_2:
    input:
        modules=sources("workflow/scripts/scenes/table_2.py"),
    output:
        multiext(f"{RESULTS}/tables/table_2", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_2.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_2.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset table 2, drift and diffusion for each noise"
    script:
        "../scripts/scenes/table_2.py"


rule table_3:
    input:
        modules=sources("workflow/scripts/scenes/table_3.py"),
    output:
        multiext(f"{RESULTS}/tables/table_3", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_3.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_3.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset table 3, penalty functions and potential of each model"
    script:
        "../scripts/scenes/table_3.py"
