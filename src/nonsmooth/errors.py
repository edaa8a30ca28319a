"""The errors a user can cause: each message is one line that says what is wrong and what helps."""


class NonsmoothError(Exception):
    """Base of every error whose message is meant for the user and needs no traceback."""


class ExpressionError(NonsmoothError):
    """A potential, Hamiltonian or observable that cannot be read."""


class SceneError(NonsmoothError):
    """A scene that is impossible, or outside the theory or the method asked for."""


class AssumptionWarning(UserWarning):
    """A scene that can be computed but that the paper's theorems do not cover."""


class ToleranceError(NonsmoothError):
    """A tolerance that the method could not meet."""
