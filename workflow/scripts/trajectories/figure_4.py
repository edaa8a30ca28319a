"""Figure 4: trajectories of the obstacle model."""

from reproduction.plots import draw, trajectory

# the paper's axes
LIMITS = {"Y": (-2, 1.75), "X": (-4, 1.5), "phase": ((-4, 1.5), (-2, 1.25))}


def figure(trajectories):
    """Draw Y(t), X(t) and the phase portrait.

    Returns
    -------
    matplotlib.figure.Figure
    """
    return trajectory(trajectories, LIMITS)


if __name__ == "__main__":
    draw(figure, snakemake)
