// 16-bit grey PNG, exactly: a canvas would round depth to 8 bits.
import { inflate } from './bytes.js';

const MAGIC = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];

export function isPng(data) {
  return MAGIC.every((byte, i) => data[i] === byte);
}

/** Size and kind of a PNG. */
export function pngHead(data) {
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  if (!isPng(data) || data.length < 33) return null;
  return { width: view.getUint32(16), height: view.getUint32(20), bits: data[24], color: data[25], interlace: data[28] };
}

function imageData(data, what) {
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  const parts = [];
  for (let at = 8; at + 12 <= data.length;) {
    const size = view.getUint32(at);
    const kind = String.fromCharCode(...data.subarray(at + 4, at + 8));
    if (at + 12 + size > data.length) throw new Error(`${what}: is cut short`);
    if (kind === 'IDAT') parts.push(data.subarray(at + 8, at + 8 + size));
    at += 12 + size;
  }
  return new Blob(parts);
}

function paeth(a, b, c) {
  const p = a + b - c;
  const pa = Math.abs(p - a), pb = Math.abs(p - b), pc = Math.abs(p - c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/** What a filter adds to a byte: left, above and above left of it are given. */
const FILTERS = [() => 0, (a) => a, (a, b) => b, (a, b) => (a + b) >> 1, paeth];

/** Undoes the filter of each row, in place; `raw` has a filter's number before each row. */
function unfilter(raw, rowBytes, rows, pixelBytes, what) {
  for (let y = 0; y < rows; y++) {
    const row = y * (rowBytes + 1) + 1, above = row - rowBytes - 1;
    const add = FILTERS[raw[row - 1]];
    if (!add) throw new Error(`${what}: is damaged`);
    if (raw[row - 1] === 0) continue;
    for (let x = 0; x < rowBytes; x++) {
      const hasLeft = x >= pixelBytes;
      const a = hasLeft ? raw[row + x - pixelBytes] : 0;
      const b = y > 0 ? raw[above + x] : 0;
      const c = hasLeft && y > 0 ? raw[above + x - pixelBytes] : 0;
      raw[row + x] += add(a, b, c);
    }
  }
}

/** {width, height, data: Uint16Array}. */
export async function decodePng16(data, what) {
  const head = pngHead(data);
  if (head === null) throw new Error(`${what}: is no PNG`);
  const { width, height, bits, color, interlace } = head;
  if (bits !== 16 || color !== 0 || interlace !== 0) {
    throw new Error(`${what}: depth must be a 16-bit grey PNG that is not interlaced`);
  }
  const rowBytes = 2 * width;
  const raw = await inflate(imageData(data, what), 'deflate', what);
  if (raw.length !== (rowBytes + 1) * height) throw new Error(`${what}: is damaged`);
  unfilter(raw, rowBytes, height, 2, what);
  const out = new Uint16Array(width * height);
  for (let y = 0; y < height; y++) {
    const row = y * (rowBytes + 1) + 1;
    for (let x = 0; x < width; x++) out[y * width + x] = raw[row + 2 * x] << 8 | raw[row + 2 * x + 1];
  }
  return { width, height, data: out };
}
