# The paper's Lemma 1, tested: drift condition of every scene.


rule drift_condition:
    input:
        modules=sources("workflow/scripts/theorems/drift_condition.py"),
    output:
        ensure(f"{RESULTS}/theorems/drift_condition.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/theorems/drift_condition.log",
    benchmark:
        f"{RESULTS}/benchmarks/theorems/drift_condition.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        potentials=lookup(dpath="theorems/potentials", within=config),
        langevin=lookup(dpath="theorems/langevin", within=config),
        damping=lookup(dpath="theorems/damping", within=config),
        n=lookup(dpath="theorems/n", within=config),
        points=lookup(dpath="theorems/points", within=config),
        reach=lookup(dpath="theorems/reach", within=config),
    message:
        "Search for violations of the drift condition"
    script:
        "../scripts/theorems/drift_condition.py"


rule table_7:
    input:
        drift_condition=rules.drift_condition.output[0],
        modules=sources("workflow/scripts/theorems/table_7.py"),
    output:
        multiext(f"{RESULTS}/tables/table_7", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_7.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_7.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset table 7, the margins of the drift condition"
    script:
        "../scripts/theorems/table_7.py"
