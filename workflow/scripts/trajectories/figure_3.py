"""Figure 3: trajectories of the elasto-plastic model."""

from reproduction.plots import draw, trajectory

# the paper's axes
LIMITS = {"Y": (-6, 4), "X": (-4, 2), "phase": ((-3.5, 1.5), (-6, 2))}


def figure(trajectories):
    """Draw Y(t), X(t) and the phase portrait.

    Returns
    -------
    matplotlib.figure.Figure
    """
    return trajectory(trajectories, LIMITS)


if __name__ == "__main__":
    draw(figure, snakemake)
