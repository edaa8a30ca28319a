"""Paths whose noise is shifted towards a level, and the likelihood ratios that make up for it.

- `polynomials.Polynomials`: monomials of the state, and what the noise makes of them
- `poisson.fitted`: the Poisson solution of g as a polynomial, from a short simulation
- `tilt.Guide`: by how much the noise is shifted, given the state and the distance to the level
- `cross_entropy.refitted`: a better guide, from paths that have reached the level
- `loop.march_tilted`, `loop.march_tilted_pair`: the loops over time steps
"""
