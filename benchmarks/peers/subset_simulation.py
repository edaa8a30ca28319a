"""W of dry friction (C_b = 1, white or Langevin noise) by subset simulation of OpenTURNS.

The normal numbers of all steps of a path are the random variables, and the largest |Delta| of the
path is the response. The friction is integrated by the trapezoidal rule, the noise exactly.
"""

import numpy as np
import openturns as ot
from serve import serve


def subset_simulation(noise, n, threshold, horizon, p, step, paths):
    """Estimate P(max |Delta| >= sqrt(p) b before p T) with so many paths for each level."""
    steps = round(p * horizon / step)
    h = p * horizon / steps
    keep = np.exp(-h)
    strength = np.sqrt((1 - keep**2) / 2)
    langevin = noise == "langevin"
    damping = 1.0 if langevin else 0.0  # white noise comes with the damping

    def slide(y, drive):
        """Half an explicit and half an implicit Euler step, the latter solved by hand."""
        after = y + h * drive - h / 2 * (damping * y + np.clip(n * y, -1, 1))
        sticking = after / (1 + h / 2 * (damping + n))
        slipping = (after - h / 2 * np.sign(after)) / (1 + h / 2 * damping)
        return np.where(np.abs(n * sticking) <= 1, sticking, slipping)

    def largest(normals):
        """Largest |Delta| of paths, of which each has a row of normal numbers."""
        y, eta, delta, peak = np.zeros((4, len(normals)))
        for normal in np.asarray(normals).T:
            y = slide(y, eta)
            if langevin:
                delta = delta + h * y
                eta = keep * eta + strength * normal
            else:
                before, y = y, keep * y + strength * normal
                delta = delta + h / 2 * (before + y)
            peak = np.maximum(peak, np.abs(delta))
        return peak[:, None]

    response = ot.PythonFunction(steps, 1, func_sample=largest)
    # known to be independent: ot.Normal(steps) would multiply by a matrix
    variables = ot.RandomVector(ot.JointDistribution([ot.Normal()] * steps))
    crossing = ot.ThresholdEvent(
        ot.CompositeRandomVector(response, variables), ot.Greater(), np.sqrt(p) * threshold
    )

    def run(seed):
        ot.RandomGenerator.SetSeed(seed)
        method = ot.SubsetSampling(crossing)
        method.setBlockSize(paths)
        method.setMaximumOuterSampling(1)
        method.run()
        return method.getResult().getProbabilityEstimate()

    return run


if __name__ == "__main__":
    ot.TBB.SetThreadsNumber(1)
    serve({"subset simulation": subset_simulation})
