"""The answers of some scenes to one question of a study.

Answers are kept beside the batches, so that a changed study computes what is new alone.
"""

from pathlib import Path

from reproduction.jobs.job import produce
from studies.answers import answer_batch

if __name__ == "__main__":
    produce(
        answer_batch,
        snakemake,
        store=Path(snakemake.output[0]).parents[2] / "store",
        sources=sorted({*snakemake.input.modules, *snakemake.input.asked}),
        threads=snakemake.threads,
    )
