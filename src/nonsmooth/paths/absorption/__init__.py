"""Paths that end where a variable of the state leaves an interval.

A path has a probability to have stayed inside. It becomes 0 where a step ends outside. For the
variable that noise drives it is also multiplied, in each step, with the probability that a Brownian
bridge between the ends of the step stays inside, so that crossings within steps are counted.

- `survival.crossed`: the sums over an ensemble from which probabilities and errors follow
- `passages.coupled_passages`: first-passage times of int g with two steps, without bridges
- `moving`: moments and paths under an envelope, by the same loop
- `envelope.scales`: the noise of each step under an envelope
- `loop.march_survival`: the loop over time steps, with a step and with half of it on the same noise
"""
