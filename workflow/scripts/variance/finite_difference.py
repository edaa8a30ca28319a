"""w and v of figure 2a by the paper's finite-difference scheme."""

from nonsmooth.line.finite_differences import moments_with_error
from nonsmooth.paths import time_grids
from nonsmooth.scenes.scene import Scene
from reproduction.errors import configured_by
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def paper_scheme(scene, first_time, horizon, points, half_width, nodes, time_step):
    """March the paper's scheme to the last tau.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    tau = time_grids.logarithmic(first_time, horizon, points)
    with configured_by("variance", "finite_difference"):
        _, v, _, v_error = moments_with_error(scene, tau, half_width, nodes, time_step)
    return artifact.dataset(
        "Variance of the integrated observable by the paper's finite differences",
        f"v(0, tau) of {scene}",
        {"tau": ("tau", tau, "time tau")},
        {
            "v": ("tau", v, "variance of int_0^tau g"),
            "v_error": ("tau", v_error, "error bound of v from coarser steps and meshes"),
        },
    )


if __name__ == "__main__":
    produce(paper_scheme, snakemake)
