// Literals of zstd: Huffman codes whose tree comes as weights (RFC 8878, section 4.2.1).
import { BackBits, makeTable, readCounts } from './zstd_bits.js';

const WEIGHTS_MAX = 255, BITS_MAX = 11;

/** Weights behind an FSE table: two states that take turns, until the bits are used up. */
function packedWeights(data, what) {
  const { counts, log, size } = readCounts(data, 6, what);
  const table = makeTable(counts, log);
  const bits = new BackBits(data.subarray(size), what);
  const states = [bits.read(log), bits.read(log)];
  const weights = [];
  for (let turn = 0; weights.length < WEIGHTS_MAX; turn ^= 1) {
    weights.push(table.symbol[states[turn]]);
    const need = table.bits[states[turn]];
    if (bits.at < need) {
      weights.push(table.symbol[states[turn ^ 1]]);
      break;
    }
    states[turn] = table.base[states[turn]] + bits.read(need);
  }
  return weights;
}

/** The last weight is what is missing to a power of two. */
function complete(weights, what) {
  const sum = weights.reduce((total, w) => total + (w > 0 ? 1 << (w - 1) : 0), 0);
  const bits = 32 - Math.clz32(sum);
  const rest = (1 << bits) - sum;
  if (sum === 0 || bits > BITS_MAX || (rest & (rest - 1)) !== 0) throw new Error(`${what}: is damaged`);
  weights.push(32 - Math.clz32(rest));
  return bits;
}

/** A tree at the front of `data`: {table, size}. */
export function readTree(data, what) {
  const head = data[0];
  const isPacked = head < 128;
  const count = isPacked ? head : head - 127;
  const size = 1 + (isPacked ? head : (count + 1) >> 1);
  const weights = isPacked ? packedWeights(data.subarray(1, size), what)
    : Array.from({ length: count }, (_, i) => (i % 2 === 0 ? data[1 + (i >> 1)] >> 4 : data[1 + (i >> 1)] & 15));
  const bits = complete(weights, what);
  const table = { bits, symbol: new Uint8Array(1 << bits), length: new Uint8Array(1 << bits) };
  for (let weight = 1, at = 0; weight <= bits; weight++) {
    weights.forEach((w, symbol) => {
      if (w !== weight) return;
      table.symbol.fill(symbol, at, at + (1 << (w - 1)));
      table.length.fill(bits + 1 - w, at, at + (1 << (w - 1)));
      at += 1 << (w - 1);
    });
  }
  return { table, size };
}

/** Fills `out` from one stream. */
export function decodeStream(table, data, out, what) {
  const bits = new BackBits(data, what);
  let state = bits.read(table.bits);
  for (let i = 0; i < out.length; i++) {
    out[i] = table.symbol[state];
    const length = table.length[state];
    state = ((state << length) & ((1 << table.bits) - 1)) | bits.read(length);
  }
}
