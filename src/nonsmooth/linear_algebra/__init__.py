"""Linear algebra that all rooms share.

`dense`
    Factorisations, eigenproblems and exponentials of dense matrices, during which Ctrl-C is heard.
`sylvester`
    Sylvester's equation, by matrix products.
"""
