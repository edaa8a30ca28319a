# Hard cases, in which every method must return a value with an error that holds, or a message. They
# are not part of the paper but a target of their own.


rule examine_hard_cases:
    """Try the hard cases"""
    output:
        "<results>/hard_cases/outcomes.nc",
    params:
        **settings("hard_cases", "paths"),
    script:
        "../scripts/hard_cases/examine.py"


rule hard_cases:
    """Typeset the table of hard cases"""
    input:
        outcomes=rules.examine_hard_cases.output[0],
    output:
        table("table_hard_cases"),
    script:
        "../scripts/hard_cases/table_hard_cases.py"
