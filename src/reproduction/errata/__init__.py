"""What is wrong in the paper, each entry with evidence.

An entry names the place, quotes what is printed there, and says what is meant. Its evidence is one
quantity evaluated three times: by the printed formula, by the mended one, and by something
independent of both.

- `reproduction.errata.record` : `Erratum`, `Evidence`, and the decorator `erratum` that makes an
  entry of a function.
- `reproduction.errata.entries` : `ERRATA`, all entries in the order of their numbers.
- `reproduction.errata.stationary` : the invariant density and the spectra of the noises.
- `reproduction.errata.integral` : mean and variance of the integral of g, and its crossings.
- `reproduction.errata.theorems` : the proof of the drift condition and of the petite sets, and what
  the theorems assume.
- `reproduction.errata.misprints` : wrong symbols.
"""
