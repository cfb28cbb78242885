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
  'velocity', 'thickness', 'reason', 'points', 'contacts', 'known', 'hands', 'map', 'bodies'];
const SHAPES = ['box', 'sphere', 'capsule', 'cylinder', 'hull'];
const KINDS = ['cube', 'ball', 'capsule', 'cylinder'];
const OTHERS = ['body', 'background', 'foreground'];
const ENDS = ['stop', 'loop', 'hold'];
const LENSES = ['none', 'plumb_bob', 'rational_polynomial'];
const OK = 0, END = 2;
const BODY_FLOATS = 16, CONTACT_FLOATS = 8;
const TEXT_MAX = 511;

// Where a body's numbers go: web/core/scene.c has the same list.
const BODY = { size: 1, radius: 4, height: 5, mass: 6, position: 7, orientation: 10, velocity: 14, angular_velocity: 17,
  restitution: 20, friction: 21, gravity_scale: 22, release_time: 23, collides_with_bodies: 24, rolling_resistance: 25,
  linear_damping: 26, angular_damping: 27, kinematic: 28, color: 29 };
const BODY_NUMBERS = 32, RIG_NUMBERS = 44, CAMERA_NUMBERS = 15;

function indexOf(list, name, what) {
  const index = list.indexOf(name);
  if (index < 0) throw new Error(`${what} '${name}': there are ${list.join(', ')}`);
  return index;
}

function cameraNumbers({ width, height, fx, fy, cx, cy, distortionModel = 'none', distortion = [] }) {
  const lens = indexOf(LENSES, distortionModel, 'distortion model');
  return [width, height, fx, fy, cx, cy, lens, ...Array.from({ length: 8 }, (_, i) => distortion[i] ?? 0)];
}

/** As web/core/rig.c reads it. */
function rigNumbers(camera) {
  const { color, colorFromDepth = {}, range = [0, 0], noise = [0, 0, 0], depthOffset = 0 } = camera;
  const { position = [0, 0, 0], quaternion = [0, 0, 0, 1] } = colorFromDepth;
  const none = Array.from({ length: CAMERA_NUMBERS }, () => 0);
  return [...cameraNumbers(camera), ...(color ? cameraNumbers(color) : none), color ? 1 : 0, ...position, ...quaternion,
    ...range, ...noise, depthOffset];
}

/** Box: edges, or one for all. Sphere: radius. Capsule and cylinder: radius, height. */
function sizeOf(shape, size) {
  if (size === undefined) return {};
  const [x, y = x, z = x] = size;
  return shape === 'box' ? { size: [x, y, z] } : { radius: x, height: y };
}

/** The module, compiled. `wasm`: as load has it. */
export async function compileRelief(wasm) {
  let source = await wasm ?? new URL('relief.wasm', import.meta.url);
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof URL || typeof source === 'string') {
    const url = new URL(source, import.meta.url);
    if (url.protocol === 'file:' && typeof process !== 'undefined') {
      const { readFile } = await import('node:fs/promises');
      source = await readFile(url);
    } else {
      source = await fetch(url);
    }
  }
  if (typeof Response === 'undefined' || !(source instanceof Response)) return WebAssembly.compile(source);
  if (!source.ok) throw new Error(`${source.url}: ${source.status} ${source.statusText}`);
  const isTyped = source.headers.get('content-type') === 'application/wasm'; // what compiling while it comes asks for
  return isTyped ? WebAssembly.compileStreaming(source) : WebAssembly.compile(await source.arrayBuffer());
}

export class Relief {
  #e;

  /** Loads the module. `wasm`: a URL, a Response, bytes or a WebAssembly.Module. */
  static async load(wasm) {
    const relief = new Relief();
    relief.#e = (await WebAssembly.instantiate(await compileRelief(wasm), {})).exports;
    relief.#e._initialize?.();
    return relief;
  }

