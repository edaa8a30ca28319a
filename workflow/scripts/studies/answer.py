"""One answer of a study: a question about a scene."""

from reproduction.jobs.job import produce
from studies.answers import answer

if __name__ == "__main__":
    produce(answer, snakemake, threads=snakemake.threads)
