"""Typeset the paper."""

import os
from pathlib import Path

import typst

from reproduction.errors import ArtifactError
from reproduction.jobs.files import whole
from reproduction.jobs.job import job


def compile_paper(template, results, output):
    """Compile the manuscript with the figures, tables and numbers of a results folder.

    Parameters
    ----------
    template, output : str
    results : str
        Folder below the repository.

    Raises
    ------
    ArtifactError
        If the manuscript does not compile.
    """
    root = os.path.commonpath([Path.cwd(), Path(results).resolve()])
    folder = "/" + Path(results).resolve().relative_to(root).as_posix()
    with whole(output) as partial:
        try:
            typst.compile(
                template,
                output=str(partial),
                root=root,
                format="pdf",
                ignore_system_fonts=True,
                sys_inputs={"results": folder},
            )
        except typst.TypstError as error:
            raise ArtifactError(
                f"{template} does not compile: {error}; mend the template"
            ) from None


if __name__ == "__main__":
    with job(snakemake.log[0]):
        compile_paper(snakemake.input.template, snakemake.params.results, snakemake.output[0])
