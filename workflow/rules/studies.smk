# Studies: tables of scenes and questions of users, from a file to a report. They are not part of the
# paper: `snakemake --cores 2 study_NAME`.

STUDIES = Studies(config.get("studies", {}))

try:
    STUDIES.check(getattr(workflow.dag_settings, "targets", ()))
except ConfigError as error:
    sys.exit(f"error: {error}")


def of_study(*keys):
    """Look up what a study has, such as its questions, by wildcards."""

    def found(wildcards):
        value = getattr(STUDIES.get(wildcards.study), keys[0])
        for key in keys[1:]:
            value = value[wildcards[key]]
        return value

    return found


rule study_answer:
    """Answer {wildcards.question} of {wildcards.case}, study {wildcards.study}"""
    output:
        "<results>/studies/{study}/{case}/{question}.nc",
    params:
        scene=of_study("scenes", "case"),
        question=of_study("questions", "question"),
        units=of_study("units"),
        seed=of_study("seed"),
    script:
        "../scripts/studies/answer.py"


rule study_batch:
    """Answer {wildcards.question} of batch {wildcards.batch}, study {wildcards.study}"""
    output:
        "<results>/studies/{study}/batches/{question}/{batch}.nc",
    params:
        scenes=lambda wildcards: STUDIES.get(wildcards.study).of_batch(int(wildcards.batch)),
        question=of_study("questions", "question"),
        units=of_study("units"),
        seed=of_study("seed"),
    script:
        "../scripts/studies/batch.py"


rule study_report:
    """Render the report of the study {wildcards.study}"""
    input:
        answers=lambda wildcards: [
            f"<results>/studies/{wildcards.study}/{name}"
            for question in STUDIES.get(wildcards.study).questions
            for name in STUDIES.get(wildcards.study).artifacts(question)
        ],
        templates=expand("workflow/templates/study.{format}", format=["html", "typ"]),
    output:
        multiext("<results>/studies/{study}/report", ".html", ".pdf"),
    params:
        name="{study}",
        content=of_study("content"),
        folder=of_study("folder"),
        results=config["outputs"]["results"],
    script:
        "../scripts/studies/report.py"


for name in STUDIES.names:

    rule:
        name:
            f"study_{name}"
        input:
            multiext(f"<results>/studies/{name}/report", ".html", ".pdf"),


rule studies:
    input:
        expand("<results>/studies/{study}/report.html", study=STUDIES.names),
