// Relief in a browser or in node: the C core as WebAssembly, and views of what it computes.
// One Relief is one room. Arrays are views of the module's memory: they hold until the next step.

const PLANES = {
  depth: [0, Float32Array],
  normalX: [1, Float32Array],
  normalY: [2, Float32Array],
  normalZ: [3, Float32Array],
  velocityX: [4, Float32Array],
  velocityY: [5, Float32Array],
  velocityZ: [6, Float32Array],
  thickness: [7, Float32Array],
  label: [8, Int32Array],
  foreground: [9, Uint8Array],
  reason: [10, Uint8Array],
  backgroundDepth: [11, Float32Array],
  rayX: [12, Float32Array],
  rayY: [13, Float32Array],
};
export const VIEWS = ['camera', 'depth', 'normals', 'mesh', 'regions', 'foreground', 'background',
  'velocity', 'thickness', 'reason', 'points', 'contacts', 'known', 'hands', 'map'];
const SHAPES = ['box', 'sphere', 'capsule', 'cylinder'];
const OTHERS = ['body', 'background', 'foreground'];
const OK = 0, END = 2;
const BODY_FLOATS = 16, CONTACT_FLOATS = 8;
const TEXT_MAX = 511;

function profileNumber(profile) {
  const number = ['live', 'thesis'].indexOf(profile);
  if (number < 0) throw new Error(`profile '${profile}': use 'live' or 'thesis'`);
  return number;
}

export class Relief {
  #e;

  /** Loads the module. `wasm`: a URL, a Response, bytes or a WebAssembly.Module. */
  static async load(wasm = new URL('relief.wasm', import.meta.url)) {
    let source = await wasm;
    if (source instanceof URL || typeof source === 'string') {
      const url = new URL(source, import.meta.url);
      if (url.protocol === 'file:' && typeof process !== 'undefined') {
        const { readFile } = await import('node:fs/promises');
        source = await readFile(url);
      } else {
        source = await fetch(url);
      }
    }
    if (typeof Response !== 'undefined' && source instanceof Response) {
      if (!source.ok) throw new Error(`${source.url}: ${source.status} ${source.statusText}`);
      source = await source.arrayBuffer();
    }
    const made = await WebAssembly.instantiate(source, {});
    const relief = new Relief();
    relief.#e = (made.instance ?? made).exports;
    relief.#e._initialize?.();
    return relief;
  }

  get version() { return this.#string(this.#e.relief_version()); }

  /** Opens the synthetic room, e.g. 'synthetic:room?seed=2&color=480x270'. */
  openSynthetic(address = 'synthetic:room', { profile = 'live', bodies = 'two-cubes', draws = true } = {}) {
    const bytes = new TextEncoder().encode(address);
    if (bytes.length > TEXT_MAX) throw new Error(`address: ${bytes.length} bytes, at most ${TEXT_MAX}`);
    const at = this.#e.relief_text();
    const memory = new Uint8Array(this.#e.memory.buffer);
    memory.set(bytes, at);
    memory[at + bytes.length] = 0;
    this.#check(this.#e.relief_open_synthetic(profileNumber(profile), bodies === 'two-cubes' ? 1 : 0, draws ? 1 : 0));
  }

  /** Opens a room for frames of the caller's: a pinhole depth camera, pixels. */
  openCamera({ width, height, fx, fy, cx, cy }, { profile = 'live', bodies = 'none', draws = true } = {}) {
    this.#check(this.#e.relief_open_camera(width, height, fx, fy, cx, cy, profileNumber(profile),
      bodies === 'two-cubes' ? 1 : 0, draws ? 1 : 0));
    this.pushedPixels = width * height;
  }

  /** One frame of the synthetic room. False at its end. */
  step() {
    const result = this.#e.relief_step();
    if (result === END) return false;
    this.#check(result);
    return true;
  }

