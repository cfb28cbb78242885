"""The sensor's noise by distance, of a still scene.

Spatial: w = 1/z is linear along a row of a plane, so its second difference at step h is noise alone,
z^2 (w(-h) - 2 w(0) + w(h)) / sqrt(6). Curved surfaces and edges are outliers, so the deviation is that of the middle
part of the samples. Noise that is alike in neighbours shows as a deviation that grows with the step. Temporal:
(z_t - z_t-1) / sqrt(2)."""

import math

import numpy as np

from .measures import noise_sigma, percent
from .rooms import raw_depth

BINS, BIN_M = 20, 0.5
CELLS, CELL_M = 2000, 1e-4  # histogram of |residual|; the last cell takes the rest
SAMPLES_MIN = 200
KINDS = ("step_1", "step_2", "step_4", "temporal")


class Noise:
    def __init__(self):
        self.frames = self.pixels = self.missing = 0
        self.in_bin = np.zeros(BINS, np.int64)
        self.cells = {kind: np.zeros((BINS, CELLS), np.int64) for kind in KINDS}
        self.previous = None

    def add(self, frame):
        z = raw_depth(frame)
        z = np.where((z > 0) & (z < 1000.0), z, np.float32(0))
        bins = (z / np.float32(BIN_M)).astype(np.int64)
        self.pixels += z.size
        self.missing += int((z == 0).sum())
        chosen = (z > 0) & (bins < BINS)
        self.in_bin += np.bincount(bins[chosen], minlength=BINS)
        for kind, h in zip(KINDS, (1, 2, 4)):
            left, at, right = z[:, :-2 * h], z[:, h:-h], z[:, 2 * h:]
            good = chosen[:, h:-h] & (left > 0) & (right > 0)
            left, at, right = (1.0 / a[good].astype(float) for a in (left, at, right))
            self._count(kind, bins[:, h:-h][good], (left - 2.0 * at + right) / at ** 2 / math.sqrt(6.0))
        if self.previous is not None:
            good = chosen & (self.previous > 0)
            self._count("temporal", bins[good], (z - self.previous)[good].astype(float) / math.sqrt(2.0))
        self.previous = z
        self.frames += 1

    def _count(self, kind, bins, residual):
        cells = np.minimum(np.abs(residual) / CELL_M, CELLS - 1).astype(np.int64)
        self.cells[kind] += np.bincount(bins * CELLS + cells, minlength=BINS * CELLS).reshape(BINS, CELLS)

    def sigma(self, kind, bin_number):
        """Metres; NAN with too few samples. Whole units of depth make the quantiles a staircase, so they only set
        the scale for a cut at 3 deviations, within which the root of the mean square is taken (0.9867 of the
        deviation of a normal distribution). 68.27 % and 90 % of one lie within 1 and 1.645 deviations; the second
        counts where most samples are equal."""
        cells = self.cells[kind][bin_number]
        count, below = int(cells.sum()), np.cumsum(cells)
        if count < SAMPLES_MIN:
            return math.nan

        def quantile(share):
            return min(int(np.searchsorted(below, int(share * count))), CELLS - 1) * CELL_M

        scale = max(quantile(0.6827), quantile(0.90) / 1.645) + CELL_M
        end = int(min(3.0 * scale / CELL_M, CELLS - 1))
        values = (np.arange(end) + 0.5) * CELL_M
        values[:1] = 0.0
        inside = int(cells[:end].sum())
        return math.sqrt(float((cells[:end] * values ** 2).sum()) / inside) / 0.9867 if inside else math.nan

    def missing_percent(self):
        return percent(self.missing, self.pixels) if self.pixels else 0.0

    def rows(self, assumed):
        """Of each bin that has a figure, as the JSON file has them; assumed: (c0, c1, c2) of a rig."""
        for b in range(BINS):
            sigmas = {kind + "_mm": 1000.0 * self.sigma(kind, b) for kind in KINDS}
            if not all(map(math.isnan, sigmas.values())):
                middle = (b + 0.5) * BIN_M
                yield {"distance_m": middle, "pixels_percent": percent(int(self.in_bin[b]), self.pixels), **sigmas,
                       "assumed_mm": 1000.0 * float(noise_sigma(assumed, middle))}

    def print(self, name, assumed):
        print("%s: %d %s, %.2f %% of the pixels missing" % (name, self.frames, "frame" if self.frames == 1 else "frames",
                                                           self.missing_percent()))
        print("standard deviation of depth in mm, along rows at steps of 1, 2, 4 pixels and from frame to frame")
        print("%10s %8s %8s %8s %8s %8s %8s" % ("metres", "pixels %", "step 1", "step 2", "step 4", "in time", "assumed"))
        for row in self.rows(assumed):
            low = row["distance_m"] - 0.5 * BIN_M
            cells = ["%8s" % "-" if math.isnan(row[k + "_mm"]) else "%8.2f" % row[k + "_mm"] for k in KINDS]
            print("%4.1f - %3.1f %8.2f %s %8.2f" % (low, low + BIN_M, row["pixels_percent"], " ".join(cells),
                                                    row["assumed_mm"]))
