"""Derivatives of answers with respect to parameters of a scene and of the question.

- `gamma2.asymptotic_variance_sensitivity`: of gamma^2, by the differentiated equations.
- `line.elasticity`, `grids.elasticity`: with one state variable, and with more.
- `parameters`: the parameters, and the derivatives of a scene's equations.
- `tuning`: numbers that were chosen.
"""
