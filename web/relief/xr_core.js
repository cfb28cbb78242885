// A see-through room in the core: depth buffers with their matrices in, hands, grabs and things that
// stand. No WebXR object comes here, so all of it runs in node, too.

const OK = 0, NO_FRAME = 1, UNSUPPORTED = -5;
const FORMATS = { 'luminance-alpha': 0, 'unsigned-short': 0, float32: 1 };
const BYTES = { 'luminance-alpha': 2, 'unsigned-short': 2, float32: 4 };
const BONES = 24, BONE_NUMBERS = 8;

const SHAPES = ['box', 'sphere', 'capsule', 'cylinder'];

function shapeNumber(shape) {
  const number = SHAPES.indexOf(shape);
  if (number < 0) throw new Error(`shape '${shape}': there are ${SHAPES.join(', ')}`);
  return number;
}

/** A vector turned by a quaternion x y z w. */
export function rotate([x, y, z, w], [a, b, c]) {
  const t = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * t[0] + y * t[2] - z * t[1], b + w * t[1] + z * t[0] - x * t[2], c + w * t[2] + x * t[1] - y * t[0]];
}

/** The mean of corners, three numbers each. */
export function middleOf(corners) {
  return [0, 1, 2].map((k) => corners.reduce((sum, x, i) => sum + (i % 3 === k ? x : 0), 0) * 3 / corners.length);
}

/** The depth camera is another one than the room was opened for. */
export class CameraChanged extends Error {
  get name() { return 'CameraChanged'; }
}

export class SeeThrough {
  #relief;
  #e;

  constructor(relief) {
    this.#relief = relief;
    this.#e = relief.functions;
    this.isOpen = false;
  }

  /** Opens the room for buffers such as this one, which is not taken yet. Bodies that are there stay. */
  open(buffer) {
    const bodies = this.isOpen ? this.bodies() : [];
    this.isOpen = false;
    this.#write(buffer);
    this.#check(this.#e.relief_see_open(buffer.width, buffer.height));
    this.isOpen = true;
    for (const body of bodies) this.addBody(body);
    return this;
  }

  /** Adds a body: metres, m/s, kg; y is up. */
  addBody({ shape = 'sphere', size = [0.05], position = [0, 1, 0], quaternion = [0, 0, 0, 1], velocity = [0, 0, 0],
    mass = 0.2, friction = 0.5, restitution = 0.4 } = {}) {
    const [x, y = x, z = x] = size;
    this.#writeNumbers([...position, ...quaternion, ...velocity, x, y, z, mass, friction, restitution]);
    this.#check(this.#e.relief_touch_add(shapeNumber(shape)));
  }

  /** A depth buffer as the next frame; see xr.d.ts. False: it is the last one again. What cannot be used is an
   * error in words, and the room goes on as it was. */
  push(buffer) {
    if (!this.isOpen) this.open(buffer);
    this.#write(buffer);
    this.#writeRaw(buffer);
    const { width, height, data, format } = buffer;
    const result = this.#e.relief_see_push(FORMATS[format], width, height, data.byteLength);
    if (result === NO_FRAME) return false;
    if (result === UNSUPPORTED) throw new CameraChanged(`relief: ${this.#relief.trouble}`);
    this.#check(result);
    return true;
  }

  /** As push, for who also knows RemoteSee: `done({isNew, troubles, ms})`. */
  send(buffer, done) {
    const start = performance.now();
    let isNew, troubles = [];
    try {
      isNew = this.push(buffer);
    } catch (error) {
      troubles = [['push', error.name, error.message]];
    }
    done({ isNew, troubles, ms: performance.now() - start });
  }

