// What a see-through frame costs: node xr_speed.mjs FOLDER_OF_RELIEF_JS [EVERY]. 320 x 320 float32 depth of a furnished room,
// a head that moves, 64 balls; one wasm thread. Milliseconds a frame: of the clock, and of the processor, which other
// programs on the machine disturb less.
import { join, resolve } from 'node:path';
import { bufferMatrix, depthBuffer, frustum, furnished, poseOf } from './xr_scene.mjs';

const [folder, only] = process.argv.slice(2);
const { Relief } = await import(join(resolve(folder), 'relief.js'));
const { SeeThrough } = await import(join(resolve(folder), 'xr_core.js'));
const FRAMES = 120;
const projection = frustum(-1.2, 0.8, -1.1, 0.9);
const buffers = Array.from({ length: FRAMES }, (_, i) => depthBuffer({
  width: 320, height: 320, bufferFromView: bufferMatrix('0'), projection,
  pose: poseOf([0.1 * Math.sin(i / 20), 1.6, 1 - 0.003 * i], 0.1 * Math.sin(i / 15), -0.35),
}, furnished, 'float32', i * 33.3));

async function measure(every) {
  const relief = await Relief.load();
  const see = new SeeThrough(relief);
  const opened = performance.now();
  see.open({ ...buffers[0], every });
  const openMs = performance.now() - opened;
  for (let i = 0; i < 64; i++) {
    const position = [-1.4 + 0.4 * (i % 8), 1.2, -2 + 0.4 * Math.floor(i / 8)];
    see.addBody({ shape: 'sphere', size: [0.05], position, restitution: 0.2 });
  }
  const times = buffers.map((buffer) => {
    const start = performance.now(), used = process.cpuUsage();
    see.push({ ...buffer, every });
    const { user, system } = process.cpuUsage(used);
    return [performance.now() - start, (user + system) / 1000];
  }).slice(FRAMES / 3);
  const at = (k, share) => times.map((row) => row[k]).sort((a, b) => a - b)[Math.floor(share * times.length)].toFixed(1);
  const clock = `median ${at(0, 0.5)} ms, p90 ${at(0, 0.9)}, least ${at(0, 0)}; processor median ${at(1, 0.5)} ms`;
  console.log(`every ${every}: ${clock}; opened in ${openMs.toFixed(0)} ms, ${relief.bodies().length} bodies`);
}
for (const every of only ? [Number(only)] : [1, 2, 4]) await measure(every);
