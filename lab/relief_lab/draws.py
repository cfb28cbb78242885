"""Random numbers, the same on every machine: xorshift64* (Vigna 2016)."""

import numpy as np

MASK = (1 << 64) - 1
STAR = 2685821657736338717
LANES = 1024


def _step(x):
    """One step of the state; of arrays of uint64, too."""
    x = x ^ (x >> np.uint64(12))
    x = x ^ (x << np.uint64(25))
    return x ^ (x >> np.uint64(27))


class Draws:
    """Numbers one after the other."""

    _jumps = {}  # of so many steps: what each bit of the state becomes

    def __init__(self, seed):
        self.state = (seed * 0x9E3779B97F4A7C15 + 1) & MASK

    def uniform(self):
        return self._whole() / 9007199254740992.0

    def _whole(self):
        x = self.state
        x ^= x >> 12
        x ^= (x << 25) & MASK
        x ^= x >> 27
        self.state = x
        return (x * STAR & MASK) >> 11

    def range(self, low, high):
        return low + (high - low) * self.uniform()

    def normal(self):
        """Twelve uniform numbers have variance 1; their sum is exact in whole numbers."""
        return sum(self._whole() for _ in range(12)) / 9007199254740992.0 - 6.0

    def in_box(self, low, high):
        return [self.range(a, b) for a, b in zip(low, high)]

    @classmethod
    def _jump(cls, count):
        """The state after `count` steps is linear in its bits: the images of all 64 (Haramoto et al. 2008)."""
        if count not in cls._jumps:
            bits = np.uint64(1) << np.arange(64, dtype=np.uint64)
            for _ in range(count):
                bits = _step(bits)
            cls._jumps[count] = [int(b) for b in bits]
        return cls._jumps[count]

    def _lanes(self, steps):
        """States of lanes that each begin `steps` after the one before."""
        images, x = self._jump(steps), self.state
        starts = np.empty(LANES, np.uint64)
        for lane in range(LANES):
            starts[lane] = x
            y = 0
            while x:
                low = x & -x
                y ^= images[low.bit_length() - 1]
                x ^= low
            x = y
        return starts

    def _sums(self, count, terms):
        """The next `count` sums of so many whole numbers."""
        rows = -(-count // LANES)
        x = self._lanes(rows * terms)
        last_lane, last_step = divmod(count * terms - 1, rows * terms)
        out = np.zeros((LANES, rows), np.uint64)
        total = np.zeros(LANES, np.uint64)
        for row in range(rows):
            total[:] = 0
            for term in range(terms):
                x = _step(x)
                total += (x * np.uint64(STAR)) >> np.uint64(11)
                if row * terms + term == last_step:
                    self.state = int(x[last_lane])
            out[:, row] = total
        return out.reshape(-1)[:count]

    def uniforms(self, count):
        return self._sums(count, 1) / 9007199254740992.0

    def normals(self, count):
        return self._sums(count, 12) / 9007199254740992.0 - 6.0
