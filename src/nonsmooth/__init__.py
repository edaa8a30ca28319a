"""Random vibration of non-smooth mechanical systems.

The functions below are the public interface; they are imported when first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "brownian": [
            "brownian_crossing",
            "brownian_first_passage_density",
            "brownian_survival",
        ],
        "crossing": ["crossing_probability"],
        "density": ["invariant_density"],
        "errors": ["NonsmoothError"],
        "estimate": ["Estimate"],
        "milne": ["extrapolation_length"],
        "noises": ["Hamiltonian", "KanaiTajimi", "Langevin", "OrnsteinUhlenbeck", "White"],
        "scene": ["Scene"],
        "spectral_gap": ["spectral_gap"],
        "trajectories": ["simulate"],
        "variance": ["asymptotic_variance", "variance"],
    },
)
