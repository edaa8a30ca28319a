"""What only the paper needs: its results as files, figures and tables, and its examples.

The workflow's scripts call this package, and it calls the library `nonsmooth`. Two packages serve
all topics of the paper; every other module or package is one topic.

`jobs`
    How a script runs, and the files that it reads and writes.
`rendering`
    Figures, tables and what the paper prints.
`errors`
    What a user of the workflow can cause: `ConfigError`, `ArtifactError`, `CheckError`.
`gamma2`
    `compared`: the asymptotic variance by two methods, side by side.
`finite_p`
    `probabilities`, `powers_of_p`: formulas for crossing probabilities and their errors.
`limit_theorem`
    Samples of the scaled integral, and their distances to the laws of the limit.
`rates`
    Distances of penalized scenes to their non-smooth limits, and the powers of n that fit them.
`plasticity`
    `yielding_oscillator`: the example of a structure in an earthquake.
`errata`, `hard_cases`
    What is wrong in the paper, and cases in which methods might fail, each with its evidence.
`paper_values`
    `paper_values`: the numbers that the text of the paper quotes, spelt as they stand there.
`speed_against_error`
    Work-precision diagrams.
"""
