// See-through depth in node, by a mock of what a device gives: every format, turn, mirroring, crop, frustum and pose;
// holes, null, old and broken buffers; the synthetic room with its person; hands, grabs, things that stand.
// node xr.mjs FOLDER_OF_RELIEF_JS
import assert from 'node:assert/strict';
import { join, resolve } from 'node:path';
import { TURNS, bufferMatrix, depthBuffer, encode, frustum, furnished, poseOf } from './xr_scene.mjs';

const [folder] = process.argv.slice(2);
const { Relief } = await import(join(resolve(folder), 'relief.js'));
const { SeeThrough, CameraChanged, rotate } = await import(join(resolve(folder), 'xr_core.js'));
const { DepthReader } = await import(join(resolve(folder), 'xr_depth.js'));
const relief = await Relief.load();
const see = new SeeThrough(relief);
const OFF_AXIS = [-1.0, 0.6, -0.9, 0.7], CENTRED = [-0.8, 0.8, -0.7, 0.7];

/** Points of the surface in the world, by pixel; null where it was not measured: beside an edge it is estimated. */
function worldPoints() {
  const depth = relief.plane('depth'), x = relief.plane('rayX'), y = relief.plane('rayY');
  const reason = relief.plane('reason');
  const { position, quaternion } = see.camera();
  return Array.from(depth, (z, i) => {
    if (reason[i] !== 0) return null;
    const p = rotate(quaternion, [z * x[i], z * y[i], z]);
    return p.map((value, k) => value + position[k]);
  });
}

/** A view of the furnished room that sees its floor. */
function view({ turn = '0', crop = {}, sides = CENTRED, pose = poseOf([0.1, 1.6, 1.5], 0.2, -0.7), size = [96, 80] } = {}) {
  const [width, height] = size;
  return { width, height, bufferFromView: bufferMatrix(turn, crop), projection: frustum(...sides), pose };
}

const shown = (v, format, timeMs, holes) => depthBuffer(v, furnished, format, timeMs, holes);

/** Whether the ray to a point meets the floor. */
function isFloor(p) {
  const { position: o } = see.camera();
  const d = p.map((value, k) => value - o[k]);
  return Math.abs(o[1] + d[1] * furnished(o, d)) < 1e-6;
}

function checkFloor(name, format) {
  const points = worldPoints().filter((p) => p !== null && isFloor(p));
  const worst = Math.max(...points.map((p) => Math.abs(p[1])));
  const limit = format === 'float32' ? 5e-5 : 3.5e-4; // 16 bits are quarter millimetres
  assert.ok(points.length > 500 && worst < limit, `${name}: ${points.length} points, ${(worst * 1000).toFixed(3)} mm`);
  return worst;
}

// ---- every format and turn; crop, frustum and yaw in all eight ways, two of them with each
let worst = 0, cases = 0;
const CROPS = [{}, { scale: [0.8, 0.7], offset: [0.15, 0.1] }];
for (const format of ['luminance-alpha', 'unsigned-short', 'float32']) {
  for (const turn of Object.keys(TURNS)) {
    const way = cases / 2 % 8;
    for (const bits of [way, 7 - way]) { // each of the three the one way, and the other
      const crop = CROPS[bits & 1], sides = bits & 2 ? OFF_AXIS : CENTRED, yaw = bits & 4 ? 2.1 : 0;
      const v = view({ turn, crop, sides, pose: poseOf([0.3, 1.6, 0.4], yaw, -0.7) });
      const name = `${format}, turn ${turn}, crop ${JSON.stringify(crop)}, sides ${sides}, yaw ${yaw}`;
      see.open(shown(v, format, 0));
      see.push(shown(v, format, 0));
      worst = Math.max(worst, checkFloor(name, format));
      cases++;
    }
  }
}
console.log(`xr: ${cases} buffers: the floor comes back within ${(worst * 1000).toFixed(3)} mm`);

// ---- Quest's depth: an OpenGL depth of near and far, far finite or not, rows as told
for (const far of [50, Infinity]) {
  const v = view();
  const buffer = shown(v, 'float32', 0);
  const raw = new Float32Array(buffer.data);
  raw.forEach((z, i) => { raw[i] = z > 0 ? (1 - 0.1 / z) / (1 - 0.1 / far) : 0; });
  see.open({ ...buffer, near: 0.1, far });
  see.push({ ...buffer, near: 0.1, far });
  checkFloor(`an OpenGL depth, far ${far}`, 'luminance-alpha');
}

