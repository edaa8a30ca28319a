"""Time-stepping schemes: how a path gets from one time to the next.

`scheme` holds the contract, the class `Scheme`, and says how to add a scheme; each of `strang`,
`lie`, `drift_implicit`, `dry_friction` and `euler_maruyama` holds one; `registry` maps their names
to them (`SCHEMES`), chooses one for a scene (`scheme`) and prepares its steps (`coefficients`).
"""
