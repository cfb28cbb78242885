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
        x = self.state
        x ^= x >> 12
        x ^= (x << 25) & MASK
        x ^= x >> 27
        self.state = x
        return ((x * STAR & MASK) >> 11) / 9007199254740992.0

    def range(self, low, high):
        return low + (high - low) * self.uniform()

    def normal(self):
        """Twelve uniform numbers have variance 1."""
        total = -6.0
        for _ in range(12):
            total += self.uniform()
        return total

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

    def uniforms(self, count):
        """The next `count` at once: lanes that each begin where the one before ends."""
        steps = -(-count // LANES)
        images = self._jump(steps)
        starts = np.empty(LANES, np.uint64)
        x = self.state
        for lane in range(LANES):
            starts[lane] = x
            y = 0
            while x:
                low = x & -x
                y ^= images[low.bit_length() - 1]
                x ^= low
            x = y
        out = np.empty((steps, LANES), np.uint64)
        for k in range(steps):
            starts = out[k] = _step(starts)
        out = np.ascontiguousarray(out.T).reshape(-1)[:count]
        self.state = int(out[-1])
        return ((out * np.uint64(STAR)) >> np.uint64(11)) / 9007199254740992.0

    def normals(self, count):
        """The next `count` normal numbers, summed in the order of one after the other."""
        u = self.uniforms(12 * count).reshape(count, 12)
        total = np.full(count, -6.0)
        for k in range(12):
            total += u[:, k]
        return total
