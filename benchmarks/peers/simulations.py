"""E Delta(T)^2 / T of dry friction (C_b = 1) by Euler-Maruyama, in loops and by SDE libraries.

Each sums y before the step, as a first program does. The libraries get their fastest settings.
"""

import numpy as np
from serve import serve


def plain_numba(n, horizon, step, paths):
    """One path after the other, with numba's own np.random."""
    import numba

    @numba.njit
    def loop(seed, paths, steps, h, n):
        np.random.seed(seed)  # noqa: NPY002 - what it is measured against
        total = 0.0
        for _ in range(paths):
            y = delta = 0.0
            for _ in range(steps):
                delta += h * y
                noise = np.random.standard_normal()  # noqa: NPY002
                y += -h * (y + min(1.0, max(-1.0, n * y))) + np.sqrt(h) * noise
            total += delta**2
        return total / paths

    steps = round(horizon / step)
    return lambda seed: loop(seed, paths, steps, horizon / steps, n) / horizon


def torch(n, horizon, step, paths):
    """Tensor operations as one writes them down, single precision."""
    import torch

    torch.set_num_threads(1)
    steps = round(horizon / step)

    def run(seed):
        torch.manual_seed(seed)
        y, delta = torch.zeros(paths), torch.zeros(paths)
        for _ in range(steps):
            delta = delta + step * y
            force = y + torch.clamp(n * y, -1.0, 1.0)
            y = y - step * force + step**0.5 * torch.randn(paths)
        return float(torch.mean(delta.double() ** 2)) / horizon

    return run


def torchsde(n, horizon, step, paths):
    """Its Euler method with diagonal noise, of which the displacement has none."""
    import torch
    import torchsde

    torch.set_num_threads(1)

    class Friction(torch.nn.Module):
        noise_type, sde_type = "diagonal", "ito"

        def f(self, t, z):
            y = z[:, :1]
            return torch.cat([-y - torch.clamp(n * y, -1.0, 1.0), y], dim=1)

        def g(self, t, z):
            return torch.tensor([[1.0, 0.0]]).expand_as(z)

    def run(seed):
        torch.manual_seed(seed)
        with torch.no_grad():
            ends = torch.tensor([0.0, horizon])
            start = torch.zeros(paths, 2)
            z = torchsde.sdeint(Friction(), start, ends, method="euler", dt=step)
        return float(torch.mean(z[-1, :, 1].double() ** 2)) / horizon

    return run


def diffrax(n, horizon, step, paths):
    """Its Euler method on its fastest Brownian path, compiled, without derivatives."""
    import diffrax
    import jax
    import jax.numpy as jnp

    def drift(t, z, args):
        return jnp.array([-z[0] - jnp.clip(n * z[0], -1, 1), z[0]])

    def diffusion(t, z, args):
        return jnp.array([[1.0], [0.0]])

    def solve(key):
        noise = diffrax.UnsafeBrownianPath(shape=(1,), key=key)
        terms = diffrax.MultiTerm(diffrax.ODETerm(drift), diffrax.ControlTerm(diffusion, noise))
        return diffrax.diffeqsolve(
            terms,
            diffrax.Euler(),
            0.0,
            horizon,
            step,
            jnp.zeros(2),
            max_steps=round(horizon / step) + 2,
            adjoint=diffrax.ForwardMode(),
        ).ys[0, 1]

    march = jax.jit(jax.vmap(solve))

    def run(seed):
        delta = march(jax.random.split(jax.random.key(seed), paths))
        return np.mean(np.asarray(delta, dtype=float) ** 2) / horizon

    return run


if __name__ == "__main__":
    serve(
        {
            "plain numba loop": plain_numba,
            "torch": torch,
            "torchsde": torchsde,
            "diffrax": diffrax,
        }
    )
