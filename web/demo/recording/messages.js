// ROS 2 messages of a recording: XCDR1, every number aligned to its size from behind the head of 4 bytes.
class Cdr {
  constructor(data, what) {
    this.what = what;
    if (data.length < 4 || data[0] !== 0 || data[1] > 1) throw new Error(`${what}: is no ROS 2 message`);
    this.isLittle = data[1] === 1;
    this.data = data.subarray(4);
    this.view = new DataView(this.data.buffer, this.data.byteOffset, this.data.length);
    this.at = 0;
  }

  #take(size, align = size) {
    const at = Math.ceil(this.at / align) * align;
    if (at + size > this.data.length) throw new Error(`${this.what}: a message is cut short`);
    this.at = at + size;
    return at;
  }

  u8() { return this.view.getUint8(this.#take(1)); }
  u32() { return this.view.getUint32(this.#take(4), this.isLittle); }
  doubles(count) { return Array.from({ length: count }, () => this.view.getFloat64(this.#take(8), this.isLittle)); }
  bytes() {
    const size = this.u32();
    const at = this.#take(size, 1);
    return this.data.subarray(at, at + size);
  }

  text() { return new TextDecoder().decode(this.bytes()).replace(/\0$/, ''); }
  header() {
    const seconds = this.u32(), nanoseconds = this.u32();
    return { stamp: BigInt(seconds) * 1000000000n + BigInt(nanoseconds), frame: this.text() };
  }
}

export function readImage(data, what) {
  const c = new Cdr(data, what);
  const header = c.header();
  const height = c.u32(), width = c.u32(), encoding = c.text(), isBig = c.u8() !== 0, step = c.u32();
  return { ...header, width, height, encoding, isBig, step, data: c.bytes() };
}

export function readCompressed(data, what) {
  const c = new Cdr(data, what);
  return { ...c.header(), format: c.text(), data: c.bytes() };
}

export function readCameraInfo(data, what) {
  const c = new Cdr(data, what);
  const header = c.header();
  const height = c.u32(), width = c.u32(), model = c.text();
  const distortion = c.doubles(c.u32());
  const [fx, , cx, , fy, cy] = c.doubles(9);
  const distortionModel = distortion.some((d) => d !== 0) ? model : 'none';
  return { ...header, camera: { width, height, fx, fy, cx, cy, distortionModel, distortion: distortion.slice(0, 8) } };
}

/** p_parent = T p_child */
export function readTransforms(data, what) {
  const c = new Cdr(data, what);
  return Array.from({ length: c.u32() }, () => {
    const { frame: parent } = c.header();
    const child = c.text();
    const [x, y, z, qx, qy, qz, qw] = c.doubles(7);
    return { parent, child, pose: { position: [x, y, z], quaternion: [qx, qy, qz, qw] } };
  });
}
