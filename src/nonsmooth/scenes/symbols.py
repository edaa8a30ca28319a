"""The variables and parameters of all equations of motion, as sympy symbols.

The state of the paper is Z^n = (zeta, eta, y, x): two variables of the noise, the velocity and
the displacement. `damping` is C_b; the penalization n is `nonsmooth.scenes.penalties.n`.
"""

import sympy

zeta, eta, y, x = sympy.symbols("zeta eta y x", real=True)
STATE_VARIABLES = (zeta, eta, y, x)
# what they are called in captions
TITLES = {"zeta": "noise zeta", "eta": "noise eta", "y": "velocity y", "x": "displacement x"}
damping = sympy.Symbol("C_b", positive=True)
