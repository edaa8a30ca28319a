"""Files that are written whole or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from reproduction.errors import ArtifactError


@contextmanager
def whole(path: str | Path) -> Iterator[Path]:
    """Yield a temporary name in the folder of `path`; move it into place if the body succeeds.

    Parameters
    ----------
    path : str or Path

    Yields
    ------
    Path
        With the suffix of `path`.

    Raises
    ------
    ArtifactError
        If the file cannot be written.
    """
    path = Path(path)
    partial = path.with_name(f".{path.stem}.partial{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield partial
        with open(partial, "rb") as file:
            os.fsync(file.fileno())
        os.replace(partial, path)
    except OSError as error:
        raise ArtifactError(
            f"cannot write {path} ({error.strerror or error}); make its folder writable"
        ) from None
    finally:
        if path.parent.is_dir():
            partial.unlink(missing_ok=True)
