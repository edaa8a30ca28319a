"""The mechanical models: what the penalty is, which variable it reads and where it acts.

`model` holds the contract, the class `Model`, and says how to add a model; each of
`elasto_plastic`, `friction` and `obstacle` holds one of the paper's three (its Figure 1,
Tables 1 and 3); `registry` maps their names to them.
"""
