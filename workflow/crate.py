"""Pack a finished run with its provenance: a Provenance Run RO-Crate, as one zip file.

Run from the root of the repository with the environment of `make checkers`. What was made by
which rule, from what and when, is read from the records that snakemake keeps in
`.snakemake/metadata`; every input is compared with the checksum that it had when it was used.
"""

import argparse
import base64
import hashlib
import json
import mimetypes
import os
import re
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import yaml
from rocrate.model import ComputationalWorkflow, ContextEntity, SoftwareApplication
from rocrate.rocrate import ROCrate

RECORDS = Path(".snakemake/metadata")
LOCK = Path("environment-lock.txt")
WORKFLOW = Path("Snakefile")
ABOUT = ("README.md", "CITATION.cff", "LICENSE", "pyproject.toml", str(LOCK))
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/ro/wfrun/provenance/0.5": "Provenance Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
TERMS = "https://w3id.org/ro/terms/workflow-run/context"
MEDIA = {".nc": "application/netcdf", ".yaml": "application/yaml", ".smk": "text/x-python"}


class CrateError(Exception):
    """A run that cannot be packed: one line that names the offender and the cure."""


@dataclass(frozen=True)
class Job:
    """What one job of the run did.

    Attributes
    ----------
    rule, script : str
    parameters : tuple of str
    inputs, outputs : tuple of str
        Paths from the root of the repository.
    start, end : float
        Seconds since 1970.
    """

    rule: str
    script: str
    parameters: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    start: float
    end: float


def jobs_of(target: str) -> list[Job]:
    """Follow a file back to the jobs that it comes from, in the order in which they ended.

    Raises
    ------
    CrateError
        If the run is not finished, or a file has changed since it was used.
    """
    records = _records()
    jobs, open_files, seen = {}, [target], set()
    while open_files:
        path = open_files.pop()
        if path in seen:
            continue
        seen.add(path)
        if not Path(path).exists():
            raise CrateError(f"{path} does not exist; run make paper first")
        record = records.get(path)
        if record is None:
            continue  # a source
        for used, checksum in record["input_checksums"].items():
            if f"sha256:{_sha256(used)}" != checksum:
                raise CrateError(f"{used} has changed since {path} was made; run make paper first")
        jobs.setdefault(tuple(record["log"]), []).append((path, record))
        open_files += record["input"]
    if not jobs:
        raise CrateError(f"snakemake has no record of how {target} was made; run make paper first")
    return sorted(map(_job, jobs.values()), key=lambda job: (job.end, job.outputs))


def _records():
    """Read the records of all outputs; their names are base64."""
    found = {}
    for path in RECORDS.glob("*"):
        if path.is_file():
            name = base64.urlsafe_b64decode(path.name).decode()
            found[name] = json.loads(path.read_text(encoding="utf-8"))
    return found


def _job(made):
    """Join the records of the outputs of one job, which differ in nothing but the output."""
    (_, record), outputs = made[0], sorted(path for path, _ in made)
    script = re.search(r'"\.\./(scripts/[^"]+)"', record["code"])
    return Job(
        record["rule"],
        f"workflow/{script[1]}",
        tuple(record["params"]),
        tuple(sorted(record["input"])),
        tuple(outputs),
        record["starttime"],
        record["endtime"],
    )


def crate_of(jobs: list[Job], target: str, config: str, agent: str) -> ROCrate:
    """Describe a run.

    Parameters
    ----------
    jobs : list of Job
    target : str
        The paper.
    config : str
        The configuration that was used besides `config.yaml`, or that file.
    agent : str
        Name of who ran it; empty if unknown.

    Returns
    -------
    ROCrate
    """
    citation = yaml.safe_load(Path("CITATION.cff").read_text(encoding="utf-8"))
    crate = ROCrate(version="1.1")
    crate.metadata.extra_contexts.append(TERMS)
    _describe(crate, citation, jobs)
    versions = _locked_versions(crate)
    main = _workflow(crate, citation, versions)
    made = {path for job in jobs for path in job.outputs}
    sources = {path for job in jobs for path in job.inputs} - made | {"config.yaml", config}
    files = {path: _file(crate, path) for path in sorted(made | sources)}
    for path in sorted({*ABOUT, *_program()} - files.keys()):
        _file(crate, path)
    crate.dereference("README.md")["about"] = crate.root_dataset
    main["hasPart"] = [crate.dereference(path) for path in _program() if path.endswith(".smk")]
    who = {"agent": {"@id": crate.add(_person(crate, agent)).id}} if agent else {}
    _actions(crate, jobs, files, who)
    run = crate.add_action(
        main,
        "#run",
        object=[files[path] for path in sorted(sources)],
        result=[files[target], *(files[path] for path in sorted(made - {target}))],
        properties={"name": "Run of the workflow"} | _times(jobs) | who,
    )
    engine = crate.dereference(f"https://pypi.org/project/snakemake/{versions['snakemake']}/")
    crate.add_action(
        engine,
        "#engine",
        object=[e for e in crate.contextual_entities if e.type == "ControlAction"],
        result=run,
        properties={"@type": "OrganizeAction", "name": "Run of snakemake"} | _times(jobs) | who,
    )
    crate.root_dataset["mentions"] = [
        e for e in crate.contextual_entities if e.type == "CreateAction"
    ]
    return crate


