// Bits of zstd: streams that are read from their end, and FSE tables (RFC 8878, sections 4.1 and 4.2).

/** Reads from the last bit backwards; in front of the first there are zeros. */
export class BackBits {
  constructor(data, what) {
    const last = data[data.length - 1];
    if (!last) throw new Error(`${what}: is damaged`);
    this.data = data;
    this.at = 8 * (data.length - 1) + 31 - Math.clz32(last);
  }

  read(count) {
    if (count > 24) return this.read(count - 16) * 65536 + this.read(16);
    this.at -= count;
    const { data, at } = this;
    const byte = at >> 3;
    let word = 0;
    for (let i = 3; i >= 0; i--) word = word << 8 | (data[byte + i] ?? 0);
    return (word >>> (at & 7)) & ((1 << count) - 1);
  }
}

/** Counts of an FSE table's symbols, at the front of `data`: {counts, log, size}. */
export function readCounts(data, logMax, what) {
  let at = 0;
  const read = (count) => {
    let value = 0;
    for (let i = 0; i < count; i++, at++) value |= (data[at >> 3] >> (at & 7) & 1) << i;
    return value;
  };
  const log = read(4) + 5;
  if (log > logMax) throw new Error(`${what}: is damaged`);
  const counts = [];
  for (let left = 1 << log; left > 0;) {
    const bits = 32 - Math.clz32(left + 1);
    const low = (1 << (bits - 1)) - 1, most = (1 << bits) - 2 - left;
    let value = read(bits);
    if ((value & low) < most) {
      at--;
      value &= low;
    } else if (value > low) {
      value -= most;
    }
    const count = value - 1;
    left -= Math.abs(count);
    counts.push(count);
    for (let zeros = count === 0 ? 3 : 0, more = 3; zeros > 0 && more === 3;) {
      more = read(2);
      for (let i = 0; i < more; i++) counts.push(0);
    }
    if (left < 0 || counts.length > 256 || at > 8 * data.length) throw new Error(`${what}: is damaged`);
  }
  return { counts, log, size: (at + 7) >> 3 };
}

/** The decoding table of such counts. */
export function makeTable(counts, log) {
  const size = 1 << log, mask = size - 1, step = (size >> 1) + (size >> 3) + 3;
  const table = { log, symbol: new Uint8Array(size), bits: new Uint8Array(size), base: new Uint16Array(size) };
  const next = counts.map((count) => Math.abs(count));
  let top = size;
  counts.forEach((count, symbol) => { if (count === -1) table.symbol[--top] = symbol; });
  let at = 0;
  counts.forEach((count, symbol) => {
    for (let i = 0; i < count; i++) {
      table.symbol[at] = symbol;
      do at = (at + step) & mask; while (at >= top);
    }
  });
  for (let i = 0; i < size; i++) {
    const state = next[table.symbol[i]]++;
    table.bits[i] = log - (31 - Math.clz32(state));
    table.base[i] = (state << table.bits[i]) - size;
  }
  return table;
}

/** A table that always gives one symbol. */
export function onlyTable(symbol) {
  return { log: 0, symbol: Uint8Array.of(symbol), bits: Uint8Array.of(0), base: Uint16Array.of(0) };
}
