# Table 4: v(0, T)/T for increasing n, the paper's values beside ours.


rule convergence_spectral:
    input:
        modules=sources("workflow/scripts/convergence/spectral.py"),
    output:
        ensure(f"{RESULTS}/convergence/spectral/n={{n}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/convergence/spectral_n={{n}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/convergence/spectral_n={{n}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="convergence/scene", within=config),
        horizon=lookup(dpath="convergence/horizon", within=config),
        tolerance=lookup(dpath="convergence/spectral/tolerance", within=config),
        n=lambda wildcards: float(wildcards.n),
    message:
        "Solve for the variance at n = {wildcards.n}"
    script:
        "../scripts/convergence/spectral.py"


rule convergence_finite_difference:
    input:
        modules=sources("workflow/scripts/convergence/finite_difference.py"),
    output:
        ensure(f"{RESULTS}/convergence/finite_difference/n={{n}}.nc", non_empty=True),
    log:
        f"{RESULTS}/logs/convergence/finite_difference_n={{n}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/convergence/finite_difference_n={{n}}.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    params:
        scene=lookup(dpath="convergence/scene", within=config),
        horizon=lookup(dpath="convergence/horizon", within=config),
        half_width=lookup(dpath="convergence/finite_difference/half_width", within=config),
        nodes=lookup(dpath="convergence/finite_difference/nodes", within=config),
        time_step=lookup(dpath="convergence/finite_difference/time_step", within=config),
        n=lambda wildcards: float(wildcards.n),
    message:
        "March the paper's finite differences at n = {wildcards.n}"
    script:
        "../scripts/convergence/finite_difference.py"


rule table_4:
    input:
        spectral=expand(
            "{results}/convergence/spectral/n={n}.nc",
            results=RESULTS,
            n=map(label, config["convergence"]["n"]),
        ),
        finite_difference=expand(
            "{results}/convergence/finite_difference/n={n}.nc",
            results=RESULTS,
            n=map(label, finite(config["convergence"]["n"])),
        ),
        modules=[*sources("workflow/scripts/convergence/table_4.py"), "paper/printed.yaml"],
    output:
        multiext(f"{RESULTS}/tables/table_4", ".csv", ".tex", ".typ"),
    log:
        f"{RESULTS}/logs/tables/table_4.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables/table_4.tsv"
    conda:
        "../envs/environment.yaml"
    threads: 1
    message:
        "Typeset table 4"
    script:
        "../scripts/convergence/table_4.py"
