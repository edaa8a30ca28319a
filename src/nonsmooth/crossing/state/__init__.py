"""First passage of a variable of the state, such as the displacement, out of an interval.

- `crossing.state_crossing_probability`: the public function, which chooses the method.
- `problem.StateCrossing`: what is asked; `problem.state_crossings` checks it.
- `line.solved`: one state variable, by the eigenfunctions of the killed generator.
- `plane.solved`: two state variables, by the backward equation on a tensor grid.
- `sampled.sampled_state_crossing`: Monte Carlo to a tolerance.
- `tuning`: numbers that were chosen.
"""