// ---- matchDepthView: a depth camera 6 cm beside the eye, turned and with a lens of its own, tells both; one that is the
// eye's tells neither, as Chromium does
{
  const eye = view({ pose: poseOf([0.1, 1.6, 1.5], 0.2, -0.7) });
  const own = view({ pose: poseOf([0.16, 1.58, 1.46], 0.05, -0.6), sides: OFF_AXIS });
  const gl = new Proxy({}, { get: () => () => ({}) });
  const reader = new DepthReader({ depthUsage: 'cpu-optimized', depthDataFormat: 'float32' }, gl);
  const read = (camera, told) => {
    const { width, height, data, rawToMetres, bufferFromView } = shown(camera, 'float32', 0);
    const info = { width, height, data, rawValueToMeters: rawToMetres, normDepthBufferFromNormView: { matrix: bufferFromView }, ...told };
    const eyeView = { eye: 'left', projectionMatrix: eye.projection, transform: { matrix: eye.pose } };
    const depth = { ...reader.read({ getDepthInformation: () => info }, eyeView), timeMs: 0 };
    see.open(depth);
    see.push(depth);
  };
  read(own, { projectionMatrix: own.projection, transform: { matrix: own.pose } });
  checkFloor('a depth view of its own', 'float32');
  read(eye, {});
  checkFloor('a depth view that is the eye\'s', 'float32');
  read(own, {});
  assert.throws(() => checkFloor('a depth view taken for the eye\'s', 'float32'), 'the check sees a wrong pose');
}

// ---- every second pixel is the same room
{
  const v = view({ turn: 'flip', size: [192, 160] });
  see.open({ ...shown(v, 'float32', 0), every: 2 });
  see.push({ ...shown(v, 'float32', 0), every: 2 });
  assert.equal(relief.width, 96);
  checkFloor('every second pixel', 'float32');
}

// ---- holes stay holes, and balls fall where there is none
{
  const v = view();
  const hole = (i) => i % 96 > 70;
  see.open(shown(v, 'unsigned-short', 0));
  see.push(shown(v, 'unsigned-short', 0, hole));
  const depth = relief.plane('depth');
  assert.ok([...depth.keys()].filter((i) => i % 96 > 80).every((i) => depth[i] === 0), 'holes are not filled by guesses');
}

// ---- what is wrong is told in words, and the session goes on
{
  const v = view();
  const good = (timeMs) => shown(v, 'float32', timeMs);
  const broken = (field, at) => ({ ...good(40), [field]: good(40)[field].map((x, i) => (i === at ? NaN : x)) });
  see.open(good(0));
  assert.throws(() => see.push(good(NaN)), /time nan ms: it must be finite/);
  see.push(good(0));
  assert.throws(() => see.push(broken('pose', 13)), /pose: element 13 is not finite/);
  assert.throws(() => see.push(broken('projection', 0)), /projection matrix: element 0/);
  assert.throws(() => see.push(broken('bufferFromView', 5)), /normDepthBufferFromNormView: element 5/);
  assert.throws(() => see.push({ ...good(40), width: 0, height: 0 }), /0 x 0/);
  assert.throws(() => see.push({ ...good(40), width: 97 }), /bytes came, not/);
  assert.throws(() => see.push({ ...good(40), data: good(40).data.slice(4) }), /bytes came, not/);
  assert.throws(() => see.push({ ...good(40), rawToMetres: 0 }), /rawValueToMeters is 0/);
  assert.throws(() => see.push({ ...good(40), format: 'float16' }), /there are luminance-alpha/);
  assert.throws(() => see.push({ ...good(40), near: 1, far: 0.5 }), /near < far/);
  assert.throws(() => see.push({ ...good(40), timeMs: -50 }), /must not go back/);
  const turned = good(40).bufferFromView.slice();
  [turned[0], turned[1], turned[4], turned[5]] = [0.8, 0.6, -0.6, 0.8];
  assert.throws(() => see.push({ ...good(40), bufferFromView: turned }), /no multiple of 90 degrees/);
  const scaled = v.pose.map((x, i) => (i < 3 ? 2 * x : x));
  assert.throws(() => see.push({ ...good(40), pose: scaled }), /no rotation/);
  assert.throws(() => see.push(shown({ ...v, projection: frustum(-0.5, 0.5, -0.5, 0.5) }, 'float32', 40)), CameraChanged);
  assert.throws(() => see.push(shown(view({ size: [48, 40] }), 'float32', 40)), /the depth camera has changed/);
  assert.equal(see.push(good(40)), true);
  checkFloor('after all that was wrong', 'float32');
}

