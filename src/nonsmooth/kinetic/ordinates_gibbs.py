"""Discrete ordinates of (y, x) with white noise, where all forces but damping have potentials.

The invariant density is then that of Gibbs, exp(-2 C_b (y^2/2 + U_n) / sigma^2). In the space of
functions weighted by it, noise and damping are symmetric and the motion is skew-symmetric. In
Hermite polynomials of y / s, s^2 = sigma^2 / (2 C_b), the motion raises a degree by s d_x and
lowers it by s d_x - U_n' / s, which is minus the adjoint. Coefficients of even degrees have
continuous elements in x, those of odd degrees have discontinuous ones, one degree lower, which
contain the derivatives of the others. Both relations then hold exactly on the grid: it neither
gains nor loses energy, however coarse it is.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import sympy
from numpy.polynomial import legendre

from nonsmooth.errors import SceneError, quoted
from nonsmooth.grids.elements import lagrange, lobatto
from nonsmooth.grids.generator import Change
from nonsmooth.grids.grading import mirrored
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x, y


def applies(scene: Scene) -> bool:
    """Whether noise is white, all forces but damping have potentials, and g depends on x alone."""
    return (
        scene.state == ("y", "x")
        and scene.noise.kind == "white"
        and scene.mechanics.in_potential
        and y not in scene.numerical_observable().free_symbols
    )


def gibbs_ordinates(
    scene: Scene, ends: dict, level: tuning.GibbsLevel, change: Change | None = None
) -> PlaneOrdinates:
    """Discretise a scene to which this `applies`, with finite n and odd g and drift.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of the box.
    level : GibbsLevel
        Resolution.
    change : Change, optional
        Of the scene, if derivatives are wanted.

    Returns
    -------
    PlaneOrdinates
        Values are coefficients of the Hermite polynomials at nodes x > 0.
    """
    many, where = level.hermite, scene.start.get("x", 0.0)
    scale = scene.noise.sigma / math.sqrt(2 * scene.damping)
    elements = _elements(scene, _edges(scene, ends[x], level), level.degree, scale)
    masses = [m[len(m) // 2 :] for m in elements.masses]
    nodes = [at[len(at) // 2 :] for at in elements.nodes]
    g = [vectorised(scene.numerical_observable(), (x,))(at) for at in nodes]
    kept = [
        _kept(np.abs(f) * m, level.dropped, (f != 0) & (at <= abs(where)))
        for f, m, at in zip(g, masses, nodes, strict=True)
    ]
    polynomials = _hermite(scene.start.get("y", 0.0) / scale, many)
    generator, start, slope = {}, {}, {}
    # noise and damping together keep a degree: they do not change a normal law
    motion = _Motion(elements.raising, elements.lowering, -scene.damping, 0.0)
    other = None if change is None else _change_of_motion(scene, elements, scale, change)
    for parity in (ODD, EVEN):
        row = _start(elements, polynomials, parity, where)
        moving, size = [], 0
        for k in range(many):
            centre = len(nodes[k % 2]) - row[k].shape[1]  # 1 where x = 0 is left out
            moving.append(size + kept[k % 2] - centre)
            size += row[k].shape[1]
        order = np.concatenate([*moving, np.delete(np.arange(size), np.concatenate(moving))])
        generator[parity] = motion.matrix(row, parity)[order][:, order].tocsc()
        if other is not None:
            slope[parity] = other.matrix(row, parity)[order][:, order].tocsc()
        start[parity] = np.hstack(row)[0][order]
    way = math.sqrt((masses[0] @ g[0] ** 2) / masses[0].sum()) / scene.damping
    # `order` is that of EVEN, the last parity of the loop
    ones = (order < len(nodes[0])).astype(float)
    speeds = np.concatenate([g[k % 2][kept[k % 2]] for k in range(many)])
    weights = np.concatenate([masses[k % 2][kept[k % 2]] for k in range(many)])
    weights /= masses[0].sum()
    return PlaneOrdinates(speeds, weights, ones, way, generator, start, slope or None)


def _start(elements, polynomials, parity, where):
    """Row of the start, a part for each Hermite degree."""
    at_start, row = elements.at(where), []
    for k, value in enumerate(polynomials):
        own = parity * (-1) ** k  # parity in x
        row.append(value * _folded(at_start[k % 2], own))
        if where == 0 and own == ODD:
            row[-1] *= 0.0
    return row


@dataclass(frozen=True)
class _Motion:
    """A generator in Hermite polynomials of y / s.

    Attributes
    ----------
    raising, lowering : tuple of numpy.ndarray
        From even and odd degrees to the next ones, but for the root of the higher degree.
    keeping : float
        A degree k is multiplied by it and k.
    falling : float
        From k to k - 2, but for the root of k (k - 1).
    """

    raising: tuple
    lowering: tuple
    keeping: float
    falling: float

    def matrix(self, row, parity):
        """Put together a block for each pair of degrees; `row` has a part of the size of each."""
        many = len(row)
        blocks: list = [[None] * many for _ in range(many)]
        for k, part in enumerate(row):
            one, own = sp.eye_array(part.shape[1]), parity * (-1) ** k
            blocks[k][k] = self.keeping * k * one
            if k > 1 and self.falling:
                blocks[k - 2][k] = math.sqrt(k * (k - 1)) * self.falling * one
            if k + 1 < many:
                root = math.sqrt(k + 1)
                blocks[k + 1][k] = sp.csr_array(root * _half(self.raising[k % 2], own))
                blocks[k][k + 1] = sp.csr_array(root * _half(self.lowering[(k + 1) % 2], -own))
        return sp.block_array(blocks, format="csr")


def _change_of_motion(scene, elements, scale, change):
    """Differentiate the generator, in the polynomials and elements of the scene.

    d_y lowers a degree by its root over s. So y d_y keeps it, and lowers it by two.
    """
    rough, forces = elements.nodes[1], []
    for drift in (scene.numerical_drift(), change.drift):
        forces.append(-vectorised(sympy.sympify(drift[y]).subs(y, 0), (x,))(rough))
    moving = float(sympy.diff(change.drift[x], y))
    damping = -float(sympy.diff(change.drift[y], y))
    own, changed = forces
    turned = ((changed - moving * own) / scale)[:, None] * elements.value
    raising = tuple(moving * part for part in elements.raising)
    up, down = (moving * part for part in elements.lowering)
    return _Motion(
        raising,
        (up - turned, down - _adjoint(turned, elements.masses)),
        -damping,
        change.diffusion / scale**2 - damping,
    )


@dataclass(frozen=True)
class _Elements:
    """Elements in x of two kinds: continuous for even Hermite degrees, discontinuous for odd.

    Attributes
    ----------
    edges : numpy.ndarray
    local, nodes, masses : tuple of numpy.ndarray
        Nodes of an element, nodes, and masses of the invariant density, for both kinds.
    value : numpy.ndarray
        Values at the discontinuous nodes of what is known at the continuous ones.
    raising, lowering : tuple of numpy.ndarray
        What the motion does to a Hermite degree of either kind, but for the root of the degree.
    """

    edges: np.ndarray
    local: tuple
    nodes: tuple
    masses: tuple
    value: np.ndarray
    raising: tuple
    lowering: tuple

    def at(self, point):
        """Rows that interpolate at a point, for both kinds."""
        return [_at(point, self.edges, local) for local in self.local]


def _elements(scene, edges, degree, scale):
    gauss, weights = legendre.leggauss(degree)
    smooth, rough = _nodes(edges, *lobatto(degree)[:2]), _nodes(edges, gauss, weights)
    value, slope = _derived(edges, degree)
    energy = scene.potential_expression + scene.mechanics.added_potential
    energy = vectorised(energy.subs(penalization, scene.n), (x,))
    force = -vectorised(scene.numerical_drift()[y].subs(y, 0), (x,))(rough[0])
    with np.errstate(over="ignore"):
        masses = [w * np.exp((energy(0.0) - energy(at)) / scale**2) for at, w in (smooth, rough)]
    if not all(np.all(np.isfinite(mass)) for mass in masses):
        raise SceneError(
            f"U = {quoted(scene.potential)} falls so far below U(0) that the invariant density "
            "overflows in double precision; choose a U that falls less, or method='monte_carlo'"
        )
    up = scale * slope
    down = up - (force / scale)[:, None] * value

    return _Elements(
        edges,
        (lobatto(degree)[0], gauss),
        (smooth[0], rough[0]),
        tuple(masses),
        value,
        (up, -_adjoint(down, masses)),
        (down, -_adjoint(up, masses)),
    )


def _adjoint(matrix, masses):
    """From the discontinuous nodes to the continuous ones."""
    return matrix.T * masses[1] / masses[0][:, None]


def _edges(scene, end, settings):
    """Edges on the walls, if they are within the box."""
    wall = scene.mechanics.penalty.at(scene.n)[0]
    positive = min(wall, end) * np.array(settings.inside)
    if wall < end:
        positive = np.append(positive, wall + (end - wall) * np.array(settings.within))
    return mirrored(positive)


def _nodes(edges, local, weights):
    """Nodes of all elements and their weights; neighbours share a node at an end."""
    half = np.diff(edges)[:, None] / 2
    nodes = ((edges[1:] + edges[:-1])[:, None] / 2 + half * local).ravel()
    weights = (half * weights).ravel()
    if local[-1] < 1:
        return nodes, weights
    many = len(local)
    kept = np.delete(np.arange(len(nodes)), np.arange(many, len(nodes), many))
    shared = np.arange(many - 1, len(nodes) - 1, many)
    weights[shared] += weights[shared + 1]
    nodes[len(nodes) // 2 - 1] = 0.0
    return nodes[kept], weights[kept]


def _derived(edges, degree):
    """Values and slopes, at the discontinuous nodes, of the continuous elements' polynomials."""
    values, slopes = lagrange(lobatto(degree)[0], legendre.leggauss(degree)[0])
    count = len(edges) - 1
    found = np.zeros((2, count * degree, count * degree + 1))
    for e, width in enumerate(np.diff(edges)):
        here = slice(e * degree, (e + 1) * degree), slice(e * degree, (e + 1) * degree + 1)
        found[0][here], found[1][here] = values, slopes * 2 / width
    return found


