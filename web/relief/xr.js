// A see-through session: a headset's or a phone's depth into Relief, its bodies into both eyes.
import { SeeThrough } from './xr_core.js';
import { DepthReader } from './xr_depth.js';
import { BodyDrawer } from './xr_draw.js';
import { Hands } from './xr_hands.js';
import { RemoteSee } from './xr_remote.js';
import { Anchors, DetectedRoom } from './xr_room.js';

const PIXELS = 40000;      // of depth that the core takes of a frame: 320 x 320 gives every second one
const SILENT_MS = 500;     // without depth: it is told, and bodies wait
const AHEAD_S = 0.05;      // at most, that bodies are drawn ahead of the core
const OPTIONAL = ['hand-tracking', 'anchors', 'plane-detection', 'mesh-detection', 'hit-test'];
const FORMATS = ['float32', 'unsigned-short', 'luminance-alpha'];

/** Whether this browser offers AR with depth: {isOffered, why}. */
export async function arSupport(xr = globalThis.navigator?.xr) {
  if (!globalThis.isSecureContext) return { isOffered: false, why: 'AR needs https, or localhost' };
  if (!xr) return { isOffered: false, why: 'this browser has no WebXR' };
  if (!(await xr.isSessionSupported('immersive-ar').catch(() => false))) {
    return { isOffered: false, why: 'this browser, or this device, has no immersive AR' };
  }
  if (typeof globalThis.XRFrame?.prototype.getDepthInformation !== 'function' && !('XRDepthInformation' in globalThis)) {
    return { isOffered: false, why: 'this browser has AR, but no depth sensing' };
  }
  return { isOffered: true, why: '' };
}

const REFUSALS = {
  NotAllowedError: 'AR was not permitted: allow it in the browser, and press the button again',
  SecurityError: 'AR was not permitted here: it needs https and a press of the button',
  NotSupportedError: 'this device has no AR with depth sensing',
  InvalidStateError: 'another AR session is running: end it first',
};

function sessionInit({ usage, formats, matchDepthView }) {
  return {
    requiredFeatures: ['depth-sensing', 'local-floor'],
    optionalFeatures: OPTIONAL,
    depthSensing: { usagePreference: usage, dataFormatPreference: formats, depthTypeRequest: ['raw'], matchDepthView },
  };
}

/** Starts a session; call it from a press of a button. `relief`: a Relief or a RemoteRelief, or a function that loads one: a
 * browser forgets the press while it loads, so the session is asked for first. An error in words where it cannot be had. */
export async function enterAr(relief, options = {}) {
  const { xr = navigator.xr, tell = () => {}, depth = {} } = options;
  const init = sessionInit({ usage: ['cpu-optimized', 'gpu-optimized'], formats: FORMATS, matchDepthView: true, ...depth });
  let session;
  try {
    session = await xr.requestSession('immersive-ar', init);
  } catch (error) {
    const words = REFUSALS[error.name] ?? `AR did not start: ${error.message}`;
    tell('denied', words);
    throw new Error(words, { cause: error });
  }
  try {
    const ar = new ArSession(typeof relief === 'function' ? await relief() : relief, session, options);
    await ar.start();
    return ar;
  } catch (error) {
    await session.end().catch(() => {});
    throw error;
  }
}

export class ArSession {
  #told = new Map();
  #lastDepthMs = null;
  #pushedMs = 0;
  #isOver = false;

  constructor(relief, session, { gl, tell = () => {}, onFrame = () => {}, every = 'auto', gravity = null,
    clock = (time) => time, layer = (s, context) => new XRWebGLLayer(s, context), binding = (s, context) => new XRWebGLBinding(s, context) } = {}) {
    this.context = gl ?? document.createElement('canvas').getContext('webgl2', { xrCompatible: true, alpha: true });
    if (!this.context) throw new Error('AR needs WebGL 2');
    Object.assign(this, { relief, session, onFrame, every, gravity, clock, makeLayer: layer, makeBinding: binding });
    this.say = tell;
    this.see = relief.isElsewhere ? new RemoteSee(relief) : new SeeThrough(relief.local ?? relief);
    this.ended = new Promise((resolve) => { this.resolveEnded = resolve; });
  }

