# What is wrong in the paper, with evidence.


rule errata:
    input:
        modules=sources("workflow/scripts/errata/errata.py"),
    output:
        ensure(f"{RESULTS}/errata/errata.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/errata/errata.log",
    benchmark:
        f"{RESULTS}/benchmarks/errata/errata.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Evaluate the errata, printed against mended"
    script:
        "../scripts/errata/errata.py"


rule table_errata:
    input:
        evidence=rules.errata.output[0],
        modules=sources("workflow/scripts/errata/table_errata.py"),
    output:
        multiext(f"{RESULTS}/tables/table_errata", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_errata.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_errata.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset the table of errata"
    script:
        "../scripts/errata/table_errata.py"
