// Meta's emulator (npm iwer, @iwer/sem) in the page of the AR test: its rooms, its depth repaired, a session in it.
import { Relief } from '/relief/relief.js';
import { RemoteRelief } from '/relief/remote.js';
import { enterAr } from '/relief/xr.js';
import { meshOf } from './ar_rays.mjs';

const NEAR = 0.05; // as xr.js asks for
const FAR = 50;
const FIT = 255 / 256; // the emulator unpacks its depth as if bytes went to 256: too far by this, in the OpenGL depth

/** Metres that the emulator should have given. What is at its far plane is no geometry: 0. */
export function repair(z) {
  if (!(z > 0) || z >= 0.99 * FAR) return 0;
  const d = (FAR - (NEAR * FAR) / z) / (FAR - NEAR) * FIT;
  return (NEAR * FAR) / (FAR - d * (FAR - NEAR));
}

/** What the emulator makes of z metres. */
export function biased(z) {
  const d = (FAR - (NEAR * FAR) / z) / (FAR - NEAR) / FIT;
  return (NEAR * FAR) / (FAR - d * (FAR - NEAR));
}

export const state = { told: [], isRepaired: true, depth: 'given', ar: null, frames: 0, coreMs: [] };

/** The emulator with depth as it should be, or as the test wants it broken. */
function mendDepth() {
  const { getDepthInformation } = XRFrame.prototype;
  XRFrame.prototype.getDepthInformation = function mended(view) {
    const info = getDepthInformation.call(this, view);
    state.looks = (state.looks ?? 0) + 1;
    const isByOldPlanes = state.looks < 6; // the emulator takes the session's near and far after the first frames
    if (info === null || isByOldPlanes || state.depth === 'null') return null;
    const raw = new Float32Array(info.data);
    const metres = state.isRepaired ? raw.map(repair) : raw;
    state.lastDepth ??= {};
    state.lastDepth[view.eye] = { raw, metres, width: info.width, height: info.height };
    const { width, height, normDepthBufferFromNormView, rawValueToMeters } = info;
    const told = state.depth === 'wrong size' ? width + 1 : width;
    return { width: told, height, normDepthBufferFromNormView, rawValueToMeters, data: metres.buffer };
  };
  const { getViewerPose } = XRFrame.prototype;
  XRFrame.prototype.getViewerPose = function lost(space) {
    return state.isLost ? null : getViewerPose.call(this, space);
  };
}

/** Installs the emulator in a room; kinds: which of its captured things are there. */
export async function emulate({ room, kinds = ['mesh'], stereo = true }) {
  const device = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: stereo });
  device.installRuntime({ forceInstall: true });
  device.installSEM(IWER_SEM.SyntheticEnvironmentModule);
  const json = await (await fetch(`/sem/captures/${room}.json`)).json();
  device.sem.loadEnvironment(json);
  device.sem.scene.children.find((child) => child.type === 'GridHelper')?.removeFromParent(); // it is in the depth, too
  if (!kinds.includes('box')) device.sem.boxes.clear();
  device.stereoEnabled = stereo;
  device.sem.meshesVisible = false; // the passthrough picture costs most of a frame: for screenshots only
  mendDepth();
  Object.assign(state, { device, soup: meshOf(device.sem) });
  return { triangles: state.soup.length / 9, planes: device.sem.planes.children.length, boxes: device.sem.boxes.children.length };
}

/** `isElsewhere`: the core is in a worker. */
export async function enter({ isElsewhere = false, ...options } = {}) {
  const canvas = document.createElement('canvas');
  const gl = canvas.getContext('webgl2', { xrCompatible: true, alpha: true, preserveDrawingBuffer: true });
  const relief = isElsewhere ? await RemoteRelief.start({ wasm: '/relief/relief.wasm' }) : await Relief.load('/relief/relief.wasm');
  state.ar = await enterAr(relief, {
    gl,
    clock: () => (state.ms = (state.ms ?? 0) + 1000 / 30), // a frame is 1/30 s, however slow this machine is
    tell: (kind, words) => state.told.push([kind, words]),
    onFrame: (told) => {
      state.frames++;
      state.last = told;
      if (told.ar.coreMs !== undefined) state.coreMs.push(told.ar.coreMs);
      state.hook?.(told);
    },
    ...options,
  });
  state.relief = relief;
  await frames(60, ({ ar }) => ar.see.isOpen);
  return { usage: state.ar.session.depthUsage, format: state.ar.session.depthDataFormat };
}

/** Waits for so many frames, or until `when` is true. */
export function frames(count, when = () => false) {
  const until = state.frames + count;
  return new Promise((resolve) => {
    state.hook = (told) => {
      if (state.frames < until && !when(told)) return;
      state.hook = null;
      resolve(told);
    };
  });
}

/** Head at a place, turned about y and then x. */
export function look([x, y, z], yaw, pitch) {
  const { position, quaternion } = state.device;
  position.set(x, y, z);
  const [cy, sy, cp, sp] = [Math.cos(yaw / 2), Math.sin(yaw / 2), Math.cos(pitch / 2), Math.sin(pitch / 2)];
  quaternion.set(cy * sp, sy * cp, -sy * sp, cy * cp);
}

/** The passthrough picture of both eyes in the next frames; the emulator draws one over both. For screenshots. */
export function showRoom(isShown) {
  const { sem } = state.device;
  sem.meshesVisible = isShown;
  state.render ??= sem.render.bind(sem);
  sem.render = () => {
    state.render();
    if (!isShown || !state.last) return;
    const { renderer, scene, camera } = sem, { pose, layer } = state.last, ratio = renderer.getPixelRatio();
    renderer.setScissorTest(true);
    for (const view of pose.views) {
      const { x, y, width, height } = layer.getViewport(view);
      const at = [x, y, width, height].map((value) => value / ratio);
      renderer.setViewport(...at);
      renderer.setScissor(...at);
      camera.projectionMatrix.fromArray(view.projectionMatrix);
      camera.position.set(...view.transform.matrix.slice(12, 15));
      renderer.render(scene, camera);
    }
    renderer.setScissorTest(false);
    camera.updateProjectionMatrix();
  };
}
