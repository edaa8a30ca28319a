"""Crossing probabilities: the chance that int g leaves an interval before a time.

This is the quantity that an engineer asks for. For times and thresholds that grow together it tends
to that of Brownian motion, a closed formula; corrected formulas add the boundary layer at the
thresholds; at a finite scale it is also computed without such an expansion, from a kinetic equation
or by counting paths. The manual has the derivations and the choice of the method in
`docs/methods/crossing.md`.

- `probability.crossing_probability`: the public function, which chooses the method.
- `brownian`: `brownian_crossing`, `brownian_survival`, `brownian_first_passage_density`,
  `brownian_exit`, `brownian_exit_density`, and the asymptotic formula, `asymptotic_crossing`.
- `corrected_formula.corrected_crossing`: corrected formulas with their errors, from the
  distribution functions of `expansion`, the mean over the clock of `random_clock`, and `drift`.
- `first_passage.distribution.deterministic_crossing`: the deterministic method.
- `monte_carlo.sampled_crossing`: Monte Carlo to a tolerance, from the counts of `counting` and the
  intervals of `proportions`.
- `leading.importance_sampling.importance_sampled_crossing`: rare crossings, by weighted paths.
- `state.crossing.state_crossing_probability`: crossings of the state, not of an integral.
- `curves.curves`: probabilities over horizons, as the public functions return them.
- `tuning`: resolutions and switching points.
"""
