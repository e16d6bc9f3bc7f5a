"""Images in breadth-first levels of the graph of pairs: the order of block tridiagonal systems."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from posstats.arrays import Ints


@dataclass(frozen=True, eq=False)
class Levels:
    """A partition of n images, such that pairs connect the same or neighbouring levels.

    Attributes
    ----------
    image
        (n,) images, level after level.
    offsets
        (L + 1,) level l is image[offsets[l]:offsets[l + 1]].
    level, place
        (n,) level of every image, and its place there.
    """

    image: Ints
    offsets: Ints
    level: Ints
    place: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1


def breadth_first_levels(first: Ints, second: Ints, n_images: int) -> Levels:
    """Levels of the graph of pairs (P,), from a pseudo-peripheral image of every component."""
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(n_images, n_images)).tocsr()
    level = np.empty(n_images, dtype=np.intp)
    n_components, component = connected_components(graph, directed=False)
    n_levels = 0
    for c in range(n_components):
        members = np.flatnonzero(component == c)
        depth = _peripheral_depth(graph, members)
        level[members] = n_levels + depth
        n_levels += int(depth.max()) + 1
    image = np.argsort(level, kind="stable")
    offsets = np.searchsorted(level[image], np.arange(n_levels + 1))
    place = np.empty(n_images, dtype=np.intp)
    place[image] = np.arange(n_images) - offsets[level[image]]
    return Levels(image, offsets, level, place)


def _peripheral_depth(graph: csr_array, members: Ints) -> Ints:
    """Depth (k,) of the images of one component, from an image as far out as can be found."""
    depth = np.zeros(len(members), dtype=np.intp)
    while True:
        start = members[np.argmax(depth)]
        distance = dijkstra(graph, directed=False, indices=start, unweighted=True)
        deeper = distance[members].astype(np.intp)
        if deeper.max() <= depth.max():
            return deeper
        depth = deeper
