// MCAP: its records, a chunk at a time, so that a long recording needs little memory.
import { Bytes } from './bytes.js';
import { unpackLz4 } from './lz4.js';
import { unpackZstd } from './zstd.js';

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const SCHEMA = 3, CHANNEL = 4, MESSAGE = 5, CHUNK = 6, METADATA = 0x0c, DATA_END = 0x0f;
const HEAD = 9; // of a record: what it is, and its size
const CHUNK_MAX = 1 << 29;

export function isMcap(data) {
  return MAGIC.every((byte, i) => data[i] === byte);
}

async function bytesOf(blob, from, to) {
  return new Uint8Array(await blob.slice(from, to).arrayBuffer());
}

function unpackChunk(data, what) {
  const b = new Bytes(data, what);
  b.take(16);
  const size = b.size();
  b.take(4);
  const packing = b.text();
  const packed = b.take(b.size());
  if (size > CHUNK_MAX) throw new Error(`${what}: a chunk of ${size} bytes is too large for a browser`);
  if (packing === '') return packed;
  if (packing === 'zstd') return unpackZstd(packed, size, what);
  if (packing === 'lz4') return unpackLz4(packed, size, what);
  throw new Error(`${what}: its chunks are packed with ${packing}: zstd, lz4 and none can be read here`);
}

function readSchema(b) {
  return { id: b.u16(), name: b.text() };
}

function readChannel(b) {
  return { id: b.u16(), schema: b.u16(), topic: b.text(), encoding: b.text() };
}

function readMap(b) {
  const name = b.text();
  const map = new Bytes(b.block(), b.what);
  const values = {};
  while (map.left > 0) {
    const key = map.text();
    values[key] = map.text();
  }
  return [name, values];
}

/** A recording's channels and where its messages are. */
export class Mcap {
  constructor(blob, name) {
    this.blob = blob;
    this.name = name;
    this.schemas = new Map();
    this.channels = new Map();
    this.metadata = {};
    this.messages = []; // {channel, time, chunk, at, size}; chunk -1: `at` is in the file
    this.chunks = [];   // [from, to] in the file
    this.kept = new Map();
  }

  async open(onProgress) {
    for (let at = MAGIC.length; at + HEAD <= this.blob.size;) {
      const head = new Bytes(await bytesOf(this.blob, at, at + HEAD), this.name);
      const kind = head.u8(), size = head.size();
      if (kind === DATA_END) break;
      if (at + HEAD + size > this.blob.size) break; // a recording that was cut off plays to there
      await this.#note(kind, at + HEAD, size);
      at += HEAD + size;
      onProgress(at / this.blob.size);
    }
    return this;
  }

  async #note(kind, at, size) {
    if (kind === MESSAGE) this.#noteMessage(new Bytes(await bytesOf(this.blob, at, at + 22), this.name), -1, at, size);
    if (kind === SCHEMA || kind === CHANNEL || kind === METADATA) {
      this.#noteList(kind, new Bytes(await bytesOf(this.blob, at, at + size), this.name));
    }
    if (kind === CHUNK) {
      this.chunks.push([at, at + size]);
      this.#noteChunk(await this.#chunk(this.chunks.length - 1), this.chunks.length - 1);
    }
  }

  #noteList(kind, b) {
    if (kind === METADATA) {
      const [name, values] = readMap(b);
      this.metadata[name] = values;
      return;
    }
    const entry = kind === SCHEMA ? readSchema(b) : readChannel(b);
    (kind === SCHEMA ? this.schemas : this.channels).set(entry.id, entry);
  }

  #noteMessage(b, chunk, at, size) {
    const channel = b.u16();
    b.take(4);
    this.messages.push({ channel, time: b.u64(), chunk, at: at + 22, size: size - 22 });
  }

  #noteChunk(data, chunk) {
    const b = new Bytes(data, this.name);
    while (b.left >= HEAD) {
      const kind = b.u8(), size = b.size(), at = b.at;
      const record = new Bytes(b.take(size), this.name);
      if (kind === MESSAGE) this.#noteMessage(record, chunk, at, size);
      else if (kind === SCHEMA || kind === CHANNEL) this.#noteList(kind, record);
    }
  }

  /** The last two chunks are kept unpacked: frames come in order. */
  async #chunk(index) {
    if (!this.kept.has(index)) {
      const [from, to] = this.chunks[index];
      if (this.kept.size > 1) this.kept.delete(this.kept.keys().next().value);
      this.kept.set(index, unpackChunk(await bytesOf(this.blob, from, to), this.name));
    }
    return this.kept.get(index);
  }

  async read(message) {
    const { chunk, at, size } = message;
    return chunk < 0 ? bytesOf(this.blob, at, at + size) : (await this.#chunk(chunk)).subarray(at, at + size);
  }

  typeOf(channel) {
    return this.schemas.get(channel.schema)?.name ?? '';
  }
}
