// The page of the AR test: what the test asks for by name, in `test`.
import { Relief } from '/relief/relief.js';
import { offerAr } from '/demo/ar.js';
import { emulate, enter, frames, look, showRoom, state } from './ar_emulator.mjs';
import { anchoring, touch } from './ar_hands.mjs';
import { cast, castBall, distance, project, rayOf } from './ar_rays.mjs';
import { readTexture, textureErrors } from './ar_textures.mjs';

/** The emulator's depth beside the mesh: metres off at a grid of pixels, as it comes and repaired. */
async function depthErrors() {
  await frames(2);
  const view = state.last.pose.views[0];
  const { raw, metres, width, height } = state.lastDepth.left;
  const rows = [];
  for (let j = 12; j < height; j += 24) {
    for (let i = 12; i < width; i += 24) {
      const { o, d } = rayOf(view, [(i + 0.5) / width, 1 - (j + 0.5) / height]);
      const z = cast(state.soup, o, d);
      if (Number.isFinite(z)) rows.push([z, raw[j * width + i] - z, metres[j * width + i] - z]);
    }
  }
  return rows;
}

/** Balls in rows over what is seen, until they have fallen. Gaps to the mesh of those that are seen and slow. */
async function rest(count) {
  const { ar } = state;
  const from = [-0.9, -1.7];
  for (let i = 0; i < 64; i++) {
    const position = [from[0] + 0.2 * (i % 8), 0.75, from[1] + 0.2 * Math.floor(i / 8)];
    ar.see.addBody({ size: [0.05], position, restitution: 0.1, friction: 0.9 });
  }
  await frames(count);
  const view = state.last.pose.views[0];
  const bodies = ar.see.bodies();
  const seen = bodies.filter((body) => project(view, body.position) !== null);
  const gaps = seen.map((body) => distance(state.soup, body.position) - body.size[0]);
  return { bodies: bodies.length, seen: seen.length, gaps };
}

const random = (seed) => () => { seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0; return seed / 2 ** 32; };

/** 64 balls anywhere in the view, before and behind what is real; what each eye shows at their middles, and should show. */
async function hiding() {
  const { relief, ar, last } = state;
  const next = random(7);
  ar.see.bodies().forEach(({ id }) => ar.see.remove(id));
  relief.setGravity(0, 0, 0);
  while (state.placed !== 64) {
    const { o, d } = rayOf(last.pose.views[0], [0.1 + 0.8 * next(), 0.1 + 0.8 * next()]);
    const z = 0.6 + 3.4 * next();
    ar.see.addBody({ shape: 'sphere', size: [0.06], position: o.map((x, k) => x + z * d[k]) });
    state.placed = (state.placed ?? 0) + 1;
  }
  await frames(2);
  return state.last.pose.views.map((view) => judge(view, state.last));
}

function judge(view, { layer, ar, shown }) {
  const gl = ar.context, { x, y, width, height } = layer.getViewport(view);
  const bodies = shown ?? ar.see.bodies();
  const pixel = new Uint8Array(4);
  return bodies.map((body) => {
    const at = project(view, body.position);
    if (at === null) return null;
    const pixelAt = [Math.floor(at[0] * width), Math.floor(at[1] * height)];
    gl.readPixels(x + pixelAt[0], y + pixelAt[1], 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    const ray = rayOf(view, [(pixelAt[0] + 0.5) / width, (pixelAt[1] + 0.5) / height]);
    const front = Math.min(...bodies.map((other) => castBall(ray, other)));
    const behind = front - cast(state.soup, ray.o, ray.d);
    return { behind, isShown: pixel[3] > 127 && Math.max(pixel[0], pixel[1], pixel[2]) > 40, alpha: pixel[3] };
  }).filter((row) => row !== null);
}

/** Told words of a kind since `from`. */
const toldSince = (from, kind) => state.told.slice(from).filter(([k]) => k === kind).map(([, words]) => words);

/** Runs frames in a broken state, and some more after it. */
async function broken(set, unset, kind) {
  const from = state.told.length;
  Object.assign(state, set);
  await frames(25);
  Object.assign(state, unset);
  await frames(3);
  return toldSince(from, kind);
}

/** A lost tracking calls no onFrame: waits for words. */
async function lost() {
  const from = state.told.length;
  state.isLost = true;
  while (toldSince(from, 'tracking').length === 0) await new Promise((resolve) => setTimeout(resolve, 20));
  state.isLost = false;
  await frames(2);
  return toldSince(from, 'tracking');
}

/** A session whose core is in a worker: a ball falls and rests, a hand lifts one, and what a frame costs this thread. */
async function elsewhere() {
  await enter({ isElsewhere: true });
  const { ar, relief } = state, { see } = ar;
  const send = see.send.bind(see), times = [], from = state.told.length;
  see.send = (...args) => {
    const start = performance.now();
    send(...args);
    times.push(performance.now() - start);
  };
  for (let i = 0; i < 64; i++) {
    const position = [-0.9 + 0.2 * (i % 8), 0.75, -1.7 + 0.2 * Math.floor(i / 8)];
    see.addBody({ size: [0.05], position, restitution: 0.1, friction: 0.9 });
  }
  await frames(150);
  const bodies = see.bodies();
  const gaps = bodies.filter((body) => project(state.last.pose.views[0], body.position) !== null)
    .map((body) => distance(state.soup, body.position) - body.size[0]);
  return { isElsewhere: relief.isElsewhere, bodies: bodies.length, gaps, times, coreMs: ar.coreMs,
    told: state.told.slice(from).filter(([kind, words]) => kind !== 'session' && words !== '') };
}

async function end() {
  await state.ar.session.end();
  return state.ar.ended;
}

Object.assign(globalThis, {
  test: {
    state, emulate, enter, frames, look, showRoom, depthErrors, rest, hiding, touch, anchoring, broken, lost, end, elsewhere,
    readTexture, textureErrors, offerAr, Relief,
  },
});
