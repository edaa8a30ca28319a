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


def quoted(value: object, length: int = 80) -> str:
    """Quote what a user gave, for a message of one line.

    Parameters
    ----------
    value : object
        Text, whose white space becomes single blanks, or anything else, which is shown as `repr`
        shows it.
    length : int
        Most characters; what is longer is cut and ends with dots.

    Returns
    -------
    str
        In ASCII: other characters are escaped, so that look-alikes are told apart and every
        terminal can show them.
    """
    try:
        text = ascii(" ".join(value.split()) if isinstance(value, str) else value)
    except Exception:  # an object may fail in any way when it is asked for its repr
        text = object.__repr__(value)
    text = " ".join(text.split())
    end = text[-1] if isinstance(value, str) else ""
    return text if len(text) <= length else f"{text[: length - 3 - len(end)]}...{end}"
