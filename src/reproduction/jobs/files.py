"""Files that are written whole or not at all."""

import errno
import os
import shutil
from pathlib import Path

from reproduction.errors import ArtifactError

_CURES = {
    errno.EDQUOT: "your quota there is used up; free some of it",
    errno.EFBIG: "raise the limit on the size of files (ulimit -f)",
    errno.EROFS: "its disk can only be read; set outputs to a folder on another",
    errno.EISDIR: "remove the folder of this name",
    errno.ENOTDIR: "remove the file that is in the place of its folder",
    errno.EEXIST: "remove the file that is in the place of its folder",
    errno.EIO: "the disk fails; set outputs to a folder on another",
    errno.ENAMETOOLONG: "set outputs to a folder with a shorter name",
}


def write_whole(path: str | Path, content: bytes) -> None:
    """Write a file under a temporary name in the same folder, and then move it into place.

    Parameters
    ----------
    path : str or Path
    content : bytes

    Raises
    ------
    ArtifactError
        If the file cannot be written; the cure depends on the reason.
    """
    path = Path(path)
    # a job that survived its killed workflow may write the same file
    partial = path.with_name(f".{path.stem}.{os.getpid()}.partial{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with open(partial, "wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(partial, path)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        wanted = f", {len(content)} bytes" if error.errno == errno.ENOSPC else ""
        raise ArtifactError(
            f"cannot write {path}{wanted} ({error.strerror or error}); {_cure(error, path)}"
        ) from None


def _cure(error, path):
    if error.errno == errno.ENOSPC:
        folder = next(p for p in path.absolute().parents if p.is_dir())
        free = shutil.disk_usage(folder).free
        return f"{free} bytes are free in {folder}; free space there"
    return _CURES.get(error.errno, "make its folder writable")
