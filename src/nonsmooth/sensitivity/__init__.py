"""Derivatives of answers with respect to parameters of a scene and of the question.

- `gamma2.asymptotic_variance_sensitivity`: of gamma^2, by the differentiated equations.
- `crossing.crossing_sensitivity`: of crossing probabilities, also by threshold and p.
- `first_passage`, `plane`, `differences`, `sampled`: the same of a `questions.Question`, by the
  differentiated equations of one and of two variables, by differences of solutions and by paths
  with common noise.
- `line.slope`, `grids.slope`: with one state variable, and with more.
- `parameters`: the parameters, and the derivatives of a scene's equations.
- `tuning`: numbers that were chosen.
"""
