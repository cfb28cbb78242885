// Figures of the page, in headless Chromium: measure.mjs FOLDER_OF_demo_AND_relief RELIEF_COMMAND
// RELIEF_COMMAND is a portable build. Both play the same recording, in turn, so that they share the machine alike.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { launch, needBrowser, openPage, serve } from './browser.mjs';

const [folder, command] = process.argv.slice(2);
needBrowser(folder);
const FRAMES = 90, WARM = 20, ROUNDS = 3;
const work = mkdtempSync(join(tmpdir(), 'relief-measure-'));
const clip = join(work, 'clip.mcap');
const run = (...options) => execFileSync(command, options, { stdio: 'ignore' });
run('record', `synthetic:room?frames=${FRAMES}&color=0`, clip, '--compression', 'none');
const server = await serve({ '/': folder, '/work/': work });
const browser = await launch();

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[sorted.length >> 1];
}

/** Milliseconds of surface and physics, frame by frame, by the command's own clock. */
function nativeTimes() {
  run('run', clip, '--headless', '--threads', '1', '--log', join(work, 'log'), '--frames', String(FRAMES));
  const [head, ...rows] = readFileSync(join(work, 'log/frames.csv'), 'utf8').trim().split('\n').map((row) => row.split(','));
  const [surface, physics] = ['surface_ms', 'physics_ms'].map((name) => head.indexOf(name));
  return rows.slice(WARM).map((row) => Number(row[surface]) + Number(row[physics]));
}

/** The same frames in the page: what push takes without a picture. */
async function wasmTimes(page) {
  return page.evaluate(async (warm) => {
    const [{ Relief }, { openRecording }] = await Promise.all([import('/relief/relief.js'), import('/demo/recording/open.js')]);
    const file = await (await fetch('/work/clip.mcap')).blob();
    const recording = await openRecording(new File([file], 'clip.mcap'));
    const relief = await Relief.load();
    relief.openCamera(recording.camera, { bodies: 'two-cubes', draws: false });
    const times = [];
    for (const frame of recording.frames) {
      const depth = await frame.depth();
      const start = performance.now();
      relief.push(depth, frame.timeMs);
      times.push(performance.now() - start);
    }
    return times.slice(warm);
  }, WARM);
}

async function speed() {
  const { page } = await openPage(browser);
  await page.goto(`${server.url}/examples/`).catch(() => {});
  const native = [], wasm = [];
  for (let round = 0; round < ROUNDS; round++) {
    native.push(...nativeTimes());
    wasm.push(...await wasmTimes(page));
  }
  await page.close();
  return [median(native), median(wasm)];
}

/** Once before, so that the server has packed the files, as a host has. */
async function wholePage() {
  const before = await openPage(browser);
  await before.page.goto(`${server.url}/demo/`);
  await before.page.waitForFunction(() => globalThis.reliefPage?.screen.last);
  await before.page.close();
  const { page } = await openPage(browser, { viewport: { width: 1280, height: 900 } });
  const start = performance.now();
  await page.goto(`${server.url}/demo/`);
  await page.waitForFunction(() => globalThis.reliefPage?.screen.last);
  const first = performance.now() - start;
  await page.waitForFunction(() => globalThis.reliefPage.plot.times.length >= 120, null, { timeout: 120000 });
  const [ms, period] = await page.evaluate(() => [globalThis.reliefPage.plot.median(0), globalThis.reliefPage.plot.median(1)]);
  await page.close();
  return { first, ms, fps: 1000 / period };
}

function loadBytes() {
  const of = (path) => gzipSync(readFileSync(join(folder, path)), { level: 9 }).length;
  const filesOf = (name) => readdirSync(join(folder, name), { recursive: true }).map((file) => join(name, file));
  const page = [...filesOf('demo'), ...filesOf('relief')].filter((name) => /\.(html|css|js)$/.test(name));
  const sizes = [...page.map(of), of('relief/relief.wasm')];
  return { all: sizes.reduce((sum, size) => sum + size, 0), wasm: sizes.at(-1) };
}

const [native, wasm] = await speed();
const page = await wholePage();
const load = loadBytes();
console.log(`surface and physics, 512x424, 2 bodies, one thread: native portable ${native.toFixed(1)} ms, wasm ${wasm.toFixed(1)} ms, ${(wasm / native).toFixed(2)} times (median)
whole page, 960x540: ${page.ms.toFixed(1)} ms a frame with the simulator, ${page.fps.toFixed(0)} frames a second
first picture: ${page.first.toFixed(0)} ms
load, gzip: ${(load.all / 1000).toFixed(0)} kB, of which relief.wasm ${(load.wasm / 1000).toFixed(0)} kB`);
await browser.close();
await server.close();
rmSync(work, { recursive: true });
