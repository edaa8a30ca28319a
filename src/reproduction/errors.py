"""The errors of the workflow: each message is one line naming the offender and the cure."""

from nonsmooth.errors import NonsmoothError


class ConfigError(NonsmoothError):
    """A configuration that does not fit its schema."""


class ArtifactError(NonsmoothError):
    """A result file that is missing, truncated or not written by the workflow."""


class CheckError(NonsmoothError):
    """Results that contradict each other."""
