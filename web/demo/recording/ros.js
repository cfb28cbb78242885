// A recording of a depth camera in MCAP, as Relief records it and as ROS 2 does: which topic is what.
import { Mcap } from './mcap.js';
import { readCameraInfo, readCompressed, readImage, readTransforms } from './messages.js';
import { findPose } from './pose.js';
import { decodeColor, decodeDepth, rawDepth } from './pictures.js';

const PAIR_NS = 50000000n; // depth and colour further apart do not belong together

function kindOf(mcap, channel) {
  const type = mcap.typeOf(channel).split('/').pop();
  const { topic } = channel;
  if (channel.encoding !== 'cdr') return '';
  if (type === 'CameraInfo') return 'info';
  if (type === 'TFMessage') return 'tf';
  if (type === 'CompressedImage') return /compressedDepth$/.test(topic) ? 'depth' : 'color';
  if (type === 'Image') return /depth/.test(topic) ? 'raw depth' : '';
  return '';
}

function channelsOf(mcap, ...kinds) {
  return [...mcap.channels.values()].filter((channel) => kinds.includes(kindOf(mcap, channel)));
}

async function firstOf(mcap, channel, read) {
  const message = mcap.messages.find((m) => m.channel === channel.id);
  return message ? read(await mcap.read(message), mcap.name) : null;
}

/** The camera of a picture's topic: the CameraInfo with the longest common start of its name. */
async function cameraOf(mcap, channel) {
  const near = (info) => [...info.topic].findIndex((letter, i) => letter !== channel.topic[i]);
  const infos = channelsOf(mcap, 'info').sort((a, b) => near(b) - near(a));
  return infos.length > 0 ? firstOf(mcap, infos[0], readCameraInfo) : null;
}

async function readTf(mcap) {
  const channels = channelsOf(mcap, 'tf').filter((channel) => /tf_static$/.test(channel.topic));
  const lists = await Promise.all(channels.map((channel) => firstOf(mcap, channel, readTransforms)));
  return lists.filter(Boolean).flat();
}

function numbersOf(text, count) {
  const numbers = (text ?? '').split(' ').filter(Boolean).map(Number);
  return numbers.length === count && numbers.every(Number.isFinite) ? numbers : null;
}

/** What Relief's own recordings say beside ROS. */
function ownValues(mcap) {
  const own = mcap.metadata.relief ?? {};
  const noise = [own.noise_c0, own.noise_c1, own.noise_c2].map(Number);
  const range = [Number(own.depth_min_m), Number(own.depth_max_m)];
  const gravity = numbersOf(own.gravity_m_s2, 3);
  return {
    unitsPerMetre: Number(own.units_per_metre) || 1000,
    ...(noise.every(Number.isFinite) ? { noise } : {}),
    ...(range.every(Number.isFinite) ? { range } : {}),
    gravity: gravity?.some((g) => g !== 0) ? gravity : null,
    isSimulated: own.is_simulated === 'true' || own.is_simulated === '1',
  };
}

/** Depth messages with the colour message nearest in time, in order of time. */
function pairUp(mcap, depth, color) {
  const of = (channel) => mcap.messages.filter((m) => m.channel === channel?.id)
    .sort((a, b) => (a.time < b.time ? -1 : 1));
  const colors = of(color);
  let at = 0;
  return of(depth).map((message) => {
    const gap = (i) => { const d = colors[i].time - message.time; return d < 0n ? -d : d; };
    while (at + 1 < colors.length && gap(at + 1) <= gap(at)) at++;
    return { message, color: colors.length > 0 && gap(at) <= PAIR_NS ? colors[at] : null };
  });
}

function frameOf(mcap, pair, camera, isRaw, start) {
  const what = `${mcap.name} at ${(Number(pair.message.time - start) / 1e9).toFixed(2)} s`;
  return {
    timeMs: Number(pair.message.time - start) / 1e6,
    async depth() {
      const data = await mcap.read(pair.message);
      if (isRaw) return rawDepth(readImage(data, what), camera, camera.unitsPerMetre, what);
      const image = readCompressed(data, what);
      return decodeDepth(image.data, image.format, camera, what);
    },
    async color() {
      if (!pair.color || !camera.color) return null;
      return decodeColor(readCompressed(await mcap.read(pair.color), what).data, camera.color, what);
    },
  };
}

async function colorCamera(mcap, color, depthInfo) {
  const info = color ? await cameraOf(mcap, color) : null;
  if (!info) return {};
  const pose = findPose(await readTf(mcap), depthInfo.frame, info.frame);
  return { color: info.camera, ...(pose ? { colorFromDepth: pose } : {}) };
}

/** {name, camera, gravity, isSimulated, frames}. */
export async function openRos(blob, name, onProgress) {
  const mcap = await new Mcap(blob, name).open(onProgress);
  const [depth] = channelsOf(mcap, 'depth', 'raw depth');
  const [color] = channelsOf(mcap, 'color');
  if (!depth) throw new Error(`${name}: has no depth pictures of ROS 2 (compressedDepth, or Image on a topic with depth)`);
  const info = await cameraOf(mcap, depth);
  if (!info) throw new Error(`${name}: has no CameraInfo for ${depth.topic}`);
  const { gravity, isSimulated, ...values } = ownValues(mcap);
  const camera = { ...info.camera, ...values, ...await colorCamera(mcap, color, info) };
  const pairs = pairUp(mcap, depth, camera.color ? color : null);
  if (pairs.length === 0) throw new Error(`${name}: has no depth picture`);
  const isRaw = kindOf(mcap, depth) === 'raw depth';
  return { name, camera, gravity, isSimulated,
    frames: pairs.map((pair) => frameOf(mcap, pair, camera, isRaw, pairs[0].message.time)) };
}
