"""Slow modes of a large operator whose inverse is known only approximately, by Davidson's method.

The inverse is projected on a growing space of images A v, where it is exact: it takes A v to v. The
space grows by preconditioned residuals, so that no equation need be solved accurately. See
R. B. Morgan, Generalizations of Davidson's method for computing eigenvalues of large nonsymmetric
matrices, J. Comput. Phys. 101 (1992), and its harmonic projection in Linear Algebra Appl. 154-156
(1991).
"""

import math
from collections.abc import Callable

import numpy as np
import scipy.linalg

# chosen: of a vector that is no more than this after it is made orthogonal, rounding is left
ROUNDING = 1e-12


def slow_rates(
    apply: Callable[[np.ndarray], np.ndarray],
    precondition: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    wanted: int,
    accuracy: float,
    *,
    known: float,
    room: int,
    most: int,
    slower: float = math.inf,
) -> np.ndarray:
    """Compute eigenvalues of small modulus of a real operator, one of them accurately.

    Parameters
    ----------
    apply : callable
        Takes a vector, returns its image.
    precondition : callable
        Applies roughly the inverse.
    start : numpy.ndarray, shape (n,)
        The space begins with what the preconditioner makes of it.
    wanted : int
        Number of eigenvalues, of the least modulus; one more if that would divide a complex pair.
    accuracy : float
        Relative to the modulus, of the eigenvalue with the smallest real part: its residual times
        its condition number, which is taken from the projected inverse and may be too small.
    known : float
        Residual of the others, relative; their conditions do not count.
    room : int
        Number of vectors that are kept, more than twice `wanted`; each takes 2 n numbers.
    most : int
        Number of vectors that are tried.
    slower : float
        If the smallest real part is not below this, `known` is its accuracy, too.

    Returns
    -------
    numpy.ndarray, complex
        The eigenvalues, by increasing real part.

    Raises
    ------
    numpy.linalg.LinAlgError
        If `most` vectors are not enough, or the preconditioner leads to too few.
    """
    space = _Space(len(start), room)
    vector = start
    for _ in range(2 * wanted):
        vector = precondition(vector / np.linalg.norm(vector))
        space.add(vector, apply(vector))
    tried = space.size
    while tried < most and space.size > wanted:
        inverses, modes, conditions = space.modes(wanted)
        order = np.argsort((1 / inverses).real, kind="stable")
        rates = 1 / inverses[order]
        aim = accuracy if rates[0].real < slower else known
        # a double eigenvalue without a second mode has no condition; it moves like a square root
        needed = max(aim / conditions[order[0]], aim**2)
        residual = _too_large(space, inverses[order], modes[:, order], needed, known)
        if residual is None:
            return rates
        parts = [residual.real, residual.imag] if residual.imag.any() else [residual.real]
        if space.size + len(parts) > room:
            space.reduce(room // 2)
        for part in parts:
            vector = precondition(part / np.linalg.norm(part))
            space.add(vector, apply(vector))
        tried += len(parts)
    raise np.linalg.LinAlgError(f"the slow modes were not found among {most} vectors")


def _too_large(space, inverses, modes, accuracy, known):
    """Return the first residual that is too large, or None; one of a complex pair is enough."""
    for k, (inverse, mode) in enumerate(zip(inverses, modes.T, strict=True)):
        if k and np.isclose(inverse, inverses[k - 1].conj(), rtol=1e-10, atol=0.0):
            continue
        residual = space.residual(inverse, mode)
        if np.linalg.norm(residual) > (known if k else accuracy):
            return residual
    return None


class _Space:
    """Vectors and their images; the latter are orthonormal.

    Parameters
    ----------
    length : int
        Of a vector.
    room : int
        Largest number of vectors.

    Attributes
    ----------
    size : int
        Number of vectors.
    """

    def __init__(self, length: int, room: int):
        self.size = 0
        self._vectors = np.empty((room, length))
        self._images = np.empty((room, length))
        self._inverse = np.empty((room, room))

    def add(self, vector: np.ndarray, image: np.ndarray) -> None:
        """Add a vector and its image, made orthogonal to the others; none if nothing is left."""
        k, whole = self.size, np.linalg.norm(image)
        for _ in range(2):  # once is not enough where little is left
            along = self._images[:k] @ image
            image = image - along @ self._images[:k]
            vector = vector - along @ self._vectors[:k]
        norm = np.linalg.norm(image)
        if norm <= ROUNDING * whole:
            return
        self._vectors[k], self._images[k] = vector / norm, image / norm
        self._inverse[: k + 1, k] = self._images[: k + 1] @ self._vectors[k]
        self._inverse[k, :k] = self._vectors[:k] @ self._images[k]
        self.size = k + 1

    def modes(self, wanted: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the largest eigenvalues of the projected inverse, eigenvectors and conditions.

        Eigenvectors are columns; a condition number tells how far errors move an eigenvalue.
        """
        k = self.size
        values, left, vectors = scipy.linalg.eig(self._inverse[:k, :k], left=True)
        order = np.argsort(-np.abs(values), kind="stable")
        last, following = values[order[wanted - 1 : wanted + 1]]
        divided = last.imag and np.isclose(last, following.conj(), rtol=1e-10, atol=0.0)
        taken = order[: wanted + 1 if divided else wanted]
        with np.errstate(divide="ignore"):
            conditions = 1 / np.abs(np.sum(left[:, taken].conj() * vectors[:, taken], axis=0))
        return values[taken].astype(complex), vectors[:, taken].astype(complex), conditions

    def residual(self, inverse: complex, mode: np.ndarray) -> np.ndarray:
        """Return A u - u / inverse for a mode, with |A u| = 1."""
        weights = np.stack([mode.real, mode.imag])
        image = weights @ self._images[: self.size]
        vector = weights @ self._vectors[: self.size]
        return image[0] + 1j * image[1] - (vector[0] + 1j * vector[1]) / inverse

    def reduce(self, size: int) -> None:
        """Keep the largest modes of the inverse."""
        _, modes, _ = self.modes(size)
        real = np.concatenate([modes.real, modes.imag], axis=1)
        basis, weights, _ = np.linalg.svd(real, full_matrices=False)
        # of a complex pair both have the same parts
        basis = basis[:, weights > 1e-10 * weights[0]]
        k, size = self.size, basis.shape[1]
        self._vectors[:size] = basis.T @ self._vectors[:k]
        self._images[:size] = basis.T @ self._images[:k]
        self._inverse[:size, :size] = basis.T @ self._inverse[:k, :k] @ basis
        self.size = size