// ---- an old buffer: the head has moved, the depth has not
{
  const v = view();
  see.open(shown(v, 'float32', 0));
  see.push(shown(v, 'float32', 0));
  assert.equal(see.push(shown(v, 'float32', 33)), true, 'a room at rest, and a head at rest');
  const moved = { ...shown(v, 'float32', 66), pose: poseOf([0.2, 1.6, 1.5], 0.2, -0.7) };
  assert.equal(see.push(moved), false);
  assert.equal(see.push({ ...moved, timeMs: 100 }), false, 'and so it stays');
  assert.equal(see.push(shown({ ...v, pose: moved.pose }, 'float32', 133)), true);
}

// ---- bodies stay in the world while the head moves, also out of its view
{
  const from = (pose, timeMs) => shown(view({ pose, size: [160, 140], sides: OFF_AXIS }), 'float32', timeMs);
  const sway = (i) => poseOf([0.3 * Math.sin(i / 12), 1.6 + 0.1 * Math.sin(i / 7), 1.2], 0.5 * Math.sin(i / 15), -0.6);
  const buffer = (i) => from(sway(i), i * 33);
  see.open(buffer(0));
  see.addBody({ shape: 'sphere', size: [0.06], position: [0, 0.5, -0.6], restitution: 0.1 });
  for (let i = 0; i < 60; i++) see.push(buffer(i));
  const rest = see.bodies()[0].position;
  let away = 0;
  for (let i = 60; i < 160; i++) {
    see.push(i < 110 ? buffer(i) : from(poseOf([0, 1.6, 1.2], 2.5, -0.6), i * 33));
    const { position } = see.bodies()[0];
    away = Math.max(away, Math.hypot(...position.map((x, k) => x - rest[k])));
  }
  assert.ok(Math.abs(rest[1] - 0.06) < 0.003, `rests on the floor: ${rest}`);
  assert.ok(away < 0.005, `moved by ${(away * 1000).toFixed(1)} mm while the head moved and looked away`);
  const off = ((rest[1] - 0.06) * 1000).toFixed(2);
  console.log(`xr: a ball rests ${off} mm off the floor, moves ${(away * 1000).toFixed(2)} mm while the head moves`);
}

// ---- the synthetic room with its person, as a turned buffer of a device in another place of the world
{
  const room = await Relief.load();
  room.openSynthetic('synthetic:room?noise=0&color=0&frames=110', { bodies: 'none', draws: false });
  const buffers = [];
  const pose = poseOf([0.5, 1.4, -0.3], 0.8, 0);
  const people = [];
  while (room.step()) {
    const { width: w, height: h } = room;
    const x = room.plane('rayX'), y = room.plane('rayY'), depth = room.plane('depth');
    const fx = (w - 1) / (x[w - 1] - x[0]), fy = (h - 1) / (y[(h - 1) * w] - y[0]);
    const projection = frustum(x[0] - 0.5 / fx, x[w - 1] + 0.5 / fx, -y[(h - 1) * w] - 0.5 / fy, -y[0] + 0.5 / fy);
    const turned = new Float32Array(w * h); // 90: u = y, v = 1 - x
    for (let j = 0; j < h; j += 1) for (let i = 0; i < w; i++) turned[(w - 1 - i) * h + j] = depth[j * w + i];
    const timeMs = buffers.length * 33.3, bufferFromView = bufferMatrix('90');
    buffers.push({ width: h, height: w, bufferFromView, projection, pose, ...encode(turned, 'luminance-alpha'), timeMs, every: 2 });
    people.push(room.plane('foreground').reduce((sum, value) => sum + (value !== 0 ? 1 : 0), 0) / (w * h));
  }
  see.open(buffers[0]);
  let moving = 0, fast = 0, mostly = 0;
  buffers.forEach((buffer, frame) => {
    see.push(buffer);
    if (people[frame] < 0.02 || frame < 60) return;
    const foreground = relief.plane('foreground'), v = ['velocityX', 'velocityY', 'velocityZ'].map((name) => relief.plane(name));
    const seen = [...foreground.keys()].filter((i) => foreground[i] !== 0);
    moving += seen.length / foreground.length;
    mostly += people[frame];
    fast = Math.max(fast, seen.filter((i) => Math.hypot(...v.map((plane) => plane[i])) > 0.3).length / Math.max(1, seen.length));
  });
  const share = (100 * moving / mostly).toFixed(0);
  console.log(`xr: the person is ${share} % of the foreground that a standing camera sees`);
  console.log(`xr: at most ${(100 * fast).toFixed(0)} % of it is faster than 0.3 m/s`);
  assert.ok(moving > 0.7 * mostly && moving < 1.3 * mostly, 'the person is foreground');
  assert.ok(fast > 0.3, 'and moves');
}

