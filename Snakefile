# The pipeline: config -> scenes -> solve / simulate -> artifacts -> figures, tables -> paper.
# This file validates the configuration, includes the rules and names the targets.
import sys
from pathlib import Path

from reproduction.configuration.layers import Layers
from reproduction.errors import ConfigError
from workflow.checks.configuration import check

# config.yaml, then what the command line lays over it, or the workflow of which this is a module
given, module = workflow.config_settings, not workflow.modifier.is_main_snakefile()
ROOT = Path(workflow.current_basedir.get_path_or_uri(secret_free=False)).resolve()
defaults = [] if given.replace_workflow_config and not module else [ROOT / "config.yaml"]
files = [] if module else workflow.overwrite_configfiles
try:
    layers = Layers.of_files([*defaults, *files], config if module else given.config)
    check(layers)
except ConfigError as error:
    sys.exit(f"error: {error}")

# what is refused need not wait for these
from workflow.dependencies import sources
from workflow.experiment import (
    ergodic_scenes,
    finite,
    halving_paths,
    label,
    part,
    rare,
    shards,
    step_at,
    swept,
)
from workflow.failures import hints
from workflow.forked_jobs import fork_scripts
from workflow.studies import Studies

if module:
    config.update(layers.merged)
else:

    configfile: "config.yaml"


PAPER = config["outputs"]["paper"]


wildcard_constraints:
    model="elasto_plastic|friction|obstacle",
    n="[0-9.e+-]+|inf",
    p="[0-9.e+-]+",
    limit="[0-9.e+-]+",
    shard="[0-9]+",
    scene="[a-z0-9_]+",
    diagram="[a-z0-9_]+",
    study="[a-z0-9_]+",
    question="[a-z0-9_]+",
    case="[^/]+",
    batch="[0-9]+",


rule all:
    input:
        PAPER,


include: "workflow/rules/common.smk"
include: "workflow/rules/scenes.smk"
include: "workflow/rules/rheology.smk"
include: "workflow/rules/trajectories.smk"
include: "workflow/rules/variance.smk"
include: "workflow/rules/crossing.smk"
include: "workflow/rules/finite_p.smk"
include: "workflow/rules/convergence.smk"
include: "workflow/rules/gamma2.smk"
include: "workflow/rules/sweep.smk"
include: "workflow/rules/rare_crossings.smk"
include: "workflow/rules/theorems.smk"
include: "workflow/rules/errata.smk"
include: "workflow/rules/density.smk"
include: "workflow/rules/limit_theorem.smk"
include: "workflow/rules/plasticity.smk"
include: "workflow/rules/hard_cases.smk"
include: "workflow/rules/rates.smk"
include: "workflow/rules/paper.smk"
include: "workflow/rules/speed_against_error.smk"
include: "workflow/rules/studies.smk"


for job in workflow.rules:
    if Path(str(job.snakefile)).is_relative_to(ROOT):
        complete(job)


onstart:
    # There is no limit of jobs per second. With one, snakemake looks at all that waits once more a
    # second after each look, which every finished job adds to: it would take half a core.
    workflow.scheduler.job_rate_limiter = None
    # the server takes as long to start as three jobs
    many = sum(job.rule.script is not None for job in workflow.dag.needrun_jobs()) > 6
    if many and sys.platform == "linux" and workflow.is_main_process:
        fork_scripts()


onerror:
    for line in hints(log):
        print(line, file=sys.stderr)
