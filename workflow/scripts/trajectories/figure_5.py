"""Figure 5: trajectories of the friction model."""

from reproduction.plots import draw, trajectory

# the paper's axes
LIMITS = {"Y": (-1.75, 1.75), "X": (-8, 1), "phase": ((-7, 2), (-1.75, 1.75))}


def figure(trajectories):
    """Draw Y(t), X(t) and the phase portrait.

    Returns
    -------
    matplotlib.figure.Figure
    """
    return trajectory(trajectories, LIMITS)


if __name__ == "__main__":
    draw(figure, snakemake)
