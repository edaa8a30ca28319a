# What is wrong in the printed paper, with evidence.


rule errata:
    """Evaluate the errata, printed against mended"""
    input:
        printed=own("paper/printed.yaml"),
    output:
        "<results>/errata/errata.nc",
    script:
        "../scripts/errata/errata.py"


rule table_errata:
    """Typeset the table of errata"""
    input:
        evidence=rules.errata.output[0],
    output:
        table("table_errata"),
    script:
        "../scripts/errata/table_errata.py"
