// WebXR's own types are those of @types/webxr, where a page has them.
import type { Body, BodyOptions, Relief } from './relief.js';
import type { RemoteRelief } from './remote.js';

export type DepthFormat = 'luminance-alpha' | 'unsigned-short' | 'float32';
export type BodyId = [number, number];

/** A depth buffer with its view. Matrices are 4x4 by columns, as WebXR gives them. */
export interface DepthBuffer {
  width: number;
  height: number;
  /** Row by row, without padding; 0 = missing. */
  data: ArrayBuffer;
  format: DepthFormat;
  /** normDepthBufferFromNormView: quarters of a turn, mirroring, crop and scale; anything else is refused. */
  bufferFromView: ArrayLike<number>;
  /** Of the depth view; off-axis or not. */
  projection: ArrayLike<number>;
  /** Of the depth view in the world: y up, metres. */
  pose: ArrayLike<number>;
  /** Of who looks; tells an old buffer from a room at rest. Default: pose. */
  head?: ArrayLike<number>;
  rawToMetres: number;
  /** Above 0: the values are an OpenGL depth of such planes, as Quest gives them; far may be infinite. */
  near?: number;
  far?: number;
  /** Never goes back. */
  timeMs: number;
  /** 1: all pixels go to the core; 2: every second of every second row. Default 1. */
  every?: number;
}

/** The depth camera is another than the room was opened for: open it again, bodies stay. */
export class CameraChanged extends Error {}

/** A see-through room in the core, without WebXR. */
export class SeeThrough {
  constructor(relief: Relief);
  readonly isOpen: boolean;
  open(buffer: DepthBuffer): this;
  /** False: it is the last buffer again. Throws in words, and the room goes on. */
  push(buffer: DepthBuffer): boolean;
  camera(): { position: number[]; quaternion: number[] };
  bodies(): (Body & { id: BodyId })[];
  /** Balls do not roll for ever. Sizes as BodyOptions has them. */
  addBody(body?: BodyOptions & { quaternion?: number[] }): void;
  place(id: BodyId, position: ArrayLike<number>, quaternion: ArrayLike<number>): boolean;
  remove(id: BodyId): void;
  /** 24 bones of 8 floats: an end, the other end, radius, 0. null: not seen. */
  hand(which: 0 | 1, bones: Float32Array | null): void;
  /** True while the hand holds a body. null: it does not pinch. */
  pinch(which: 0 | 1, position: ArrayLike<number> | null, quaternion?: ArrayLike<number>): boolean;
  /** m/s^2; y is up. */
  setGravity(x: number, y: number, z: number): void;
  addBox(size: [number, number, number], position: number[], quaternion: number[]): number;
  addHull(corners: number[], triangles: number[], position: number[], quaternion: number[]): number;
  removeStatic(handle: number): void;
  close(): void;
}

export type ArTrouble = 'denied' | 'session' | 'visible' | 'tracking' | 'depth' | 'buffer' | 'old' | 'core' | 'room'
  | 'hands' | 'anchors' | 'space' | 'frame' | 'ended';

export interface ArOptions {
  xr?: unknown;
  /** A context made with xrCompatible: true. Default: one of its own. */
  gl?: WebGL2RenderingContext;
  /** Each trouble once, in words; '' when it is over. */
  tell?: (kind: ArTrouble, words: string) => void;
  onFrame?: (told: object) => void;
  depth?: { usage?: ('cpu-optimized' | 'gpu-optimized')[]; formats?: DepthFormat[]; matchDepthView?: boolean };
  /** Of the depth buffer's pixels every n-th goes to the core. Default 'auto': at most 40000. */
  every?: 'auto' | number;
  /** The time of a frame, ms, by what the device says: for tests and slow motion. */
  clock?: (timeMs: number) => number;
  /** m/s^2; y is up. Default 0, -9.81, 0. */
  gravity?: [number, number, number] | null;
}

export interface ArSession {
  /** Of a RemoteRelief: what it returns is what the core said last. */
  readonly see: Pick<SeeThrough, 'isOpen' | 'bodies' | 'addBody' | 'place' | 'remove' | 'setGravity' | 'hand' | 'pinch'>;
  /** Milliseconds of the core's last frame. */
  readonly coreMs: number;
  /** Resolves to words when the session is over. */
  readonly ended: Promise<string>;
  addBall(position: number[], velocity?: number[], radius?: number): void;
  end(): Promise<void>;
}

export function arSupport(xr?: unknown): Promise<{ isOffered: boolean; why: string }>;
/** Call it from a press of a button; a function loads the module once the session is there. */
export function enterAr(relief: Relief | RemoteRelief | (() => Promise<Relief | RemoteRelief>), options?: ArOptions): Promise<ArSession>;