  /** The module's own functions: for xr_core.js. */
  get functions() { return this.#e; }

  /** What went wrong last, in words. */
  get trouble() { return this.#string(this.#e.relief_error()); }

  get version() { return this.#string(this.#e.relief_version()); }

  /** Opens the synthetic room, e.g. 'synthetic:room?seed=2&color=480x270'. */
  openSynthetic(address = 'synthetic:room', options = {}) {
    const { profile, scene, flags, end } = this.#options(options, 'two-cubes');
    this.#write(address);
    this.#check(this.#e.relief_open_synthetic(profile, scene, flags, end));
  }

  /** Opens a room for frames of the caller's: a depth camera in pixels, with `color` beside it if it has one. */
  openCamera(camera, options = {}) {
    const { profile, scene, flags } = this.#options(options, 'none');
    new Float64Array(this.#e.memory.buffer, this.#e.relief_rig_in(), RIG_NUMBERS).set(rigNumbers(camera));
    this.#check(this.#e.relief_open_camera(camera.unitsPerMetre ?? 1000, profile, scene, flags));
    this.pushedPixels = camera.width * camera.height;
  }

  /** One frame of the synthetic room. False at its end. */
  step() {
    const result = this.#e.relief_step();
    if (result === END) return false;
    this.#check(result);
    return true;
  }

  /** A depth frame (Uint16Array, row by row, 0 = missing) taken at `timeMs`; `rgba`: its colour, or nothing. */
  push(depth, timeMs, rgba = null) {
    const at = this.#e.relief_depth_in();
    if (at === 0) throw new Error('no room for pushed frames is open: call openCamera first');
    if (depth.length !== this.pushedPixels) {
      throw new Error(`depth has ${depth.length} pixels, the camera ${this.pushedPixels}`);
    }
    new Uint16Array(this.#e.memory.buffer, at, depth.length).set(depth);
    const color = rgba === null ? 0 : this.#e.relief_color_in();
    if (color !== 0) new Uint8Array(this.#e.memory.buffer, color, rgba.length).set(rgba);
    this.#check(this.#e.relief_push(timeMs, color === 0 ? 0 : 1));
  }

  /** Draws the last frame again: after setView while nothing moves. */
  redraw() { this.#check(this.#e.relief_redraw()); }

  /** Number of the synthetic room's last frame, and how many there are; -1: not known. */
  get index() { return this.#e.relief_index(); }
  get count() { return this.#e.relief_count(); }
  seek(index) { this.#check(this.#e.relief_seek(index)); }

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

  setView(name) { this.#e.relief_set_view(indexOf(VIEWS, name, 'view')); }
  /** From where 'points' and 'map' are seen: radians, and a distance over the usual one. */
  setOrbit({ yaw = 0, pitch = 0, zoom = 1 } = {}) { this.#e.relief_set_orbit(yaw, pitch, zoom); }
  /** Whether what a view's colours mean is drawn into the picture. */
  setLegend(isShown) { this.#e.relief_set_legend(isShown ? 1 : 0); }

  /** Adds a body: metres, m/s, kg; the world's y goes down. */
  addBody(body = {}) {
    this.#writeBody(body);
    this.#check(this.#e.relief_add_body());
  }

  removeAll() { this.#e.relief_remove_all(); }

  /** Throws a body from the camera through a pixel of the picture; drag: share of its height, for the speed. */
  throwBody(u, v, { kind = 'cube', size = 0.12, restitution = 0.5, friction = 0.5, drag = 0 } = {}) {
    this.#check(this.#e.relief_throw(u, v, drag, indexOf(KINDS, kind, 'kind'), size, restitution, friction));
  }

  /** A body is held from grab to release, and follows drag; false where there is none. */
  grab(u, v) { return this.#e.relief_grab(u, v) !== 0; }
  drag(u, v) { this.#e.relief_drag(u, v); }
  /** steps > 0: what is held comes nearer. */
  reach(steps) { this.#e.relief_reach(steps); }
  release() { this.#e.relief_release(); }
  hasBodyAt(u, v) { return this.#e.relief_has_body_at(u, v) !== 0; }
  removeAt(u, v) { return this.#e.relief_remove(u, v) !== 0; }

  setGravity(x, y, z) { return this.#e.relief_set_gravity(x, y, z) !== 0; }

  /** Bodies after the last frame. */
  bodies() {
    const count = this.#e.relief_body_count();
    const at = count > 0 ? this.#e.relief_bodies() : 0;
    const v = new Float32Array(this.#e.memory.buffer, at, at === 0 ? 0 : count * BODY_FLOATS);
    return Array.from({ length: v.length / BODY_FLOATS }, (_, i) => {
      const b = v.subarray(i * BODY_FLOATS, (i + 1) * BODY_FLOATS);
      return { position: [...b.subarray(0, 3)], quaternion: [...b.subarray(3, 7)], velocity: [...b.subarray(7, 10)],
        shape: SHAPES[b[10]], size: [...b.subarray(11, 14)], isAsleep: b[14] !== 0, isHeld: b[15] !== 0 };
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

  /** What bodies met in the last frame, each once: 'body', 'background', 'foreground'. */
  met() { return [...new Set(this.contacts().map(({ other }) => other))]; }

  /** 16 hexadecimal digits: the same as `relief run --hash` prints for the same frames. */
  hash() { return BigInt.asUintN(64, this.#e.relief_hash()).toString(16).padStart(16, '0'); }

  #options({ profile = 'live', bodies, draws = true, matchLight = false, opensSoon = false, end = 'stop' }, usual) {
    const chosen = bodies ?? usual;
    if (typeof chosen === 'object') this.#writeScene(chosen);
    const scene = typeof chosen === 'object' ? 2 : indexOf(['none', 'two-cubes'], chosen, 'bodies');
    return { profile: indexOf(['live', 'thesis'], profile, 'profile'), scene,
      flags: (draws ? 1 : 0) | (matchLight ? 2 : 0) | (opensSoon ? 4 : 0), end: indexOf(ENDS, end, 'end') };
  }

  #write(text) {
    const bytes = new TextEncoder().encode(text);
    if (bytes.length > TEXT_MAX) throw new Error(`address: ${bytes.length} bytes, at most ${TEXT_MAX}`);
    const at = this.#e.relief_text();
    const memory = new Uint8Array(this.#e.memory.buffer);
    memory.set(bytes, at);
    memory[at + bytes.length] = 0;
  }

  /** {gravity: [x, y, z] | 'floor' | null, border: 'extend' | 'open', bodies: [...]}: keys as in scene.json. */
  #writeScene({ gravity = null, border = 'extend', bodies = [] }) {
    const kind = gravity === 'floor' ? 2 : gravity === null ? 0 : 1;
    const [x, y, z] = kind === 1 ? gravity : [0, 0, 0];
    this.#e.relief_scene_begin(kind, x, y, z, border === 'open' ? 1 : 0);
    let hull = null;
    for (const body of bodies) {
      if (body.hull && body.hull !== hull) this.#writeHull(body.hull);
      hull = body.hull ?? hull;
      this.#writeBody(body);
      this.#check(this.#e.relief_scene_add());
    }
  }

  #writeHull({ vertices, triangles }) {
    const at = this.#e.relief_scene_hull(vertices.length / 3, triangles.length / 3);
    if (at === 0) this.#check(-1);
    new Float64Array(this.#e.memory.buffer, at, vertices.length).set(vertices);
    new Int32Array(this.#e.memory.buffer, at + 8 * vertices.length, triangles.length).set(triangles);
  }

  #writeBody(body) {
    const numbers = new Float64Array(this.#e.memory.buffer, this.#e.relief_body_in(), BODY_NUMBERS);
    const { shape = 'box', size, quaternion, ...rest } = body;
    numbers[0] = indexOf(SHAPES, shape, 'shape');
    const all = { ...sizeOf(shape, size), ...rest, ...(quaternion ? { orientation: quaternion } : {}) };
    for (const [key, at] of Object.entries(BODY)) {
      if (all[key] !== undefined) numbers.set([all[key]].flat().map(Number), at);
    }
  }

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
