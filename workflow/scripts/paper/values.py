"""Collect the numbers that the text of the paper quotes: as spelt, and with their errors."""

import json

from reproduction.jobs.files import write_whole
from reproduction.jobs.job import inputs, job
from reproduction.paper_values import paper_values
from reproduction.rendering.quoted import Quoted, leaves

if __name__ == "__main__":
    with job(snakemake):
        result = paper_values(inputs(snakemake), dict(snakemake.params.items()))
        numbers = {
            name: {"text": text} | vars(text) if isinstance(text, Quoted) else text
            for name, text in leaves(result).items()
        }
        for path, content in zip(snakemake.output, (result, numbers), strict=True):
            write_whole(path, json.dumps(content, indent=1).encode())
