# Table 4: v(0, T)/T for increasing n, the printed values beside ours.


rule convergence_spectral:
    """Solve for the variance at n = {wildcards.n}"""
    output:
        "<results>/convergence/spectral/n={n}.nc",
    params:
        **settings("convergence", "scene", "horizon", tolerance="spectral/tolerance"),
        n=number("n"),
    script:
        "../scripts/convergence/spectral.py"


rule convergence_finite_difference:
    """March the paper's finite differences at n = {wildcards.n}"""
    output:
        "<results>/convergence/finite_difference/n={n}.nc",
    params:
        **settings("convergence", "scene", "horizon"),
        **settings("convergence/finite_difference", "half_width", "nodes", "time_step"),
        n=number("n"),
    script:
        "../scripts/convergence/finite_difference.py"


rule table_4:
    """Typeset table 4"""
    input:
        spectral=expand(
            "<results>/convergence/spectral/n={n}.nc", n=map(label, config["convergence"]["n"])
        ),
        finite_difference=expand(
            "<results>/convergence/finite_difference/n={n}.nc",
            n=map(label, finite(config["convergence"]["n"])),
        ),
        printed="paper/printed.yaml",
    output:
        table("table_4"),
    script:
        "../scripts/convergence/table_4.py"
