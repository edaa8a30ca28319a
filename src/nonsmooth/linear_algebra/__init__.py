"""Linear algebra that all rooms share.

`davidson`
    Slow modes of a large operator whose inverse is known only approximately.
`dense`
    Factorisations, eigenproblems and exponentials of dense matrices, during which Ctrl-C is heard.
`effort`
    A limit of the operations of solvers.
`sylvester`
    Sylvester's equation, by matrix products.
"""
