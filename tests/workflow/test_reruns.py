"""What a change makes run again, and what it does not: dry runs after a whole run."""

import pytest


def edit(path, old, new):
    """Replace text in a file."""
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_touching_modules_reruns_nothing(finished):
    """Inputs are compared by content."""
    for path in finished.folder.glob("src/**/*.py"):
        path.touch()
    assert finished.jobs() == {}


def test_a_plotting_script_reruns_its_figure_and_the_paper(finished):
    """Nothing is recomputed."""
    script = finished.folder / "workflow/scripts/crossing/figure_2b.py"
    edit(script, 'loc="lower right"', 'loc="center right"')
    assert finished.jobs() == {"figure_2b": 1, "paper": 1}


def test_a_new_n_is_solved_alone(finished):
    """Adding an n to the table's list."""
    edit(
        finished.folder / "config/smoke.yaml",
        "n: [2, .inf]\n  finite",
        "n: [2, 7, .inf]\n  finite",
    )
    assert finished.jobs() == {
        "convergence_spectral": 1,
        "convergence_finite_difference": 1,
        "check_convergence": 1,
        "table_4": 1,
        "values": 1,
        "paper": 1,
    }


@pytest.mark.slow
def test_the_threshold_reruns_the_crossings_only(finished):
    """Changing b."""
    edit(finished.folder / "config.yaml", "threshold: 0.6\n  p:", "threshold: 0.7\n  p:")
    jobs = finished.jobs()
    assert {name for name in jobs if name.startswith("crossing")} == {
        "crossing_shard",
        "crossing_halving",
        "crossing_monte_carlo",
        "crossing_asymptotic",
    }
    rest = {name for name in jobs if not name.startswith("crossing")}
    assert rest == {
        *("check_crossing", "figure_2b", "table_time_step", "values", "paper"),
        *("finite_p_exact", "check_finite_p", "finite_p_formulas", "figure_10", "table_9"),
    }


def test_more_paths_run_new_shards_only(finished):
    """The old shards stay as they are."""
    edit(finished.folder / "config/smoke.yaml", "paths: 20_000, shard", "paths: 30_000, shard")
    jobs = finished.jobs()
    assert jobs["variance_shard"] == 1
    assert "crossing_shard" not in jobs


def test_a_module_reruns_exactly_the_rules_that_use_it(finished):
    """finite_differences.py is imported by three compute scripts; its results feed the rest."""
    with open(finished.folder / "src/nonsmooth/line/finite_differences.py", "a") as file:
        file.write("# changed\n")
    jobs = finished.jobs()
    assert jobs == {
        "variance_finite_difference": 1,
        "convergence_finite_difference": 1,
        "check_variance": 1,
        "check_convergence": 1,
        "figure_2a": 1,
        "table_4": 1,
        "errata": 1,
        "table_errata": 1,
        "values": 1,
        "paper": 1,
    }


@pytest.mark.slow
def test_a_module_is_followed_through_other_modules(finished):
    """exact_flows.py is imported by the splitting only, which every simulation uses."""
    with open(finished.folder / "src/nonsmooth/paths/kernels/exact_flows.py", "a") as file:
        file.write("# changed\n")
    jobs = finished.jobs()
    simulations = {"trajectories", "variance_shard", "variance_halving", "crossing_shard"}
    assert simulations <= jobs.keys()
    untouched = {
        "variance_finite_difference",
        "convergence_finite_difference",
        "table_1",
        "figure_1",
    }
    assert not untouched & jobs.keys()


@pytest.mark.slow
def test_the_template_reruns_the_paper_only(finished):
    """Changing a sentence."""
    edit(finished.folder / "paper/paper.typ", "= Trajectories", "= Some trajectories")
    assert finished.jobs() == {"paper": 1}


def test_named_targets(repository):
    """Each exists."""
    names = [
        *(f"figure_{k}" for k in ("1", "2a", "2b", "3", "4", "5", "6", "8", "9")),
        *("figure_10", "figure_12", "table_7b", "table_9", "table_10", "hard_cases"),
        *("figure_13", "table_11", "table_12"),
        *(f"table_{k}" for k in range(1, 5)),
        *("table_5", "table_potentials", "table_6", "table_7", "table_errata"),
        *("figures", "tables", "paper"),
    ]
    assert set(names) <= repository.jobs(*names).keys()


@pytest.mark.parametrize(
    ("target", "jobs"),
    [("table_2", {"table_2": 1}), ("figure_3", {"trajectories": 1, "figure_3": 1})],
)
def test_a_named_target_does_its_own_work_only(repository, target, jobs):
    """Nothing else is computed."""
    assert repository.jobs(target) == jobs


@pytest.mark.slow
def test_an_interrupted_run_is_resumed_to_the_same_bytes(smoke_run):
    """A lost shard, and what was made of it, come back as they were."""
    lost = [
        smoke_run.folder / "results/smoke/variance" / name
        for name in ("shards/1.nc", "monte_carlo.nc")
    ]
    before = [path.read_bytes() for path in lost]
    for path in lost:
        path.unlink()
    run = smoke_run.snakemake("--cores", "1", "--", "results/smoke/variance/monte_carlo.nc")
    assert run.returncode == 0, run.stderr[-2000:]
    assert [path.read_bytes() for path in lost] == before


@pytest.mark.slow
def test_a_new_p_of_the_sweep_is_simulated_alone(finished):
    """One job, for there is one scene."""
    edit(
        finished.folder / "config/smoke.yaml",
        "  p: [1, 10]\n  outputs: 8",
        "  p: [1, 10, 20]\n  outputs: 8",
    )
    jobs = finished.jobs()
    assert {name for name in jobs if name.startswith("sweep")} == {"sweep_crossing"}
    assert jobs["sweep_crossing"] == 1


@pytest.mark.slow
def test_a_new_limit_of_the_deformation_is_simulated_alone(finished):
    """gamma^2 is not computed again."""
    edit(finished.folder / "config/smoke.yaml", "limits: [4]", "limits: [4, 6]")
    assert finished.jobs() == {
        "plasticity_crossing": 1,
        "check_plasticity": 1,
        "figure_9": 1,
        "values": 1,
        "paper": 1,
    }


def test_gamma_does_not_rerun_the_samples_of_the_limit_theorem(finished):
    """sampled_gamma2.py gives gamma^2; the samples are divided by it afterwards."""
    with open(finished.folder / "src/nonsmooth/statistics/sampled_gamma2.py", "a") as file:
        file.write("# changed\n")
    jobs = finished.jobs()
    assert jobs["sweep_variance"] == 1
    assert jobs["check_limit_theorem"] == 1
    assert "limit_theorem_samples" not in jobs
