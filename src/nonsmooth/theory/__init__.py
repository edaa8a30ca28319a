"""The paper's theorems, tested: nothing else in the library depends on this package.

The theorems rest on a Lyapunov function V_n whose drift is negative far out (Lemma 2). Here V_n is
built for a scene with the constants of the proof, the inequalities of the proof are evaluated at
many points, and the constants that the theorems only say exist are computed. Equations, claims and
theorems are cited by the numbers that the paper prints.

- `assumptions.confinement`, `assumptions.restoring_rate`, `assumptions.dissipation`: the constants
  of the standing assumptions on U, v, H and F
- `lyapunov.constants`, `lyapunov.function`, `lyapunov.drift`, `lyapunov.evaluate`: V_n and
  A_n V_n + epsilon V_n, in algebra and in numbers
- `drift_bounds.bound`, `drift_bounds.noise_bound`, `drift_bounds.mechanical_claims`,
  `drift_bounds.lower_bound`: what the proof says about them
- `drift_condition.margins`: the search for points at which an inequality fails
- `ergodicity.decay_rate`, `ergodicity.poisson_bound`: rate and constant of Theorems 4 and 5
"""
