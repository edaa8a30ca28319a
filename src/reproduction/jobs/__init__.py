"""How a script of the workflow runs: it reads artifacts, computes, and writes what is complete.

`job`
    `produce` reads the artifacts that a script needs and writes its own; `job` says in one line
    what went wrong if the user can mend it.
`artifact`
    netCDF files with units, errors and provenance: `dataset`, `write`, `read`, `provenance`.
`files`
    `whole`: a file is written completely or not at all.
`configuration`
    `validate`: errors of the configuration in one line.
"""
