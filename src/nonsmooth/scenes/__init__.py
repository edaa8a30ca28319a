"""What is studied: a mechanical model, its noise and the observable, in one object, the scene.

A scene holds the equations of motion as formulas. All solvers take from it what they need: the
drift, the smallest set of variables that determines the observable, the kinks of the penalty, the
symmetries.
Nothing is solved in this package.

- `scene.Scene`: model, noise, potential U, damping C_b, penalization n, observable g, start;
  `scene.by_formulas`: the same from a table of parameters
- `models`: the mechanical models, one file each, and their contract `models.model.Model`
- `noises`: `White`, `Langevin`, `Hamiltonian`, `OrnsteinUhlenbeck`, `KanaiTajimi` and their
  contract `Noise`
- `penalties.Penalty`: the Moreau-Yosida regularisations, `ABSOLUTE_VALUE` and `BARRIER`
- `formulas.parse`, `formulas.vectorised`: text to sympy, sympy to numpy; `formulas.compilable`
- `regularity.require_moderate`, `regularity.fault`: formulas of a size that double precision can
  compute with; a g that is real, has no poles and can be resolved
- `symbols`: the variables zeta, eta, y, x and the damping C_b
- `thresholds.bounds`: the two levels of a threshold
- `equations`: Table 2 of the paper with undefined functions for potentials and penalties
- `relaxation.rate_at_infinity`: how fast paths come back from far out
"""
