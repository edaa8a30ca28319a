"""Hard cases: what the public functions return where a method is likely to fail.

A method may refuse a case with a message, or return a result whose stated error is at least the
true one. Anything else is wrong: a value that is off by more than it says, or is not a number.

- `reproduction.hard_cases.record` : `Case`, `Result`, `Outcome`, and `examine`, which runs a case
  and judges it.
- `reproduction.hard_cases.calls` : the public functions as the cases call them.
- `reproduction.hard_cases.references` : independent values.
- `reproduction.hard_cases.cases` : `CASES`, all of them.
- `reproduction.hard_cases.extreme_scenes` : stiff penalties, large steps, weak and strong damping,
  wells.
- `reproduction.hard_cases.extreme_questions` : thresholds, horizons and grids far from the usual.
- `reproduction.hard_cases.extreme_observables` : observables and starts that strain the theory or
  the arithmetic, and what is not a number.
"""
