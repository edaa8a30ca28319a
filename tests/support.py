"""What several tests use: the repository, copies of it, single steps of paths, coarse grids."""

import os
import shutil
from pathlib import Path

import sympy

import forked_snakemake
from nonsmooth.kinetic.ordinates_gibbs import gibbs_ordinates
from nonsmooth.kinetic.ordinates_plane import boxed, plane_ordinates
from nonsmooth.kinetic.tuning import GibbsLevel, PlaneLevel
from nonsmooth.paths.kernels.panel import STATE, new_panel
from nonsmooth.paths.schemes import strang
from nonsmooth.scenes import equations
from nonsmooth.scenes.penalties import n
from nonsmooth.scenes.symbols import eta, x, y, zeta

ROOT = Path(__file__).parents[1]
TRACKED = (
    "Snakefile",
    "benchmarks",
    "config.yaml",
    "config",
    "workflow",
    "src",
    "paper",
    "profiles",
    "studies",
    "docs/speed_pde.pdf",
    "docs/speed_crossing.pdf",
    "environment-lock.txt",
    "pyproject.toml",
)


def one_step(scene, z, h, normals=(0.0, 0.0)):
    """State after one step of the default splitting from z, on the given normal numbers."""
    s = strang.coefficients(scene, h, "float64")
    data = new_panel(scene, 0, 0, "float64").data
    data[list(STATE), 0], data[:2, 0] = z, normals
    strang.flow(s, data, True, False, 1)
    strang.kick(s, data, 0, 1)
    strang.flow(s, data, False, True, 1)
    return data[list(STATE), 0]


def coarse_ordinates(scene, change=None):
    """Grid of a scene with two variables for the kinetic equation; Gibbs weights for obstacles."""
    ends = boxed(scene)
    if scene.model == "obstacle":
        level = GibbsLevel(12, 5, (0.3, 1.0), (0.5, 1.0), 1e-5)
        return gibbs_ordinates(scene, ends, level, change)
    level = PlaneLevel(4, (4, 9.0), (9, ()), 3, 8.0, 0.1, 1e-5)
    return plane_ordinates(scene, ends, level, 1.0, change)


class Repository:
    """A copy of the repository and the snakemake of this environment."""

    def __init__(self, folder):
        self.folder = folder

    def snakemake(self, *arguments):
        """Run snakemake with the smoke configuration; return the finished process."""
        kernels = {"NUMBA_CACHE_DIR": str(ROOT / "src" / "nonsmooth" / "__pycache__")}
        return forked_snakemake.run(
            self.folder,
            ["--configfile", "config/smoke.yaml", *arguments],
            os.environ | kernels,  # copies share what they compiled
            timeout=600,  # against a hang; a busy machine takes several times the usual
        )

    def jobs(self, *targets):
        """Dry-run; return the rules that would run and how often."""
        run = self.snakemake("--cores", "1", "--dry-run", "--", *targets)
        assert run.returncode == 0, run.stderr
        counts, inside = {}, False
        for line in run.stdout.splitlines() + run.stderr.splitlines():
            words = line.split()
            if words[:2] == ["job", "count"]:
                inside = True
            elif inside and len(words) == 2 and words[1].isdigit():
                if words[0] == "total":
                    break
                counts[words[0]] = int(words[1])
        counts.pop("all", None)
        return counts


def copy_repository(destination, *extra):
    """Copy what git tracks of the workflow, and more where it is asked for."""
    for name in (*TRACKED, *extra):
        source = ROOT / name if name in TRACKED else Path(name)
        if source.is_dir():
            skip = shutil.ignore_patterns("kernels-*", "*.pdf", "*.egg-info")
            shutil.copytree(source, destination / name, ignore=skip)
        else:
            (destination / name).parent.mkdir(exist_ok=True)
            shutil.copy2(source, destination / name)
    return Repository(destination)


def specialised(expression, scene):
    """Replace the undefined functions of `equations` by a scene's own, but not the symbol C_b."""
    model, noise = scene.mechanics, scene.noise
    own = {
        equations.U(x): scene.potential_expression + model.added_potential,
        equations.f_y(y): model.velocity_penalty,
        equations.f_x(x): model.displacement_penalty,
    }
    if noise.kind == "langevin":
        own[equations.v(eta)] = noise.potential_expression
    elif noise.kind == "hamiltonian":
        own |= {equations.H(eta, zeta): noise.energy, equations.F(eta, zeta): noise.dissipation}
    return expression.subs(own).doit().subs(n, sympy.Float(scene.n))
