// Bytes that are read from the front, little-endian. Past their end: an error in words.
export class Bytes {
  constructor(data, what = 'file') {
    this.data = data;
    this.what = what;
    this.at = 0;
    this.view = new DataView(data.buffer, data.byteOffset, data.length);
  }

  get left() { return this.data.length - this.at; }

  #skip(count) {
    if (!(count >= 0) || count > this.left) throw new Error(`${this.what}: is cut short or damaged`);
    this.at += count;
    return this.at - count;
  }

  u8() { return this.view.getUint8(this.#skip(1)); }
  u16() { return this.view.getUint16(this.#skip(2), true); }
  u32() { return this.view.getUint32(this.#skip(4), true); }
  u64() { return this.view.getBigUint64(this.#skip(8), true); }
  f32() { return this.view.getFloat32(this.#skip(4), true); }
  /** A 64-bit length, which no file of ours needs more than 53 bits for. */
  size() { return Number(this.u64()); }
  take(count) {
    const at = this.#skip(count);
    return this.data.subarray(at, at + count);
  }

  /** With its length of 4 bytes in front. */
  block() { return this.take(this.u32()); }
  text() { return new TextDecoder().decode(this.block()); }
}

/** All of a stream of bytes, by the browser's own inflate: 'deflate' (zlib) or 'deflate-raw' (zip). */
export async function inflate(data, format, what) {
  const stream = new Blob([data]).stream().pipeThrough(new DecompressionStream(format));
  try {
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Error(`${what}: is damaged`);
  }
}
