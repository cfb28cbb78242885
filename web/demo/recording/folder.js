// A TUM folder in a zip: depth.txt, rgb.txt and camera.json, or as much of them as there is.
import { openZip } from './zip.js';
import { decodeColor, decodeDepth, pictureSize } from './pictures.js';
import { quaternionOf } from './pose.js';

const PAIR_MS = 50;

/** Lines "time name", times in milliseconds from the first. */
function readList(text) {
  return text.split('\n').map((line) => line.trim()).filter((line) => line !== '' && !line.startsWith('#'))
    .map((line) => {
      const [time, ...rest] = line.split(/\s+/);
      return { time: 1000 * Number(time), path: rest.join(' ') };
    }).filter(({ time, path }) => Number.isFinite(time) && path !== '').sort((a, b) => a.time - b.time);
}

/** The PNG files of depth/, 30 a second. */
function guessList(files, folder) {
  return [...files.keys()].filter((path) => path.startsWith(folder) && /\.(png|jpe?g)$/i.test(path)).sort()
    .map((path, i) => ({ time: i * 1000 / 30, path }));
}

async function textOf(files, path) {
  const read = files.get(path);
  return read ? new TextDecoder().decode(await read()) : null;
}

async function listOf(files, list, folder) {
  const text = await textOf(files, list);
  return text === null ? guessList(files, folder) : readList(text);
}

function lensOf({ distortion_model: distortionModel = 'none', distortion = [], width, height, fx, fy, cx, cy }) {
  return { width, height, fx, fy, cx, cy, distortionModel, distortion };
}

function cameraOf({ depth, color, depth_to_color: move }, name) {
  if (!depth) throw new Error(`${name}: its camera.json has no "depth"`);
  const { units_per_metre: unitsPerMetre = 1000, noise, depth_offset_m: depthOffset = 0 } = depth;
  const range = [depth.depth_min_m ?? 0.1, depth.depth_max_m ?? 8];
  const pose = move ? { position: move.translation ?? [0, 0, 0],
    quaternion: move.quaternion ?? (move.rotation ? quaternionOf(move.rotation) : [0, 0, 0, 1]) } : undefined;
  return { ...lensOf(depth), unitsPerMetre, range, depthOffset, ...(noise ? { noise } : {}),
    ...(color ? { color: lensOf(color) } : {}), ...(pose ? { colorFromDepth: pose } : {}) };
}

/** Without camera.json: a Kinect's lens, 57 degrees wide, and TUM's units. */
function guessCamera(size, hasColor) {
  const f = 525 * size.width / 640;
  const lens = { ...size, fx: f, fy: f, cx: (size.width - 1) / 2, cy: (size.height - 1) / 2 };
  return { ...lens, unitsPerMetre: 5000, ...(hasColor ? { color: lens } : {}) };
}

async function readCamera(files, depth, colors, name) {
  const text = await textOf(files, 'camera.json');
  if (text !== null) {
    try {
      return cameraOf(JSON.parse(text), name);
    } catch (error) {
      throw new Error(`${name}: camera.json: ${error.message}`, { cause: error });
    }
  }
  const size = pictureSize(await files.get(depth[0].path)());
  if (!size) throw new Error(`${name}: ${depth[0].path} is no picture`);
  return guessCamera(size, colors.length > 0);
}

function frameOf(files, entry, colors, camera, name) {
  const near = colors.reduce((best, c) => (Math.abs(c.time - entry.time) < Math.abs((best?.time ?? Infinity) - entry.time) ? c : best), null);
  const isPair = near !== null && Math.abs(near.time - entry.time) <= PAIR_MS;
  return {
    timeMs: entry.time,
    async depth() { return decodeDepth(await files.get(entry.path)(), 'png', camera, `${name}: ${entry.path}`); },
    async color() {
      if (!isPair || !camera.color) return null;
      return decodeColor(await files.get(near.path)(), camera.color, `${name}: ${near.path}`);
    },
  };
}

/** The files below the folder that holds depth.txt or depth/, wherever it is in the zip. */
function rootOf(files, name) {
  const marks = [...files.keys()].map((path) => path.match(/^(.*?)(depth\.txt|depth\/[^/]+\.png)$/)).filter(Boolean);
  if (marks.length === 0) throw new Error(`${name}: has neither depth.txt nor depth/*.png, so it is no TUM folder`);
  const root = marks.map((mark) => mark[1]).sort((a, b) => a.length - b.length)[0];
  return new Map([...files].filter(([path]) => path.startsWith(root)).map(([path, read]) => [path.slice(root.length), read]));
}

/** {name, camera, gravity, isSimulated, frames}. */
export async function openFolder(blob, name) {
  const files = rootOf(await openZip(blob, name), name);
  const isThere = ({ path }) => files.has(path);
  const depth = (await listOf(files, 'depth.txt', 'depth/')).filter(isThere);
  const colors = (await listOf(files, 'rgb.txt', 'rgb/')).filter(isThere);
  if (depth.length === 0) throw new Error(`${name}: has no depth picture`);
  const camera = await readCamera(files, depth, colors, name);
  const source = JSON.parse(await textOf(files, 'source.json') ?? '{}');
  const gravity = source.gravity?.some((g) => g !== 0) ? source.gravity : null;
  const start = depth[0].time;
  const frames = depth.map((entry) => frameOf(files, entry, colors, camera, name));
  for (const frame of frames) frame.timeMs -= start;
  return { name, camera, gravity, isSimulated: source.is_simulated === true, frames };
}
