# Studies: tables of scenes and questions of users, from a file to a report. They are not part of the
# paper: `snakemake --cores 2 study_NAME`.

STUDIES = Studies(config.get("studies", {}), own("studies"))

try:
    # the targets; snakemake itself tells them only after this file
    STUDIES.check(sys.argv[1:])
except ConfigError as error:
    sys.exit(f"error: {error}")


rule study_answer:
    """Answer {wildcards.question} of {wildcards.case}, study {wildcards.study}"""
    input:
        asked=STUDIES.modules,
    output:
        "<results>/studies/{study}/{case}/{question}.nc",
    params:
        scene=STUDIES.having("scenes", "case"),
        question=STUDIES.having("questions", "question"),
        units=STUDIES.having("units"),
        seed=STUDIES.having("seed"),
    script:
        "../scripts/studies/answer.py"


rule study_batch:
    """Answer {wildcards.question} of batch {wildcards.batch}, study {wildcards.study}"""
    input:
        asked=STUDIES.modules,
    output:
        "<results>/studies/{study}/batches/{question}/{batch}.nc",
    params:
        scenes=lambda wildcards: STUDIES.get(wildcards.study).of_batch(int(wildcards.batch)),
        question=STUDIES.having("questions", "question"),
        units=STUDIES.having("units"),
        seed=STUDIES.having("seed"),
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
        templates=[own("workflow/templates/study.html"), own("workflow/templates/study.typ")],
    output:
        multiext("<results>/studies/{study}/report", ".html", ".pdf"),
    params:
        name="{study}",
        content=STUDIES.having("content"),
        folder=STUDIES.having("folder"),
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
