// A file that was dropped: which recording it is, by its first bytes.
import { openFolder } from './folder.js';
import { isMcap } from './mcap.js';
import { openRos } from './ros.js';

const SIDE_MAX = 16384;

function checkCamera(camera, name) {
  for (const { width, height } of [camera, camera.color].filter(Boolean)) {
    const isSize = (n) => Number.isInteger(n) && n > 0 && n <= SIDE_MAX;
    if (!isSize(width) || !isSize(height)) throw new Error(`${name}: its camera has ${width} x ${height} pixels`);
  }
}

/** {name, camera, gravity, isSimulated, frames: [{timeMs, depth(), color()}]}. */
export async function openRecording(file, onProgress = () => {}) {
  const head = new Uint8Array(await file.slice(0, 8).arrayBuffer());
  const isZip = head[0] === 0x50 && head[1] === 0x4b;
  if (!isZip && !isMcap(head)) {
    throw new Error(`${file.name}: is no recording that can be read here: MCAP, or a TUM folder as zip`);
  }
  const recording = isZip ? await openFolder(file, file.name) : await openRos(file, file.name, onProgress);
  checkCamera(recording.camera, file.name);
  return recording;
}
