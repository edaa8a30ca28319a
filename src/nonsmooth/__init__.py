"""Random vibration of non-smooth mechanical systems.

Damped oscillators that yield, stick or hit obstacles under white or colored noise: how the integral
of an observable spreads, and with which probability it crosses a threshold. The non-smooth force is
penalized by n; most functions also take the limit n = inf.

What is studied: `Scene`, with the noises `White`, `Langevin`, `Hamiltonian`, `OrnsteinUhlenbeck`,
`KanaiTajimi`. What can be asked of a scene:

- `asymptotic_variance`: gamma^2, `mean`: E g, and `variance`: the variance of the integral at
  given times
- `asymptotic_variance_sensitivity`: the derivative of gamma^2 by a parameter
- `invariant_density`, `spectral_gap`: where the state is in the long run, and how soon it forgets
  its start
- `simulate`: paths, or the moments of the integral
- `crossing_probability`: of a threshold by the integral; `extrapolation_length`: kappa, by which
  the threshold appears farther away
- `state_crossing_probability`: of a threshold by the displacement or the velocity themselves
- `crossing_threshold`, `failure_time`: the threshold, or the time, at which that probability takes
  a given value; `mean_time_to_failure`, `hazard_rate`, `reliability_index`
- `crossing_sensitivity`: the derivative of a crossing probability by a parameter
- `brownian_crossing`, `brownian_survival`, `brownian_first_passage_density`: the limit, in which
  the integral is a Brownian motion
- `plot`: a picture of what these return

Results are `Estimate` objects or xarray datasets, with error estimates. Exceptions meant for the
user are subclasses of `NonsmoothError`.
The names above are imported when first used; `__init__.pyi` says from where.
"""

import lazy_loader

__version__ = "0.2.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
