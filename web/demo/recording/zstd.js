// Zstandard, as chunks of MCAP have it (RFC 8878). No dictionaries; the checksum is not looked at.
import { Bytes } from './bytes.js';
import { BackBits, makeTable, onlyTable, readCounts } from './zstd_bits.js';
import { decodeStream, readTree } from './zstd_huffman.js';

const MAGIC = 0xfd2fb528, SKIPPED = 0x184d2a5;
const LITERALS = { default: [4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1],
  log: 6, logMax: 9 };
const OFFSETS = { default: [1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1],
  log: 5, logMax: 8 };
const MATCHES = { default: [1, 4, 3, 2, 2, 2, 2, 2, 2, ...Array(37).fill(1), -1, -1, -1, -1, -1, -1, -1], log: 6, logMax: 9 };
const LITERAL_BITS = [...Array(16).fill(0), 1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
const MATCH_BITS = [...Array(32).fill(0), 1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/** Least value of each code, given the bits that follow it. */
function basesOf(bits, first) {
  let base = first;
  return bits.map((count) => {
    base += 2 ** count;
    return base - 2 ** count;
  });
}
const LITERAL_BASES = basesOf(LITERAL_BITS, 0), MATCH_BASES = basesOf(MATCH_BITS, 3);

function number(b, count) {
  let value = 0;
  for (let i = 0; i < count; i++) value += b.u8() * 2 ** (8 * i);
  return value;
}

/** Sizes at the front of the literals: {kind, size, packed, streams}. */
function literalsHead(b) {
  const first = b.data[b.at];
  const kind = first & 3, format = first >> 2 & 3;
  if (kind < 2) {
    const bytes = [1, 2, 1, 3][format];
    return { kind, size: Math.floor(number(b, bytes) / (bytes === 1 ? 8 : 16)), packed: 0, streams: 1 };
  }
  const bits = [10, 10, 14, 18][format];
  const both = Math.floor(number(b, [3, 3, 4, 5][format]) / 16);
  return { kind, size: both % 2 ** bits, packed: Math.floor(both / 2 ** bits), streams: format === 0 ? 1 : 4 };
}

function readLiterals(b, frame) {
  const { kind, size, packed, streams } = literalsHead(b);
  if (kind === 0) return b.take(size);
  if (kind === 1) return new Uint8Array(size).fill(b.u8());
  let data = b.take(packed);
  if (kind === 2) {
    const tree = readTree(data, b.what);
    frame.tree = tree.table;
    data = data.subarray(tree.size);
  }
  const out = new Uint8Array(size);
  if (!frame.tree) throw new Error(`${b.what}: is damaged`);
  if (streams === 1) {
    decodeStream(frame.tree, data, out, b.what);
    return out;
  }
  const parts = new Bytes(data, b.what);
  const sizes = [parts.u16(), parts.u16(), parts.u16()];
  const each = (size + 3) >> 2;
  for (let i = 0; i < 4; i++) {
    decodeStream(frame.tree, parts.take(sizes[i] ?? parts.left), out.subarray(i * each, Math.min(size, (i + 1) * each)), b.what);
  }
  return out;
}

function readTable(b, mode, kind, old) {
  if (mode === 0) return makeTable(kind.default, kind.log);
  if (mode === 1) return onlyTable(b.u8());
  if (mode === 3 && old) return old;
  if (mode === 3) throw new Error(`${b.what}: is damaged`);
  const { counts, log, size } = readCounts(b.data.subarray(b.at), kind.logMax, b.what);
  b.take(size);
  return makeTable(counts, log);
}

function sequenceCount(b) {
  const first = b.u8();
  if (first < 128) return first;
  return first < 255 ? ((first - 128) << 8) + b.u8() : b.u16() + 0x7f00;
}

/** The offset that a code means: one of the last three, or a new one. */
function offsetOf(value, literals, last) {
  const index = value > 3 ? 3 : value - 1 + (literals === 0 ? 1 : 0);
  const offset = value > 3 ? value - 3 : index < 3 ? last[index] : last[0] - 1;
  if (index > 1) last[2] = last[1];
  if (index > 0) last[1] = last[0];
  last[0] = offset;
  return offset;
}

/** Literals and copies of one block into frame.out. */
function runSequences(b, count, literals, frame) {
  const { literal, offset, match } = frame.tables;
  const bits = new BackBits(b.take(b.left), b.what);
  let l = bits.read(literal.log), o = bits.read(offset.log), m = bits.read(match.log);
  let from = 0;
  for (let i = 0; i < count; i++) {
    const offsetValue = 2 ** offset.symbol[o] + bits.read(offset.symbol[o]);
    const matchSize = MATCH_BASES[match.symbol[m]] + bits.read(MATCH_BITS[match.symbol[m]]);
    const literalSize = LITERAL_BASES[literal.symbol[l]] + bits.read(LITERAL_BITS[literal.symbol[l]]);
    frame.put(literals.subarray(from, from + literalSize));
    from += literalSize;
    frame.copy(offsetOf(offsetValue, literalSize, frame.last), matchSize);
    if (i + 1 === count) break;
    l = literal.base[l] + bits.read(literal.bits[l]);
    m = match.base[m] + bits.read(match.bits[m]);
    o = offset.base[o] + bits.read(offset.bits[o]);
  }
  frame.put(literals.subarray(from));
}

function unpackBlock(data, frame) {
  const b = new Bytes(data, frame.what);
  const literals = readLiterals(b, frame);
  const count = sequenceCount(b);
  if (count === 0) {
    frame.put(literals);
    return;
  }
  const modes = b.u8();
  const old = frame.tables ?? {};
  frame.tables = {
    literal: readTable(b, modes >> 6, LITERALS, old.literal),
    offset: readTable(b, modes >> 4 & 3, OFFSETS, old.offset),
    match: readTable(b, modes >> 2 & 3, MATCHES, old.match),
  };
  runSequences(b, count, literals, frame);
}

/** What grows while a frame is unpacked. */
class Frame {
  constructor(out, what) {
    this.out = out;
    this.what = what;
    this.at = 0;
    this.begin();
  }

  begin() {
    this.last = [1, 4, 8];
    this.tree = null;
    this.tables = null;
  }

  put(bytes) {
    if (this.at + bytes.length > this.out.length) throw new Error(`${this.what}: is damaged`);
    this.out.set(bytes, this.at);
    this.at += bytes.length;
  }

  copy(offset, size) {
    const { out, at } = this;
    if (offset > at || offset < 1 || at + size > out.length) throw new Error(`${this.what}: is damaged`);
    for (let i = at; i < at + size; i++) out[i] = out[i - offset];
    this.at = at + size;
  }
}

function skipHead(b) {
  const flags = b.u8();
  const isSingle = (flags & 32) !== 0;
  b.take((isSingle ? 0 : 1) + [0, 1, 2, 4][flags & 3] + [isSingle ? 1 : 0, 2, 4, 8][flags >> 6]);
  return (flags & 4) !== 0;
}

function unpackFrame(b, frame) {
  const hasChecksum = skipHead(b);
  frame.begin();
  for (let isLast = false; !isLast;) {
    const head = b.u8() | b.u8() << 8 | b.u8() << 16;
    const kind = head >> 1 & 3, size = head >> 3;
    isLast = (head & 1) !== 0;
    if (kind === 0) frame.put(b.take(size));
    else if (kind === 1) frame.put(new Uint8Array(size).fill(b.u8()));
    else if (kind === 2) unpackBlock(b.take(size), frame);
    else throw new Error(`${b.what}: is damaged`);
  }
  if (hasChecksum) b.take(4);
}

/** Exactly `size` bytes. */
export function unpackZstd(data, size, what) {
  const b = new Bytes(data, what);
  const frame = new Frame(new Uint8Array(size), what);
  while (b.left > 0) {
    const magic = b.u32();
    if (magic >>> 4 === SKIPPED) b.take(b.u32());
    else if (magic === MAGIC) unpackFrame(b, frame);
    else throw new Error(`${what}: is no zstd frame`);
  }
  if (frame.at !== size) throw new Error(`${what}: is damaged`);
  return frame.out;
}
