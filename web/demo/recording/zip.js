// Files of a zip: stored or deflated, also zip64. Read from a Blob, a file at a time.
import { Bytes, inflate } from './bytes.js';

const END = 0x06054b50, END_SIZE = 22, END_MAX = 65557;
const END64_PLACE = 0x07064b50, ENTRY = 0x02014b50, LOCAL_SIZE = 30;
const ALL_ONES = 0xffffffff;

async function bytesOf(blob, from, to) {
  return new Uint8Array(await blob.slice(from, to).arrayBuffer());
}

/** Where the list of files is: at the end of the zip, before a comment. */
async function findList(blob, name) {
  const start = Math.max(0, blob.size - END_MAX);
  const tail = await bytesOf(blob, start, blob.size);
  const view = new DataView(tail.buffer);
  let at = tail.length - END_SIZE;
  while (at >= 0 && view.getUint32(at, true) !== END) at--;
  if (at < 0) throw new Error(`${name}: is not a whole zip`);
  const list = { count: view.getUint16(at + 10, true), size: view.getUint32(at + 12, true), at: view.getUint32(at + 16, true) };
  const has64 = at >= 20 && view.getUint32(at - 20, true) === END64_PLACE;
  if (!has64 || (list.at !== ALL_ONES && list.count !== 0xffff)) return list;
  const place = Number(view.getBigUint64(at - 12, true));
  const b = new Bytes(await bytesOf(blob, place, place + 56), name);
  b.take(32);
  return { count: b.size(), size: b.size(), at: b.size() };
}

/** Sizes and place beyond 32 bits are in an extra field. */
function read64(entry, extra, name) {
  const b = new Bytes(extra, name);
  while (b.left >= 4) {
    const id = b.u16();
    const field = new Bytes(b.take(b.u16()), name);
    if (id !== 1) continue;
    for (const key of ['size', 'packed', 'at']) {
      if (entry[key] === ALL_ONES) entry[key] = field.size();
    }
  }
  return entry;
}

function readEntry(b, name) {
  if (b.u32() !== ENTRY) throw new Error(`${name}: its list of files is damaged`);
  b.take(4);
  const flags = b.u16(), method = b.u16();
  b.take(8);
  const packed = b.u32(), size = b.u32();
  const nameSize = b.u16(), extraSize = b.u16(), commentSize = b.u16();
  b.take(8);
  const at = b.u32();
  const path = new TextDecoder().decode(b.take(nameSize));
  const entry = read64({ path, method, packed, size, at, isLocked: (flags & 1) !== 0 }, b.take(extraSize), name);
  b.take(commentSize);
  return entry;
}

async function readFile(blob, entry, name) {
  const what = `${name}: ${entry.path}`;
  if (entry.isLocked) throw new Error(`${what}: is encrypted`);
  const local = new Bytes(await bytesOf(blob, entry.at, entry.at + LOCAL_SIZE), what);
  local.take(26);
  const start = entry.at + LOCAL_SIZE + local.u16() + local.u16();
  const packed = await bytesOf(blob, start, start + entry.packed);
  if (packed.length !== entry.packed) throw new Error(`${what}: is cut short`);
  if (entry.method === 0) return packed;
  if (entry.method !== 8) throw new Error(`${what}: is packed by method ${entry.method}: pack it as usual (deflate)`);
  return inflate(packed, 'deflate-raw', what);
}

/** Map of path to a function that reads the file. */
export async function openZip(blob, name) {
  const list = await findList(blob, name);
  const b = new Bytes(await bytesOf(blob, list.at, list.at + list.size), name);
  const files = new Map();
  for (let i = 0; i < list.count; i++) {
    const entry = readEntry(b, name);
    if (!entry.path.endsWith('/')) files.set(entry.path, () => readFile(blob, entry, name));
  }
  return files;
}