  /** A depth frame: millimetres row by row (Uint16Array), 0 = missing, taken at `timeMs`. */
  push(depth, timeMs) {
    const at = this.#e.relief_depth_in();
    if (at === 0) throw new Error('no room for pushed frames is open: call openCamera first');
    if (depth.length !== this.pushedPixels) {
      throw new Error(`depth has ${depth.length} pixels, the camera ${this.pushedPixels}`);
    }
    new Uint16Array(this.#e.memory.buffer, at, depth.length).set(depth);
    this.#check(this.#e.relief_push(timeMs));
  }

  restart() { this.#check(this.#e.relief_restart()); }
  close() { this.#e.relief_close(); }

  get width() { return this.#e.relief_width(); }
  get height() { return this.#e.relief_height(); }

  /** A plane of the surface, width x height values; see relief.d.ts for names and units. */
  plane(name) {
    if (!(name in PLANES)) throw new Error(`plane '${name}': there are ${Object.keys(PLANES).join(', ')}`);
    const [number, Type] = PLANES[name];
    const at = this.#e.relief_plane(number);
    return at === 0 ? null : new Type(this.#e.memory.buffer, at, this.width * this.height);
  }

  /** The composited picture for putImageData: {data, width, height}; null where none was drawn. */
  picture() {
    const at = this.#e.relief_picture();
    const width = this.#e.relief_picture_width(), height = this.#e.relief_picture_height();
    if (at === 0) return null;
    return { data: new Uint8ClampedArray(this.#e.memory.buffer, at, 4 * width * height), width, height };
  }

  setView(name) {
    const number = VIEWS.indexOf(name);
    if (number < 0) throw new Error(`view '${name}': there are ${VIEWS.join(', ')}`);
    this.#e.relief_set_view(number);
  }

  /** Adds a body: metres, m/s, kg; the world's y goes down. */
  addBody({ shape = 'box', size = [0.1, 0.1, 0.1], position = [0, 0, 1], velocity = [0, 0, 0], mass = 0.1,
    friction = 0.5, restitution = 0.5 } = {}) {
    const type = SHAPES.indexOf(shape);
    if (type < 0) throw new Error(`shape '${shape}': there are ${SHAPES.join(', ')}`);
    const [x, y = x, z = x] = size;
    this.#check(this.#e.relief_add_body(type, x, y, z, ...position, ...velocity, mass, friction, restitution));
  }

  setGravity(x, y, z) { return this.#e.relief_set_gravity(x, y, z) !== 0; }

  /** Bodies after the last frame. */
  bodies() {
    const count = this.#e.relief_body_count();
    const at = count > 0 ? this.#e.relief_bodies() : 0;
    const v = new Float32Array(this.#e.memory.buffer, at, at === 0 ? 0 : count * BODY_FLOATS);
    return Array.from({ length: v.length / BODY_FLOATS }, (_, i) => {
      const b = v.subarray(i * BODY_FLOATS, (i + 1) * BODY_FLOATS);
      return { position: [...b.subarray(0, 3)], quaternion: [...b.subarray(3, 7)], velocity: [...b.subarray(7, 10)],
        shape: SHAPES[b[10]] ?? 'hull', size: [...b.subarray(11, 14)], isAsleep: b[14] !== 0, isHeld: b[15] !== 0 };
    });
  }

  /** Contacts of the last frame. */
  contacts() {
    const count = this.#e.relief_contact_count();
    const at = count > 0 ? this.#e.relief_contacts() : 0;
    const v = new Float32Array(this.#e.memory.buffer, at, at === 0 ? 0 : count * CONTACT_FLOATS);
    return Array.from({ length: v.length / CONTACT_FLOATS }, (_, i) => {
      const c = v.subarray(i * CONTACT_FLOATS, (i + 1) * CONTACT_FLOATS);
      return { point: [...c.subarray(0, 3)], normal: [...c.subarray(3, 6)], impulse: c[6], other: OTHERS[c[7]] };
    });
  }

  /** 16 hexadecimal digits: the same as `relief run --hash` prints for the same frames. */
  hash() { return BigInt.asUintN(64, this.#e.relief_hash()).toString(16).padStart(16, '0'); }

  #string(at) {
    const memory = new Uint8Array(this.#e.memory.buffer);
    let end = at;
    while (memory[end] !== 0) end++;
    return new TextDecoder().decode(memory.subarray(at, end));
  }

  #check(result) {
    if (result !== OK) throw new Error(`relief: ${this.#string(this.#e.relief_error()) || `result ${result}`}`);
  }
}
