// LZ4 frames, as chunks of MCAP have them.
import { Bytes } from './bytes.js';

const MAGIC = 0x184d2204, STORED = 0x80000000;

function length(b, first) {
  let total = first;
  if (first === 15) {
    let more = 255;
    while (more === 255) total += more = b.u8();
  }
  return total;
}

/** One block into `out` from `at` on; what it refers to may lie in blocks before it. */
function unpackBlock(data, out, at, what) {
  const b = new Bytes(data, what);
  let to = at;
  while (b.left > 0) {
    const token = b.u8();
    const literals = b.take(length(b, token >> 4));
    out.set(literals, to);
    to += literals.length;
    if (b.left === 0) break;
    const from = to - b.u16();
    const size = length(b, token & 15) + 4;
    if (from < 0 || from >= to || to + size > out.length) throw new Error(`${what}: is damaged`);
    for (let i = 0; i < size; i++) out[to + i] = out[from + i];
    to += size;
  }
  return to;
}

/** Exactly `size` bytes. */
export function unpackLz4(data, size, what) {
  const b = new Bytes(data, what);
  if (b.u32() !== MAGIC) throw new Error(`${what}: is no LZ4 frame`);
  const flags = b.u8();
  b.take(1 + (flags & 8 ? 8 : 0) + (flags & 1 ? 4 : 0) + 1);
  const out = new Uint8Array(size);
  let at = 0;
  for (let head = b.u32(); head !== 0; head = b.u32()) {
    const block = b.take(head & 0x7fffffff);
    if (head >= STORED) {
      out.set(block, at);
      at += block.length;
    } else {
      at = unpackBlock(block, out, at, what);
    }
    if (flags & 16) b.take(4);
  }
  if (at !== size) throw new Error(`${what}: is damaged`);
  return out;
}