  /** m/s^2; y is up. */
  setGravity(x, y, z) { this.#relief.setGravity(x, y, z); }

  /** Pose of the newest frame's camera: x right, y down, z ahead, turned as the buffer is. */
  camera() {
    const v = new Float32Array(this.#e.memory.buffer, this.#e.relief_see_camera(), 7);
    return { position: [...v.subarray(0, 3)], quaternion: [...v.subarray(3, 7)] };
  }

  /** Bodies as relief.bodies() has them, each with an id. */
  bodies() {
    return this.#relief.bodies().map((body, at) => ({ ...body, id: this.#id(at) }));
  }

  /** Puts a body somewhere, at rest. False: it is gone. */
  place(id, position, quaternion) {
    this.#writePose(position, quaternion);
    return this.#e.relief_touch_place(...id) !== 0;
  }

  remove(id) { this.#e.relief_touch_remove(...id); }

  /** Bones of hand 0 or 1: 24 of 8 floats, two ends, a radius and 0. null: the hand is not seen. */
  hand(which, bones) {
    if (bones !== null) {
      new Float32Array(this.#e.memory.buffer, this.#e.relief_touch_bones(), BONES * BONE_NUMBERS).set(bones);
    }
    this.#check(this.#e.relief_touch_hand(which, bones === null ? 0 : 1));
  }

  /** A hand pinches there; position null: it does not. True while it holds a body. */
  pinch(which, position, quaternion) {
    if (position !== null) this.#writePose(position, quaternion);
    return this.#e.relief_touch_pinch(which, position === null ? 0 : 1) !== 0;
  }

  /** A box that stands: edges in metres. Returns a handle for removeStatic. */
  addBox(size, position, quaternion) {
    this.#writePose(position, quaternion);
    return this.#handle(this.#e.relief_touch_box(...size));
  }

  /** A convex solid that stands: corners in its own frame, triangles counter-clockwise from outside. */
  addHull(corners, triangles, position, quaternion) {
    const { buffer } = this.#e.memory;
    if (corners.length > 3 * 256 || triangles.length > 3 * 512) {
      throw new Error(`a solid of ${corners.length / 3} corners and ${triangles.length / 3} triangles: at most 256 and 512`);
    }
    const middle = middleOf(corners);
    new Float64Array(buffer, this.#e.relief_touch_corners(), corners.length).set(corners.map((x, i) => x - middle[i % 3]));
    new Int32Array(buffer, this.#e.relief_touch_triangles(), triangles.length).set(triangles);
    const shift = rotate(quaternion, middle);
    this.#writePose(position.map((x, k) => x + shift[k]), quaternion);
    return this.#handle(this.#e.relief_touch_hull(corners.length / 3, triangles.length / 3));
  }

  removeStatic(handle) { this.#e.relief_touch_remove_static(handle); }

  close() {
    this.#relief.close();
    this.isOpen = false;
  }

  #id(at) {
    return [...new Uint32Array(this.#e.memory.buffer, this.#e.relief_touch_id(at), 2)];
  }

  #handle(handle) {
    if (handle < 0) throw new Error(`relief: ${this.#relief.trouble}`);
    return handle;
  }

  #write({ bufferFromView, projection, pose, head = pose, rawToMetres, near = 0, far = 0, timeMs, every = 1 }) {
    const numbers = new Float64Array(this.#e.memory.buffer, this.#e.relief_see_numbers(), 69);
    numbers.set(bufferFromView, 0);
    numbers.set(projection, 16);
    numbers.set(pose, 32);
    numbers.set(head, 48);
    numbers.set([rawToMetres, near, far, timeMs, every], 64);
  }

  #writeRaw({ data, format, width, height }) {
    if (!(format in FORMATS)) throw new Error(`depth format '${format}': there are ${Object.keys(FORMATS).join(', ')}`);
    const wanted = width * height * BYTES[format];
    if (!(wanted > 0)) throw new Error(`depth buffer of ${width} x ${height} pixels`);
    if (data.byteLength !== wanted) {
      throw new Error(`depth buffer of ${width} x ${height} pixels: ${data.byteLength} bytes came, not ${wanted}`);
    }
    const at = this.#e.relief_see_raw(wanted);
    if (at === 0) throw new Error(`relief: ${this.#relief.trouble}`);
    new Uint8Array(this.#e.memory.buffer, at, wanted).set(new Uint8Array(data));
  }

  #writePose(position, quaternion) { this.#writeNumbers([...position, ...quaternion]); }

  #writeNumbers(values) {
    new Float64Array(this.#e.memory.buffer, this.#e.relief_touch_numbers(), values.length).set(values);
  }

  #check(result) {
    if (result !== OK) throw new Error(`relief: ${this.#relief.trouble || `result ${result}`}`);
  }
}
