"""Derivatives of E exp(-z tau) with respect to parameters, on given nodes.

- `adjoint.Adjoint`: with one state variable, by the adjoint equation.
- `reduced.differentiated`: with two, by the differentiated equation in the basis of few ordinates.
- `exponentials`: integrals that both need.
"""
