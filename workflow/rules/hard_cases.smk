# Nasty cases: an error that holds, or a message. Not part of the paper; a target of its own.


rule examine_hard_cases:
    input:
        modules=sources("workflow/scripts/hard_cases/examine.py"),
    output:
        ensure(f"{RESULTS}/hard_cases/outcomes.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/hard_cases/examine.log",
    benchmark:
        f"{RESULTS}/benchmarks/hard_cases/examine.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 2
    params:
        paths=lookup(dpath="hard_cases/paths", within=config),
    message:
        "Try the nasty cases"
    script:
        "../scripts/hard_cases/examine.py"


rule hard_cases:
    input:
        outcomes=rules.examine_hard_cases.output[0],
        modules=sources("workflow/scripts/hard_cases/table_hard_cases.py"),
    output:
        multiext(f"{RESULTS}/tables/table_hard_cases", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_hard_cases.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_hard_cases.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset the table of hard cases"
    script:
        "../scripts/hard_cases/table_hard_cases.py"
