"""Collect the numbers that the text of the paper quotes."""

import json

from reproduction.jobs.files import whole
from reproduction.jobs.job import inputs, job
from reproduction.paper_values import paper_values

if __name__ == "__main__":
    with job(snakemake.log[0]):
        result = paper_values(inputs(snakemake), dict(snakemake.params.items()))
        with whole(snakemake.output[0]) as partial:
            partial.write_text(json.dumps(result, indent=1), encoding="utf-8")
