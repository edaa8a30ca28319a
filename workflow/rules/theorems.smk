# The paper's Lemma 1 and Theorems 1 and 2, tested: drift condition of every scene, rates, bounds.


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


rule ergodicity:
    input:
        modules=sources("workflow/scripts/theorems/ergodicity.py"),
    output:
        ensure(f"{RESULTS}/theorems/ergodicity.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/theorems/ergodicity.log",
    benchmark:
        f"{RESULTS}/benchmarks/theorems/ergodicity.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=ergodic_scenes(config),
        tolerance=lookup(dpath="theorems/ergodicity/tolerance", within=config),
        step=lookup(dpath="theorems/ergodicity/step", within=config),
        enlargement=lookup(dpath="theorems/ergodicity/enlargement", within=config),
    message:
        "Measure how fast scenes forget their start"
    script:
        "../scripts/theorems/ergodicity.py"


rule table_7b:
    input:
        ergodicity=rules.ergodicity.output[0],
        modules=sources("workflow/scripts/theorems/table_7b.py"),
    output:
        multiext(f"{RESULTS}/tables/table_7b", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_7b.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_7b.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scenes=ergodic_scenes(config),
    message:
        "Typeset table 7b, rates of decay and bounds of the Poisson solution"
    script:
        "../scripts/theorems/table_7b.py"
