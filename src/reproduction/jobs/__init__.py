"""How a script of the workflow runs: it reads artifacts, computes, and writes its output.

`job`
    `produce` reads the artifacts that a script needs and writes its own; `job` prints an error that
    the user can mend as one line; `require_as_written` compares a file with the log of its job.
`artifact`
    netCDF files with units, errors and provenance: `dataset`, `write`, `read`, `provenance`.
`files`
    `write_whole`: a file is written completely or not at all.
"""
