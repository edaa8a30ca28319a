"""The same simulation by other packages: Euler-Maruyama of dry friction, int y and its maximum.

It runs in the peers' own environment on one core. `python peer_loops.py <peer>` prints nanoseconds
per path and step. Each peer gets the number of paths that suits it best.
"""

import os
import sys
import time

os.sched_setaffinity(0, {0})

STEP, PENALIZATION = 0.02, 100.0


def torch_loop(paths, steps):
    """Run tensor operations as one writes them down, single precision."""
    import torch

    torch.set_num_threads(1)

    def run():
        y, delta, peak = torch.zeros(paths), torch.zeros(paths), torch.zeros(paths)
        for _ in range(steps):
            delta = delta + STEP * y
            force = y + torch.clamp(PENALIZATION * y, -1.0, 1.0)
            y = y - STEP * force + STEP**0.5 * torch.randn(paths)
            peak = torch.maximum(peak, delta.abs())

    return run


def torch_in_place(paths, steps):
    """Run tensor operations in place, single precision."""
    import torch

    torch.set_num_threads(1)
    y, delta, peak = torch.zeros(paths), torch.zeros(paths), torch.zeros(paths)
    noise, force = torch.empty(paths), torch.empty(paths)

    def run():
        for _ in range(steps):
            torch.mul(y, PENALIZATION, out=force).clamp_(-1.0, 1.0).add_(y)
            delta.add_(y, alpha=STEP)
            noise.normal_()
            y.add_(force, alpha=-STEP).add_(noise, alpha=STEP**0.5)
            torch.maximum(peak, delta.abs(), out=peak)

    return run


def jax_scan(paths, steps):
    """Compile a scan over the steps, single precision."""
    import jax
    import jax.numpy as jnp

    def step(carry, key):
        y, delta, peak = carry
        delta = delta + STEP * y
        drift = y + jnp.clip(PENALIZATION * y, -1, 1)
        y = y - STEP * drift + STEP**0.5 * jax.random.normal(key, (paths,))
        return (y, delta, jnp.maximum(peak, jnp.abs(delta))), None

    @jax.jit
    def march(key):
        start = (jnp.zeros(paths),) * 3
        return jax.lax.scan(step, start, jax.random.split(key, steps))[0]

    return lambda: jax.block_until_ready(march(jax.random.key(1)))


def diffrax_solve(paths, steps, brownian=None, **options):
    """Solve by Diffrax's Euler method, without the maximum, as its manual shows."""
    import diffrax
    import jax
    import jax.numpy as jnp

    def drift(t, z, args):
        return jnp.array([-z[0] - jnp.clip(PENALIZATION * z[0], -1, 1), z[0]])

    def diffusion(t, z, args):
        return jnp.array([[1.0], [0.0]])

    def solve(key):
        noise = (
            brownian(key)
            if brownian
            else diffrax.VirtualBrownianTree(0.0, steps * STEP, tol=STEP / 2, shape=(1,), key=key)
        )
        terms = diffrax.MultiTerm(diffrax.ODETerm(drift), diffrax.ControlTerm(diffusion, noise))
        return diffrax.diffeqsolve(
            terms,
            diffrax.Euler(),
            0.0,
            steps * STEP,
            STEP,
            jnp.zeros(2),
            max_steps=steps + 1,
            **options,
        ).ys

    march = jax.jit(jax.vmap(solve))
    return lambda: jax.block_until_ready(march(jax.random.split(jax.random.key(1), paths)))


def diffrax_fastest(paths, steps):
    """Solve by Diffrax on its fastest Brownian path, which cannot be differentiated through."""
    import diffrax

    def brownian(key):
        return diffrax.UnsafeBrownianPath(shape=(1,), key=key)

    return diffrax_solve(paths, steps, brownian, adjoint=diffrax.ForwardMode())


PEERS = {
    "torch": (torch_loop, (1_000, 10_000, 100_000)),
    "torch, in place": (torch_in_place, (1_000, 10_000, 100_000)),
    "jax": (jax_scan, (1_000, 10_000, 100_000)),
    "diffrax": (diffrax_solve, (1_000, 10_000)),
    "diffrax, fastest": (diffrax_fastest, (1_000, 10_000)),
}


def nanoseconds(make, paths):
    """Time a run of about a second after a first one that compiles."""
    steps = max(10, 20_000_000 // paths // (10 if make in (diffrax_solve, diffrax_fastest) else 1))
    run = make(paths, steps)
    run()
    began = time.perf_counter()
    run()
    return (time.perf_counter() - began) / paths / steps * 1e9


if __name__ == "__main__":
    make, sizes = PEERS[sys.argv[1]]
    print(min(nanoseconds(make, paths) for paths in sizes))
