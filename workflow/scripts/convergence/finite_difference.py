"""One column of table 4 by the paper's scheme."""

from nonsmooth.line.finite_differences import moments_with_error
from nonsmooth.scenes.scene import Scene
from reproduction.errors import configured_by
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def paper_scheme(scene, n, horizon, half_width, nodes, time_step):
    """March the paper's scheme to T.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene, n=n)
    with configured_by("convergence", "finite_difference"):
        _, v, _, error = moments_with_error(scene, [horizon], half_width, nodes, time_step)
    return artifact.dataset(
        "v(0, T)/T by the paper's finite differences",
        f"{scene}, T = {horizon}",
        {"n": ((), n, "penalization")},
        {
            "v_over_time": ((), v[0] / horizon, "v(0, T)/T"),
            "v_over_time_error": (
                (),
                error[0] / horizon,
                "error bound from coarser steps and meshes",
            ),
        },
    )


if __name__ == "__main__":
    produce(paper_scheme, snakemake)
