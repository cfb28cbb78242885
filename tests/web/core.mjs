// The module in node: no imports, the bits of the native build, frames that are pushed, errors in words.
// node core.mjs FOLDER_OF_RELIEF_JS RELIEF_COMMAND
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';

const [folder, command] = process.argv.slice(2);
const { Relief } = await import(join(resolve(folder), 'relief.js'));
const bytes = readFileSync(join(folder, 'relief.wasm'));
const module = new WebAssembly.Module(bytes);
assert.deepEqual(WebAssembly.Module.imports(module), [], 'the module imports nothing');
console.log(`relief.wasm: ${bytes.length} bytes, ${gzipSync(bytes).length} in gzip`);

const FRAMES = 60;
const ADDRESS = `synthetic:room?color=96x54&frames=${FRAMES}`;
const relief = await Relief.load();
for (const profile of ['live', 'thesis']) {
  relief.openSynthetic(ADDRESS, { profile });
  let frames = 0;
  const start = performance.now();
  while (relief.step()) frames++;
  const ms = (performance.now() - start) / frames;
  const native = execFileSync(command, ['run', ADDRESS, '--headless', '--hash', '--quiet', '--threads', '1',
    '--profile', profile], { encoding: 'utf8' });
  assert.equal(frames, FRAMES);
  assert.equal(`hash ${relief.hash()}`, native.trim(), `${profile}: the same bits as native`);
  console.log(`${profile}: ${native.trim()}, ${ms.toFixed(1)} ms a frame with the simulator`);
  const depth = relief.plane('depth');
  assert.equal(depth.length, relief.width * relief.height);
  assert.ok(depth.some((z) => z > 0.5 && z < 8));
  const { data, width, height } = relief.picture();
  assert.equal(data.length, 4 * width * height);
  assert.ok(data.some((value) => value > 0));
  assert.equal(relief.bodies().length, 2);
}

// A flat wall 2 m away is pushed; a ball that is thrown at it comes back.
const camera = { width: 128, height: 106, fx: 91, fy: 91, cx: 63.5, cy: 52.5 };
relief.openCamera(camera);
relief.setGravity(0, 0, 0);
const wall = new Uint16Array(camera.width * camera.height).fill(2000);
for (let frame = 0; frame < 40; frame++) relief.push(wall, frame * 33);
relief.addBody({ shape: 'sphere', size: [0.05], position: [0, 0, 1], velocity: [0, 0, 2] });
let hits = 0;
for (let frame = 40; frame < 90; frame++) {
  relief.push(wall, frame * 33);
  hits += relief.contacts().length;
}
const [ball] = relief.bodies();
assert.ok(hits > 0 && ball.velocity[2] < -0.5 && ball.position[2] < 1.95, `the ball: ${JSON.stringify(ball)}`);

// What is wrong is told in words, and the room goes on.
assert.throws(() => relief.push(new Uint16Array(3), 9000), /3 pixels, the camera 13568/);
assert.throws(() => relief.push(wall, NaN), /must be finite/);
assert.throws(() => relief.plane('colour'), /there are depth/);
assert.throws(() => relief.step(), /no room with a source/);
relief.push(wall, 90 * 33);
assert.throws(() => relief.openSynthetic('synthetic:room?frames=x'), /frames/);
assert.throws(() => relief.openCamera({ ...camera, fx: NaN }), /relief:/);
assert.throws(() => relief.push(wall, 0), /no room/);
console.log('web core: all is as it should be');
