// RVL depth (Wilson 2017): runs of missing and measured pixels, differences in nibbles.
class Nibbles {
  constructor(data, what) {
    this.view = new DataView(data.buffer, data.byteOffset, data.length);
    this.words = data.length >> 2;
    this.what = what;
    this.at = 0;
    this.word = 0;
    this.left = 0;
  }

  number() {
    let value = 0;
    for (let shift = 0; shift < 30; shift += 3) {
      if (this.left === 0) {
        if (this.at === this.words) throw new Error(`${this.what}: is cut short`);
        this.word = this.view.getUint32(4 * this.at++, true);
        this.left = 8;
      }
      const nibble = this.word >>> 28;
      this.word <<= 4;
      this.left--;
      value |= (nibble & 7) << shift;
      if ((nibble & 8) === 0) return value;
    }
    throw new Error(`${this.what}: is damaged`);
  }
}

/** `count` pixels. */
export function decodeRvl(data, count, what) {
  const out = new Uint16Array(count);
  const nibbles = new Nibbles(data, what);
  let previous = 0;
  for (let i = 0; i < count;) {
    i += nibbles.number();
    let measured = nibbles.number();
    if (i + measured > count) throw new Error(`${what}: is damaged`);
    for (; measured > 0; measured--) {
      const value = nibbles.number();
      previous += value >>> 1 ^ -(value & 1);
      out[i++] = previous;
    }
  }
  return out;
}
