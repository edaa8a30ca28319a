"""What a full run gave, kept under version control, and the comparison of another run with it.

`python -m reproduction.published publish` writes the record, `… verify` compares.

`record`
    `Number`, `Record`: the numbers of the tables and of the text with their errors, and the
    checksums of the artifacts; `gather` takes them from a folder of results.
`comparison`
    `compare`: identical, within the stated errors, or off.
"""
