# What all rules share, written once: paths, parameters by look-up, and what `complete` adds.
import re
from functools import partial


pathvars:
    results=config["outputs"]["results"],
    logs="<results>/logs",
    benchmarks="<results>/benchmarks",


# no output may be empty
outputflags:
    partial(ensure, non_empty=True),


def own(path):
    """Name a file of this repository, also where another workflow uses it as a module."""
    return path if Path.cwd() == ROOT else str(ROOT / path)


def settings(section, *keys, **renamed):
    """Look up keys of a section of the configuration; a rule reruns only if one of these changes.

    The section may contain wildcards. A parameter with another name than its key is given as
    name="key".
    """
    keys = {key: key for key in keys} | renamed
    # lookup walks all that it looks within
    topic, *inner = section.split("/")
    return {
        name: lookup("/".join([*inner, key]), within=config[topic]) for name, key in keys.items()
    }


def number(wildcard):
    """Read a wildcard as a number."""
    return lambda wildcards: float(wildcards[wildcard])


def figure(name, caption=None):
    """Name the files of a figure, which the report shows with its caption."""
    files = multiext(f"<results>/figures/{name}", ".pdf", ".png")
    return report(files, caption=f"../report/{caption or name}.rst", category="Figures")


def table(name):
    """Name the files of a table."""
    return multiext(f"<results>/tables/{name}", ".csv", ".tex", ".typ")


def complete(job):
    """Add to a rule with a script what follows from its docstring, its script and its output.

    The docstring is the message. The modules that the script imports become inputs. The log and
    the benchmark of <results>/topic/name.nc are <logs>/topic/name.log and
    <benchmarks>/topic/name.tsv. Tables and checks take a second or two and are no jobs for a
    cluster.
    """
    if job.script is None:
        return
    job.message = job.message or job.docstring
    # snakemake sets these three only if the rule itself declares an input, a log and a benchmark
    job.input_modifier = job.log_modifier = job.benchmark_modifier = job.output_modifier
    modules = sources(f"workflow/{job.script.removeprefix('../')}")
    job.set_input(modules=[own(module) for module in modules])
    # the paper may lie elsewhere
    prefix = workflow.modifier.path_modifier.prefix or ""
    output, results = Path(job.output[0]), Path(prefix, config["outputs"]["results"])
    inside = output.is_relative_to(results)
    name = (output.relative_to(results) if inside else Path("paper", output.name)).with_suffix("")
    job.set_log(f"<logs>/{name}.log")
    job.benchmark = f"<benchmarks>/{name}.tsv"
    job.conda_env = "../envs/environment.yaml"
    if re.search("(^|_)(table|check)_", job.name):  # a module's rules may have a prefix
        workflow.localrules(job.name)