def _describe(crate, citation, jobs):
    """Fill in the root: title, authors, licence, profiles."""
    root = crate.root_dataset
    root["name"] = f"Run of {citation['title']}"
    root["description"] = (
        "All artifacts, figures, tables and the paper, with what made them. "
        + (citation["abstract"])
    )
    root["license"] = crate.add_jsonld(
        {
            "@id": f"https://spdx.org/licenses/{citation['license']}",
            "@type": "CreativeWork",
            "name": f"{citation['license']} licence",
        }
    )
    root["author"] = [
        crate.add_jsonld({"@id": f"#author-{k}", "@type": "Organization", "name": author["name"]})
        if "name" in author
        else crate.add(_person(crate, f"{author['given-names']} {author['family-names']}"))
        for k, author in enumerate(citation["authors"], 1)
    ]
    root["datePublished"] = _time(jobs[-1].end)
    root["keywords"] = ", ".join(citation["keywords"])
    root["conformsTo"] = [
        crate.add_jsonld(
            {"@id": uri, "@type": "CreativeWork", "name": name, "version": uri.rpartition("/")[2]}
        )
        for uri, name in PROFILES.items()
    ]


def _workflow(crate, citation, versions):
    main = crate.add_workflow(
        WORKFLOW,
        WORKFLOW.name,
        main=True,
        lang="snakemake",
        lang_version=versions["snakemake"],
        cls=ComputationalWorkflow,
        properties={
            "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"],
            "name": citation["title"],
            "version": str(citation["version"]),
            "sha256": _sha256(WORKFLOW),
        },
    )
    main["author"] = crate.root_dataset["author"]
    main["license"] = crate.root_dataset["license"]
    main["softwareRequirements"] = [
        e for e in crate.contextual_entities if e.type == "SoftwareApplication"
    ]
    return main


def _program():
    """Rules, scripts, schemas, environments and modules."""
    return [
        path.as_posix()
        for folder in (Path("src"), Path("workflow"))
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts and ".egg-info" not in path.as_posix()
    ]


def _locked_versions(crate):
    """Add the pinned packages; return their versions."""
    pinned = re.findall(r"^([\w.-]+)==([^\s;\\]+)", LOCK.read_text(encoding="utf-8"), re.MULTILINE)
    for name, version in pinned:
        url = f"https://pypi.org/project/{name}/{version}/"
        properties = {"name": name, "softwareVersion": version, "url": url}
        crate.add(SoftwareApplication(crate, url, properties=properties))
    return dict(pinned)


def _actions(crate, jobs, files, who):
    """Add a step for each rule, and for each job its run and the step's."""
    main = crate.mainEntity
    position = {rule: k for k, rule in enumerate(dict.fromkeys(job.rule for job in jobs), 1)}
    for job in jobs:
        tool = crate.dereference(job.script)
        step_id = f"{main.id}#{job.rule}"
        step = crate.dereference(step_id)
        if step is None:
            properties = {"@type": "HowToStep", "name": job.rule, "position": position[job.rule]}
            step = crate.add(ContextEntity(crate, step_id, properties=properties))
            step["workExample"] = tool
            main.append_to("step", step)
            if tool not in main.get("hasPart", []):
                main.append_to("hasPart", tool)
        run = crate.add_action(
            tool,
            f"#run-of-{job.outputs[0]}",
            object=[files[path] for path in job.inputs],
            result=[files[path] for path in job.outputs],
            properties={
                "name": f"rule {job.rule}: {', '.join(job.outputs)}",
                "description": f"parameters: {'; '.join(job.parameters) or 'none'}",
            }
            | _times([job])
            | who,
        )
        crate.add_action(
            step,
            f"#step-of-{job.outputs[0]}",
            object=run,
            properties={"@type": "ControlAction", "name": f"orchestrate {job.rule}"},
        )


def _file(crate, path):
    suffix = Path(path).suffix
    media = MEDIA.get(suffix) or mimetypes.guess_type(path)[0] or "text/plain"
    properties = {"name": path, "sha256": _sha256(path), "encodingFormat": media}
    if suffix in {".py", ".smk"}:
        properties["@type"] = ["File", "SoftwareSourceCode"]
    return crate.add_file(path, path, properties=properties, record_size=True)


def _person(crate, name):
    identifier = "#" + re.sub(r"\W+", "-", name)
    return ContextEntity(crate, identifier, properties={"@type": "Person", "name": name})


def _times(jobs):
    return {
        "startTime": _time(min(job.start for job in jobs)),
        "endTime": _time(max(job.end for job in jobs)),
    }


def _time(seconds):
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="seconds")


def _sha256(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def _outputs(config):
    """Where the run wrote, by its own configuration over the default one."""
    layers = [yaml.safe_load(Path(p).read_text("utf-8")) for p in ("config.yaml", config)]
    return layers[0]["outputs"] | layers[1].get("outputs", {})


def main() -> int:
    """Read the command line and write the crate."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default="config.yaml", help="configuration of the run")
    parser.add_argument("--agent", default="", help="who ran it")
    arguments = parser.parse_args()
    try:
        outputs = _outputs(arguments.config)
        path = Path(outputs["results"]) / "crate.zip"
        jobs = jobs_of(outputs["paper"])
        crate = crate_of(jobs, outputs["paper"], arguments.config, arguments.agent)
        partial = path.with_name(".crate.partial.zip")
        try:
            crate.write_zip(partial)
            os.replace(partial, path)
        finally:
            partial.unlink(missing_ok=True)
    except (CrateError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print(f"{path}: {len(jobs)} jobs, {path.stat().st_size / 1e6:.0f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