def _at(point, edges, local):
    """Row that interpolates at a point, from nodes of either kind.

    Next to x = 0 it interpolates over both elements beside 0 and leaves the node x = 0 out: g = 0
    there, and the value at such a node is ill-conditioned.
    """
    count, many = len(edges) - 1, len(local)
    stride = many - 1 if local[-1] == 1 else many
    e = int(np.clip(np.searchsorted(edges, point, "right") - 1, 0, count - 1))
    middle = count // 2
    first, end = (middle - 1, middle + 1) if e in (middle - 1, middle) else (e, e + 1)
    here = slice(first * stride, end * stride + many - stride)
    nodes = _nodes(edges, local, np.ones(many))[0]
    chosen = np.arange(len(nodes))[here]
    chosen = chosen[nodes[chosen] != 0]
    centre, half = (edges[end] + edges[first]) / 2, (edges[end] - edges[first]) / 2
    row = np.zeros((1, len(nodes)))
    scaled = (nodes[chosen] - centre) / half
    row[0, chosen] = lagrange(scaled, np.array([(point - centre) / half]))[0][0]
    return row


def _folded(matrix, parity):
    """Restrict the columns of a matrix to x >= 0, for functions of a parity in x."""
    middle, centre = divmod(matrix.shape[1], 2)
    right = matrix[:, middle:].copy()
    right[:, centre:] += parity * matrix[:, :middle][:, ::-1]
    return right[:, 1:] if centre and parity == ODD else right


def _half(matrix, parity):
    """Restrict to x >= 0 a matrix that changes the parity in x."""
    middle, centre = divmod(matrix.shape[0], 2)
    return _folded(matrix, parity)[middle + (centre if parity == EVEN else 0) :]


def _kept(flow, dropped, near):
    """Find the nodes that carry the flow, but for a small part of it, and those up to the start."""
    order = np.argsort(flow)
    return np.union1d(order[np.cumsum(flow[order]) > dropped * flow.sum()], np.flatnonzero(near))


def _hermite(point, many):
    """Orthonormal Hermite polynomials of a standard normal variable."""
    values = [1.0, point]
    for k in range(1, many - 1):
        values.append((point * values[k] - math.sqrt(k) * values[k - 1]) / math.sqrt(k + 1))
    return values
