"""What only the paper needs: its results as files, figures and tables, and its examples.

The workflow's scripts call this package, and this package calls the library `nonsmooth`. The
packages `configuration`, `jobs` and `rendering` and the modules `agreement`, `errors` and
`time_scales` serve all topics of the paper; every other package or module is one topic.

`configuration`
    What the user asks for, read strictly, and one line about what is wrong with it.
`jobs`
    How a script runs, and the files that it reads and writes.
`rendering`
    Figures, tables and what the paper prints.
`agreement`
    `deviation`, `require_telling`: whether a method agrees with the reference beside it.
`errors`
    Errors of the workflow: `ConfigError`, `ArtifactError`, `CheckError`.
`time_scales`
    `contact_time`: what the steps of a penalized scene must resolve.
`convergence`
    `printed_in_table_4`: the values that the paper prints for a scene and a horizon.
`gamma2`
    `compared`, `require_agreement`: the asymptotic variance by two methods, side by side.
`finite_p`
    `probabilities`, `powers_of_p`: formulas for crossing probabilities and their errors.
`sweep`
    `crossing_bias`: the bias of the time step in the crossing probabilities of every scene.
`limit_theorem`
    Samples of the scaled integral, and their distances to the laws of the limit.
`rates`
    Distances of penalized scenes to their non-smooth limits, and the powers of n that fit them.
`plasticity`
    `yielding_oscillator`: the example of a structure in an earthquake.
`errata`, `hard_cases`
    What is wrong in the paper, each entry with evidence; and cases in which methods might fail.
`paper_values`
    `paper_values`: the numbers that the text of the paper quotes, spelt as they stand there.
`speed_against_error`
    Work-precision diagrams: the errors of methods against the time that they take.
"""