  async start() {
    const { session, context } = this;
    session.addEventListener('end', () => this.#over('the AR session has ended'));
    session.addEventListener('select', (event) => this.#select(event));
    session.addEventListener('visibilitychange', () => {
      this.#tell('visible', session.visibilityState === 'visible' ? '' : 'AR is hidden: bodies wait');
    });
    context.canvas.addEventListener('webglcontextlost', () => {
      this.#over('the GPU was lost: start AR again');
      session.end().catch(() => {});
    }, { once: true });
    await context.makeXRCompatible?.();
    session.updateRenderState({ baseLayer: this.makeLayer(session, context), depthNear: 0.05, depthFar: 50 });
    this.space = await session.requestReferenceSpace('local-floor');
    this.space.addEventListener?.('reset', () => this.#beginAnew());
    this.reader = new DepthReader(session, context, this.makeBinding);
    this.drawer = new BodyDrawer(context);
    this.hands = new Hands(this.see, (place) => this.addBall(place));
    this.room = new DetectedRoom(this.see, (kind, words) => this.#tell(kind, words));
    this.anchors = new Anchors(this.see, (kind, words) => this.#tell(kind, words));
    this.#tell('session', `AR runs: ${session.depthUsage} depth, ${session.depthDataFormat}`);
    session.requestAnimationFrame((time, frame) => this.#frame(time, frame));
  }

  /** A ball at a place, metres of the local-floor space. */
  addBall(position, velocity = [0, 0, 0], radius = 0.05) {
    if (!this.see.isOpen) return;
    this.see.addBody({ shape: 'sphere', size: [radius], position, velocity });
  }

  end() { return this.session.end(); }

  // ---- one frame

  #frame(time, frame) {
    if (this.#isOver) return;
    this.session.requestAnimationFrame((t, f) => this.#frame(t, f));
    try {
      this.#step(this.clock(time), frame);
    } catch (error) {
      this.#tell('frame', error.message);
    }
  }

  #step(time, frame) {
    const pose = frame.getViewerPose(this.space);
    const layer = this.session.renderState.baseLayer;
    this.#clear(layer);
    this.#tell('tracking', pose ? '' : 'the device does not know where it is: bodies wait; look about slowly');
    if (!pose) return;
    const depths = pose.views.map((view) => this.#depth(frame, view));
    const seen = depths.find((depth) => depth !== null) ?? null;
    this.#silence(time, seen);
    const buffer = seen && this.reader.bytes(seen);
    if (buffer) this.#push(frame, buffer, pose.transform.matrix, time);
    this.#draw(pose, depths, layer, time);
    this.onFrame({ time, frame, pose, depths, layer, ar: this });
  }

  #depth(frame, view) {
    try {
      const depth = this.reader.read(frame, view);
      if (depth) this.#tell('buffer', '');
      return depth;
    } catch (error) {
      this.#tell('buffer', error.message);
      return null;
    }
  }

  #silence(time, seen) {
    this.#lastDepthMs = seen || this.#lastDepthMs === null ? time : this.#lastDepthMs;
    const isSilent = time - this.#lastDepthMs > SILENT_MS;
    this.#tell('depth', isSilent ? 'the device gives no depth: bodies wait' : '');
  }

  #push(frame, buffer, head, timeMs) {
    const every = this.every === 'auto' ? Math.ceil(Math.sqrt((buffer.width * buffer.height) / PIXELS)) : this.every;
    const whole = { ...buffer, head, timeMs, every };
    try {
      if (!this.see.isOpen || this.isCameraNew) this.#open(whole);
      this.#touch(frame, head);
      this.see.send(whole, (said) => this.#take(said, timeMs));
    } catch (error) {
      this.#tell('core', error.message);
    }
  }

  /** What the core says of a frame: at once, or later where it has a thread of its own. */
  #take({ isNew, troubles, ms }, timeMs) {
    if (this.#isOver) return;
    this.coreMs = ms;
    this.#pushedMs = isNew ? timeMs : this.#pushedMs;
    const isOld = isNew === false && timeMs - this.#pushedMs > SILENT_MS;
    this.#tell('old', isOld ? 'the device repeats its last depth: bodies wait' : '');
    const [trouble] = troubles;
    this.#tell('core', trouble?.[2] ?? '');
    this.isCameraNew = troubles.some(([, name]) => name === 'CameraChanged');
  }

  #open(buffer) {
    this.see.open(buffer);
    this.isCameraNew = false;
    this.room.forget();
    if (this.gravity) this.see.setGravity(...this.gravity);
  }

  /** What touches bodies beside the depth moves first. Each by itself: depth goes on without any of them. */
  #touch(frame, head) {
    const { space } = this;
    const steps = {
      hands: () => { this.handsSeen = this.hands.update(frame, this.session.inputSources, space); },
      room: () => this.room.update(frame, space, head),
      anchors: () => this.anchors.update(frame, space, this.see.bodies()),
    };
    for (const [kind, step] of Object.entries(steps)) {
      try {
        step();
      } catch (error) {
        this.#tell(kind, error.message);
      }
    }
  }

  #clear(layer) {
    const gl = this.context;
    gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
    gl.disable(gl.SCISSOR_TEST);
    gl.depthMask(true);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  #draw(pose, depths, layer, time) {
    const gl = this.context;
    const ahead = Math.min(AHEAD_S, Math.max(0, (time - this.#pushedMs) / 1000));
    this.drawer.take(this.see.isOpen ? this.see.bodies() : [], ahead);
    gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
    pose.views.forEach((view, i) => {
      const { x, y, width, height } = layer.getViewport(view);
      gl.viewport(x, y, width, height);
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(x, y, width, height);
      this.drawer.draw(view, depths[i]);
    });
    gl.disable(gl.SCISSOR_TEST);
  }

  // ---- what is pressed, and what is told

  /** A tap or a trigger throws a ball; a hand's pinch is answered by Hands. */
  #select({ frame, inputSource }) {
    const pose = inputSource.hand ? null : frame.getPose(inputSource.targetRaySpace, this.space);
    if (!pose) return;
    const m = pose.transform.matrix;
    const way = [-m[8], -m[9], -m[10]];
    this.addBall(way.map((x, k) => m[12 + k] + 0.2 * x), way.map((x) => 3 * x));
  }

  #beginAnew() {
    this.see.isOpen = false;
    this.room.forget();
    this.say('space', 'the device has moved its origin: the room begins anew');
  }

  /** Each kind of trouble once, and '' when it is over. */
  #tell(kind, words) {
    if ((this.#told.get(kind) ?? '') === words) return;
    this.#told.set(kind, words);
    this.say(kind, words);
  }

  #over(words) {
    if (this.#isOver) return;
    this.#isOver = true;
    this.#tell('ended', words);
    this.see.close();
    this.resolveEnded(words);
  }
}
