from .boundary_layer.extrapolation_length import extrapolation_length as extrapolation_length
from .crossing.brownian import brownian_crossing as brownian_crossing
from .crossing.brownian import brownian_first_passage_density as brownian_first_passage_density
from .crossing.brownian import brownian_survival as brownian_survival
from .crossing.probability import crossing_probability as crossing_probability
from .crossing.state.crossing import (
    state_crossing_probability as state_crossing_probability,
)
from .errors import NonsmoothError as NonsmoothError
from .estimate import Estimate as Estimate
from .paths.simulation import simulate as simulate
from .plotting.drawing import plot as plot
from .reliability.hazard import hazard_rate as hazard_rate
from .reliability.index import reliability_index as reliability_index
from .reliability.mean_time import mean_time_to_failure as mean_time_to_failure
from .reliability.quantiles import crossing_threshold as crossing_threshold
from .reliability.quantiles import failure_time as failure_time
from .scenes.noises import Hamiltonian as Hamiltonian
from .scenes.noises import KanaiTajimi as KanaiTajimi
from .scenes.noises import Langevin as Langevin
from .scenes.noises import OrnsteinUhlenbeck as OrnsteinUhlenbeck
from .scenes.noises import White as White
from .scenes.scene import Scene as Scene
from .sensitivity.crossing import crossing_sensitivity as crossing_sensitivity
from .sensitivity.gamma2 import (
    asymptotic_variance_sensitivity as asymptotic_variance_sensitivity,
)
from .statistics.asymptotic_variance import asymptotic_variance as asymptotic_variance
from .statistics.density.invariant_density import invariant_density as invariant_density
from .statistics.mean import mean as mean
from .statistics.spectral_gap import spectral_gap as spectral_gap
from .statistics.variance import variance as variance

__version__: str
