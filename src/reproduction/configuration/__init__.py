"""Configurations: what the user asks for, and one line about what is wrong with it.

`files`
    `read`: YAML read strictly, with the lines of what is broken or doubled.
`layers`
    `Layers`: files and the command line laid over each other, and which of them has a key.
`schema`
    `validate`: errors against the schema in one line.
"""
