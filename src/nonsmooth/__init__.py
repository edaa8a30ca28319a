"""Random vibration of non-smooth mechanical systems.

The functions below are the public interface; they are imported when first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "crossing.brownian": [
            "brownian_crossing",
            "brownian_first_passage_density",
            "brownian_survival",
        ],
        "crossing.probability": ["crossing_probability"],
        "statistics.invariant_density": ["invariant_density"],
        "errors": ["NonsmoothError"],
        "estimate": ["Estimate"],
        "boundary_layer.extrapolation_length": ["extrapolation_length"],
        "scenes.noises": ["Hamiltonian", "KanaiTajimi", "Langevin", "OrnsteinUhlenbeck", "White"],
        "scenes.scene": ["Scene"],
        "statistics.spectral_gap": ["spectral_gap"],
        "paths.simulation": ["simulate"],
        "statistics.asymptotic_variance": ["asymptotic_variance"],
        "statistics.variance": ["variance"],
    },
)
