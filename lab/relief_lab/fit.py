"""The baselines' tools: planes by RANSAC and least squares, connected components."""

import numpy as np

from .measures import noise_sigma

DRAWS, SIGMAS, SAMPLES, POINTS_MIN = 200, 3.0, 4000, 100


class Points:
    """A depth picture with the rays of its pixels; depth 0 = missing."""

    def __init__(self, depth, rays, noise):
        self.depth = depth
        z = depth.astype(float)
        self.xyz = np.stack((z * rays[0], z * rays[1], z), axis=-1).reshape(-1, 3)
        self.rays = np.stack([r.ravel() for r in rays], axis=-1).astype(float)
        self.most = SIGMAS * noise_sigma(noise, z).ravel()

    def holds(self, plane, pixels):
        """Whether the points of pixels are on the plane: within 3 sigma of the sensor's noise there."""
        n, d = plane
        return np.abs(self.xyz[pixels] @ n - d) < self.most[pixels]


def _random(count):
    state = 1
    while True:
        state = (state * 1664525 + 1013904223) & 0xFFFFFFFF
        yield (state >> 8) % count


def _through(a, b, c):
    n = np.cross(b - a, c - a)
    length = np.linalg.norm(n)
    if not length > 1e-6:
        return None
    n = n * ((-1.0 if n @ a > 0 else 1.0) / length)
    return n, float(n @ a)


def _solve(rays, inverse):
    """1/z = a x + b y + c over rays: exact for planes, (a, b, c).p = 1 on it."""
    m = np.column_stack((rays, np.ones(len(rays))))
    normal = m.T @ m
    if not np.linalg.det(normal) > 1e-18 * len(rays):
        return None
    g = np.linalg.solve(normal, m.T @ inverse)
    length = np.linalg.norm(g)
    return -g / length, -1.0 / length


def find_plane(points):
    """(n, d) of the plane n.p = d with most points, n towards the camera: 200 draws, then least squares over the
    points on it, twice. None when there are fewer than 100."""
    usable = np.flatnonzero(points.depth.ravel() > 0)
    if len(usable) < POINTS_MIN:
        return None
    samples = usable[::len(usable) // SAMPLES + 1]
    draw, best, most = _random(len(samples)), None, 0
    for _ in range(DRAWS):
        plane = _through(*(points.xyz[samples[next(draw)]] for _ in range(3)))
        count = 0 if plane is None else int(points.holds(plane, samples).sum())
        if count > most:
            best, most = plane, count
    for _ in range(2 if best is not None else 0):
        on = usable[points.holds(best, usable)]
        best = _solve(points.rays[on], 1.0 / points.xyz[on, 2]) or best
    return best


def components(depth, marked, step):
    """Labels 1, 2, ... of 4-connected marked pixels whose depths differ by less than `step` (share of the depth of
    the one that was reached first); others 0."""
    height, width = depth.shape
    z, free = depth.ravel().tolist(), marked.ravel().tolist()
    labels, count = [0] * len(z), 0
    for start in np.flatnonzero(marked.ravel()).tolist():
        if labels[start]:
            continue
        count += 1
        labels[start] = count
        stack = [start]
        while stack:
            i = stack.pop()
            x, at = i % width, z[i]
            for j, is_there in ((i - 1, x > 0), (i + 1, x + 1 < width), (i - width, i >= width),
                                (i + width, i + width < len(z))):
                if is_there and free[j] and not labels[j] and -step * at < z[j] - at < step * at:
                    labels[j] = count
                    stack.append(j)
    return np.array(labels).reshape(height, width)
