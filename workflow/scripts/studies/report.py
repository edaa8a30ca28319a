"""The report of a study, as HTML and as PDF."""

from pathlib import Path

from reproduction.jobs.files import write_whole
from reproduction.jobs.job import job
from studies.report import as_html, as_pdf, contents
from studies.study import Study

if __name__ == "__main__":
    with job(snakemake):
        params, templates = snakemake.params, snakemake.input.templates
        study = Study(params.name, params.content, Path(params.folder))
        # <results>/studies/<name>/report.html
        content = contents(study, Path(snakemake.output[0]).parents[2])
        write_whole(snakemake.output[0], as_html(content, templates[0]))
        write_whole(snakemake.output[1], as_pdf(content, templates[1]))
