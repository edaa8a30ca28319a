"""What only the paper needs: its results as files, figures and tables, and its examples.

The workflow's scripts call this package, and it calls the library `nonsmooth`. A script is run by
`jobs.produce`, which reads the artifacts it needs and writes its own, or by `plots.draw` and
`tables.typeset`, which write a figure or a table instead.

`artifact`
    netCDF files with units, errors and provenance: `dataset`, `write`, `read`, `provenance`.
`errors`
    What a user of the workflow can cause: `ConfigError`, `ArtifactError`, `CheckError`.
`files`
    `whole`: a file is written completely or not at all.
`jobs`
    `job`, `produce`: how a script runs, and what it says if it fails.
`configuration`
    `validate`: errors of the configuration in one line.
`printed`
    `printed_values`, `numbered`: what the paper prints, and how it numbers its equations.
`paper_values`
    `paper_values`: the numbers that the text of the paper quotes, spelt as they stand there.
`plots`, `tables`
    `draw` and the style of the figures; `typeset` and how numbers are spelled.
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
`speed_against_error`
    Work-precision diagrams.
"""
