"""Typeset the paper."""

import os
from pathlib import Path

import typst

from reproduction.errors import ArtifactError
from reproduction.jobs.files import write_whole
from reproduction.jobs.job import job, require_as_written


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
    try:
        content = typst.compile(
            template,
            root=root,
            format="pdf",
            ignore_system_fonts=True,
            sys_inputs={"results": folder},
        )
    except typst.TypstError as error:
        raise ArtifactError(f"{template} does not compile: {error}; mend the template") from None
    write_whole(output, content)


def require_whole(paths, results):
    """Stop if a figure, a table or a number was damaged or changed since it was made.

    Parameters
    ----------
    paths : iterable of str
    results : str
    """
    for path in paths:
        name = Path(path).relative_to(results).with_suffix(".log")
        require_as_written(path, Path(results) / "logs" / name)


if __name__ == "__main__":
    with job(snakemake):
        results, source = snakemake.params.results, snakemake.input
        require_whole((*source.figures, *source.tables, source.values), results)
        compile_paper(source.template, results, snakemake.output[0])
