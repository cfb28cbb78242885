// Files that the tests of the page drop onto it: zips of folders, and PNG depth.
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join, relative } from 'node:path';
import { crc32, deflateRawSync, deflateSync } from 'node:zlib';

function head(signature, { name, data, packed, at }, isList) {
  const b = Buffer.alloc(isList ? 46 : 30);
  const from = isList ? 2 : 0; // the list has the version that made it in front
  b.writeUInt32LE(signature, 0);
  b.writeUInt16LE(20, 4 + from);
  b.writeUInt16LE(packed === data ? 0 : 8, 8 + from);
  b.writeUInt32LE(crc32(data), 14 + from);
  b.writeUInt32LE(packed.length, 18 + from);
  b.writeUInt32LE(data.length, 22 + from);
  b.writeUInt16LE(Buffer.byteLength(name), 26 + from);
  if (isList) b.writeUInt32LE(at, 42);
  return Buffer.concat([b, Buffer.from(name)]);
}

/** A zip of {name: bytes or text}. Every second file is stored, the others are deflated. */
export function makeZip(files) {
  const parts = [], list = [];
  let at = 0;
  Object.entries(files).forEach(([name, content], i) => {
    const data = Buffer.from(content);
    const entry = { name, data, packed: i % 2 === 0 ? data : deflateRawSync(data), at };
    const local = Buffer.concat([head(0x04034b50, entry, false), entry.packed]);
    parts.push(local);
    list.push(head(0x02014b50, entry, true));
    at += local.length;
  });
  const size = list.reduce((sum, entry) => sum + entry.length, 0);
  const end = Buffer.alloc(22);
  end.writeUInt32LE(0x06054b50, 0);
  end.writeUInt16LE(list.length, 8);
  end.writeUInt16LE(list.length, 10);
  end.writeUInt32LE(size, 12);
  end.writeUInt32LE(at, 16);
  return Buffer.concat([...parts, ...list, end]);
}

export function zipFolder(folder) {
  const files = readdirSync(folder, { recursive: true }).map((name) => join(folder, name))
    .filter((path) => statSync(path).isFile());
  return makeZip(Object.fromEntries(files.map((path) => [relative(folder, path), readFileSync(path)])));
}

function chunk(kind, data) {
  const size = Buffer.alloc(4), sum = Buffer.alloc(4);
  const body = Buffer.concat([Buffer.from(kind), data]);
  size.writeUInt32BE(data.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([size, body, sum]);
}

/** A 16-bit grey PNG without filters, all pixels alike. */
export function makePng16(width, height, value) {
  const rows = Buffer.alloc((2 * width + 1) * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) rows.writeUInt16BE(value, y * (2 * width + 1) + 1 + 2 * x);
  }
  const first = Buffer.alloc(13);
  first.writeUInt32BE(width, 0);
  first.writeUInt32BE(height, 4);
  first.set([16, 0, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]), chunk('IHDR', first),
    chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}