// ---- hands push, a pinch takes and throws, what stands carries
{
  const v = view({ pose: poseOf([0, 1.5, 1.2], 0, -0.6), size: [160, 140] });
  let time = 0;
  const step = (count, before = () => {}) => {
    for (let i = 0; i < count; i++, time += 33.3) {
      before(i);
      see.push(shown(v, 'float32', time));
    }
  };
  const bone = (x, y, z) => [x - 0.05, y, z, x + 0.05, y, z, 0.012, 0];
  const bones = (x, y, z) => Float32Array.from(Array.from({ length: 24 }, (_, i) => bone(x, y, z + 0.004 * i)).flat());
  see.close();
  see.open(shown(v, 'float32', 0));
  see.addBody({ shape: 'sphere', size: [0.06], position: [0, 0.07, -0.4], restitution: 0.1 });
  step(30);
  const before = see.bodies()[0].position;
  step(20, (i) => see.hand(0, bones(before[0], 0.06, before[2] + 0.3 - 0.02 * i)));
  see.hand(0, null);
  const after = see.bodies()[0].position;
  assert.ok(after[2] < before[2] - 0.08, `the hand pushes: ${before} -> ${after}`);
  assert.throws(() => see.hand(0, bones(NaN, 0, 0)), /not finite/);

  assert.equal(see.pinch(0, [1, 1, 1], [0, 0, 0, 1]), false, 'nothing is in reach');
  let held = 0;
  step(25, (i) => { held += see.pinch(0, [after[0], 0.06 + 0.02 * i, after[2]], [0, 0, 0, 1]) ? 1 : 0; });
  const lifted = see.bodies()[0].position;
  assert.ok(held === 25 && lifted[1] > 0.4, `a pinch lifts: ${held}, ${lifted}`);
  see.pinch(0, null);
  step(4);
  assert.ok(see.bodies()[0].velocity[1] < 0.6, 'and lets go');
  step(20);
  const { byteLength } = relief.functions.memory.buffer;
  step(40);
  assert.equal(relief.functions.memory.buffer.byteLength, byteLength, 'a frame takes no memory');
  assert.ok(Math.abs(see.bodies()[0].position[1] - 0.06) < 0.01, `it fell: ${see.bodies()[0].position}`);

  const shelf = see.addBox([0.6, 0.02, 0.6], [0, 0.8, -0.3], [0, 0, 0, 1]);
  const top = [-0.2, 0, -0.2, 0.2, 0, -0.2, 0.2, 0, 0.2, -0.2, 0, 0.2, 0, 0.2, 0];
  const wedge = see.addHull(top, [0, 1, 2, 0, 2, 3, 0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0], [1.2, 0.6, -0.3], [0, 0, 0, 1]);
  assert.notEqual(shelf, wedge);
  see.addBody({ shape: 'sphere', size: [0.05], position: [0, 1, -0.3], restitution: 0.1 });
  step(50);
  assert.ok(Math.abs(see.bodies()[1].position[1] - 0.86) < 0.01, `the shelf carries: ${see.bodies()[1].position}`);
  see.removeStatic(shelf);
  step(50);
  assert.ok(see.bodies()[1].position[1] < 0.1, 'and is gone');

  const { id } = see.bodies()[1];
  assert.equal(see.place(id, [0.3, 0.05, -0.2], [0, 0, 0, 1]), true, 'an anchor moved');
  step(1);
  assert.ok(Math.abs(see.bodies()[1].position[0] - 0.3) < 0.005);
  assert.equal(see.place([99, 0], [0, 0, 0], [0, 0, 0, 1]), false);
  assert.equal(see.place(id, [NaN, 0, 0], [0, 0, 0, 1]), false);

  see.open(shown(view({ size: [120, 100] }), 'float32', 0));
  see.push(shown(view({ size: [120, 100] }), 'float32', 0));
  assert.equal(see.bodies().length, 2, 'another camera, the same bodies');
}
see.close();
assert.throws(() => relief.push(new Uint16Array(1), 0), /no room/);
console.log('xr: all is as it should be');
