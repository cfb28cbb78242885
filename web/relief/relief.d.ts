// Types of relief.js. Lengths are metres; the camera's frame has x right, y down, z forward, and the
// world is the frame of the camera at the start. Arrays are views: they hold until the next step.

export type Profile = 'live' | 'thesis';
export type View = 'camera' | 'depth' | 'normals' | 'mesh' | 'regions' | 'foreground' | 'background' | 'velocity' |
  'thickness' | 'reason' | 'points' | 'contacts' | 'known' | 'hands' | 'map';
export type Shape = 'box' | 'sphere' | 'capsule' | 'cylinder';
export type Vec3 = [number, number, number];
export const VIEWS: readonly View[];

export interface RoomOptions {
  profile?: Profile;
  bodies?: 'none' | 'two-cubes';
  /** False: no pictures are drawn. */
  draws?: boolean;
}

export interface Camera { width: number; height: number; fx: number; fy: number; cx: number; cy: number; }

export interface BodyOptions {
  shape?: Shape;
  /** Box: edges. Sphere: radius. Capsule and cylinder: radius, height. */
  size?: number[];
  position?: Vec3;
  velocity?: Vec3;
  mass?: number;
  friction?: number;
  restitution?: number;
}

export interface Body {
  position: number[];
  /** x, y, z, w; body to world. */
  quaternion: number[];
  velocity: number[];
  shape: Shape | 'hull';
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
  /** One frame of the caller's: millimetres, 0 = missing. */
  push(depth: Uint16Array, timeMs: number): void;
  restart(): void;
  close(): void;
  plane<Name extends keyof Planes>(name: Name): Planes[Name] | null;
  picture(): { data: Uint8ClampedArray; width: number; height: number } | null;
  setView(name: View): void;
  addBody(options?: BodyOptions): void;
  setGravity(x: number, y: number, z: number): boolean;
  bodies(): Body[];
  contacts(): Contact[];
  hash(): string;
}
