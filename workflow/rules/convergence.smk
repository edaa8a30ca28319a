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


rule check_convergence:
    """Check that both methods of table 4 agree, and with what the paper prints"""
    input:
        spectral=expand(
            "<results>/convergence/spectral/n={n}.nc", n=map(label, config["convergence"]["n"])
        ),
        finite_difference=expand(
            "<results>/convergence/finite_difference/n={n}.nc",
            n=map(label, finite(config["convergence"]["n"])),
        ),
        printed=own("paper/printed.yaml"),
    output:
        "<results>/convergence/check.nc",
    params:
        **settings("convergence", "scene", "horizon"),
    script:
        "../scripts/convergence/check.py"


rule table_4:
    """Typeset table 4"""
    input:
        spectral=rules.check_convergence.input.spectral,
        finite_difference=rules.check_convergence.input.finite_difference,
        check=rules.check_convergence.output[0],
        printed=own("paper/printed.yaml"),
    output:
        table("table_4"),
    params:
        **settings("convergence", "scene", "horizon"),
    script:
        "../scripts/convergence/table_4.py"
