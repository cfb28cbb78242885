// Types of relief.js. Lengths are metres; the camera's frame has x right, y down, z forward, and the
// world is the frame of the camera at the start. Arrays are views: they hold until the next step.

export type Profile = 'live' | 'thesis';
export type View = 'camera' | 'depth' | 'normals' | 'mesh' | 'regions' | 'foreground' | 'background' | 'velocity' |
  'thickness' | 'reason' | 'points' | 'contacts' | 'known' | 'hands' | 'map';
export type Shape = 'box' | 'sphere' | 'capsule' | 'cylinder' | 'hull';
export type Quaternion = [number, number, number, number];
export type Vec3 = [number, number, number];
export const VIEWS: readonly View[];

/** A scene of your own; a body's keys are those of scene.json. */
export interface Scene {
  gravity?: Vec3 | 'floor' | null;
  border?: 'extend' | 'open';
  bodies?: (BodyOptions & { hull?: Hull })[];
}

/** Convex and closed, about its centre of mass; faces are counter-clockwise seen from outside. */
export interface Hull { vertices: number[]; triangles: number[]; }

export interface RoomOptions {
  profile?: Profile;
  bodies?: 'none' | 'two-cubes' | Scene;
  /** False: no pictures are drawn. */
  draws?: boolean;
  /** Bodies are lit as the camera's picture is: for real cameras. */
  matchLight?: boolean;
  /** Of the synthetic room: its picture is coarse for a second, and comes sooner. Depth and bodies are the same. */
  opensSoon?: boolean;
  /** Of the synthetic room: what comes after its last frame. */
  end?: 'stop' | 'loop' | 'hold';
}

export interface Lens {
  width: number; height: number; fx: number; fy: number; cx: number; cy: number;
  distortionModel?: 'none' | 'plumb_bob' | 'rational_polynomial';
  /** k1 k2 p1 p2 k3 k4 k5 k6 */
  distortion?: number[];
}

export interface Camera extends Lens {
  /** Of pushed depth; default 1000: millimetres. */
  unitsPerMetre?: number;
  color?: Lens;
  /** p_color = T p_depth; default: they are one camera. */
  colorFromDepth?: { position: number[]; quaternion: number[] };
  /** Nearest and farthest depth, metres. */
  range?: [number, number];
  /** Standard deviation of depth: c0 + c1 z + c2 z^2 metres. */
  noise?: [number, number, number];
  depthOffset?: number;
}

export interface BodyOptions {
  shape?: Shape;
  /** Box: edges. Sphere: radius. Capsule and cylinder: radius, height. */
  size?: number[];
  radius?: number;
  height?: number;
  position?: Vec3;
  orientation?: Quaternion;
  velocity?: Vec3;
  angular_velocity?: Vec3;
  mass?: number;
  friction?: number;
  restitution?: number;
  rolling_resistance?: number;
  gravity_scale?: number;
  release_time?: number;
  collides_with_bodies?: boolean;
  linear_damping?: number;
  angular_damping?: number;
  kinematic?: boolean;
  color?: Vec3;
}

export interface ThrowOptions {
  kind?: 'cube' | 'ball' | 'capsule' | 'cylinder';
  /** Metres, along its longest side. */
  size?: number;
  restitution?: number;
  friction?: number;
  /** Share of the picture's height that the pointer was drawn along: the speed. */
  drag?: number;
}

export interface Body {
  position: number[];
  /** x, y, z, w; body to world. */
  quaternion: number[];
  velocity: number[];
  shape: Shape;
  size: number[];
  isAsleep: boolean;
  isHeld: boolean;
}

export interface Contact {
  point: number[];
  /** Unit, from what was met to the body. */
  normal: number[];
  /** N s during the last frame. */
  impulse: number;
  other: 'body' | 'background' | 'foreground';
}

export interface Planes {
  depth: Float32Array;           // z, 0 = missing
  normalX: Float32Array;         // unit, towards the camera, or 0
  normalY: Float32Array;
  normalZ: Float32Array;
  velocityX: Float32Array;       // m/s
  velocityY: Float32Array;
  velocityZ: Float32Array;
  thickness: Float32Array;       // solid behind depth, along z
  label: Int32Array;             // region, 0 = none
  foreground: Uint8Array;        // 1 = in front of the background
  reason: Uint8Array;            // why a pixel is missing
  backgroundDepth: Float32Array; // the room behind
  rayX: Float32Array;            // the point of pixel i is depth[i] * (rayX[i], rayY[i], 1)
  rayY: Float32Array;
}

export class Relief {
  /** Loads the module; default: relief.wasm beside relief.js. */
  static load(wasm?: URL | string | Response | BufferSource | WebAssembly.Module): Promise<Relief>;
  readonly version: string;
  /** Size of the planes, pixels; 0 before the first frame. */
  readonly width: number;
  readonly height: number;
  openSynthetic(address?: string, options?: RoomOptions): void;
  openCamera(camera: Camera, options?: RoomOptions): void;
  /** One frame of the synthetic room; false at its end. */
  step(): boolean;
  /** One frame of the caller's: depth in the camera's units, 0 = missing, and colour. */
  push(depth: Uint16Array, timeMs: number, rgba?: Uint8ClampedArray | Uint8Array | null): void;
  /** Draws the last frame again, after setView while nothing moves. */
  redraw(): void;
  /** Of the synthetic room: number of the last frame, and how many there are; -1: not known. */
  readonly index: number;
  readonly count: number;
  seek(index: number): void;
  restart(): void;
  close(): void;
  plane<Name extends keyof Planes>(name: Name): Planes[Name] | null;
  picture(): { data: Uint8ClampedArray; width: number; height: number } | null;
  setView(name: View): void;
  /** From where 'points' and 'map' are seen. */
  setOrbit(orbit?: { yaw?: number; pitch?: number; zoom?: number }): void;
  /** Whether what a view's colours mean is drawn into the picture. */
  setLegend(isShown: boolean): void;
  addBody(options?: BodyOptions): void;
  removeAll(): void;
  /** Pixels of the picture, as the five below. */
  throwBody(u: number, v: number, options?: ThrowOptions): void;
  /** A body is held from grab to release; false where there is none. */
  grab(u: number, v: number): boolean;
  drag(u: number, v: number): void;
  reach(steps: number): void;
  release(): void;
  hasBodyAt(u: number, v: number): boolean;
  removeAt(u: number, v: number): boolean;
  setGravity(x: number, y: number, z: number): boolean;
  bodies(): Body[];
  contacts(): Contact[];
  /** What bodies met in the last frame, each once. */
  met(): ('body' | 'background' | 'foreground')[];
  hash(): string;
}
