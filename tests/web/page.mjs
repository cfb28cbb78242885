// The page in headless Chromium: page.mjs FOLDER_OF_demo_AND_relief RELIEF_COMMAND ROOT [NAME]
// Each check has a page of its own. NAME runs one of them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch, needBrowser, openPage, outside, serve } from './browser.mjs';
import { makePng16, makeZip, zipFolder } from './files.mjs';

const [folder, command, root, only] = process.argv.slice(2);
needBrowser(folder);
const work = mkdtempSync(join(tmpdir(), 'relief-page-'));
const three = join(import.meta.dirname, 'node_modules/three/build/');
const server = await serve({ '/': folder, '/three/': three, '/native/': work });
const browser = await launch();
const native = (...options) => execFileSync(command, options, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });

/** The page, open and playing; `run(page, watched)`; and nothing was told to the console or asked of elsewhere. */
async function withPage(run, { path = '/demo/', viewport = { width: 1280, height: 900 }, ...options } = {}) {
  const { page, watched } = await openPage(browser, { viewport, ...options });
  await page.goto(path.startsWith('file:') ? path : server.url + path);
  await page.waitForFunction(() => globalThis.reliefPage?.player.source?.index >= 0);
  await run(page, watched);
  assert.deepEqual(watched.errors, [], 'nothing on the console');
  if (!path.startsWith('file:')) assert.deepEqual(outside(watched, server.url), [], 'no request to elsewhere');
  await page.close();
}

const isElsewhere = (page) => page.evaluate(() => globalThis.reliefPage.room.relief.isElsewhere);
const indexOf = (page) => page.evaluate(() => globalThis.reliefPage.player.source?.index);

/** Pauses and begins again, so that the frame is the same on every machine. */
async function toFrame(page, frame) {
  await page.click('#pause');
  await page.click('#reset');
  await page.waitForFunction(() => globalThis.reliefPage.player.source?.index === 0);
  for (let i = await indexOf(page); i < frame; i++) {
    await page.keyboard.press('n');
    await page.waitForFunction((n) => globalThis.reliefPage.player.source?.index > n, i);
  }
  assert.equal(await indexOf(page), frame);
}

async function goesOn(page) {
  const before = await indexOf(page);
  await page.waitForFunction((n) => globalThis.reliefPage.player.source?.index !== n, before);
}

async function told(page, pattern) {
  await page.waitForFunction((text) => new RegExp(text).test(document.getElementById('status').textContent), pattern.source);
}

async function drop(page, name, buffer) {
  await page.setInputFiles('#file', { name, mimeType: 'application/octet-stream', buffer });
}

/** Mean and largest difference of what is on the screen, or of the canvas's own pixels, from a PNG of the command. */
function compare(page, png, shot) {
  return page.evaluate(async ([path, taken]) => {
    const screen = document.querySelector('#stage canvas');
    const other = await createImageBitmap(await (await fetch(path)).blob());
    const own = taken ? await createImageBitmap(await (await fetch(taken)).blob()) : screen;
    const [width, height] = taken ? [240, 135] : [other.width, other.height];
    const [a, b] = [own, other].map((image) => {
      const context = new OffscreenCanvas(width, height).getContext('2d');
      context.imageSmoothingQuality = 'high';
      context.drawImage(image, 0, 0, width, height);
      return context.getImageData(0, 0, width, height).data;
    });
    const gaps = a.map((value, i) => Math.abs(value - b[i]));
    return { mean: gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length, most: gaps.reduce((m, gap) => Math.max(m, gap), 0) };
  }, [png, shot]);
}

const checks = {
  async 'loads, asks nothing of elsewhere, and throws until its visitor acts'() {
    await withPage(async (page) => {
      await goesOn(page);
      assert.equal(await page.evaluate(() => globalThis.reliefPage.screen.kind), 'webgl2');
      assert.equal(await isElsewhere(page), true, 'the core has a worker');
      assert.equal(await page.evaluate(mostAsked), 1, 'one frame is asked for at a time');
      await page.waitForFunction(async () => (await globalThis.reliefPage.room.relief.call('bodies')).length > 2);
    });
  },

  async 'the hash of 30 frames is the command\'s'() { // of more, and of both profiles: core.mjs, in node
    const address = 'synthetic:room?frames=30&color=96x54';
    const wanted = native('run', address, '--headless', '--hash', '--quiet', '--threads', '1').trim();
    await withPage(async (page) => {
      const hash = await page.evaluate(async (from) => {
        const { Relief } = await import('/relief/relief.js');
        const relief = await Relief.load();
        relief.openSynthetic(from);
        while (relief.step());
        return relief.hash();
      }, address);
      assert.equal(`hash ${hash}`, wanted);
    });
  },

  async 'the hash of a scene is the command\'s'() {
    for (const name of ['rain', 'crowd']) {
      const scene = join(root, 'scenes', `${name}.json`);
      const wanted = native('run', 'synthetic:room?frames=20&color=96x54', '--scene', scene, '--headless', '--hash', '--quiet').trim();
      await withPage(async (page) => {
        const hash = await page.evaluate(async (key) => {
          const [{ Relief }, { sceneOf }, { SCENES }] = await Promise.all([import('/relief/relief.js'), import('/demo/scene.js'),
            import('/demo/scenes.js')]);
          const relief = await Relief.load();
          relief.openSynthetic('synthetic:room?frames=20&color=96x54', { bodies: sceneOf(SCENES[key]) });
          while (relief.step());
          return relief.hash();
        }, name);
        assert.equal(`hash ${hash}`, wanted, name);
      });
    }
  },

  async 'the picture is the command\'s'() {
    const frame = 40;
    native('run', `synthetic:room?frames=${frame + 1}&color=960x540`, '--scene', join(root, 'scenes/demo.json'), '--headless',
      '--quiet', '--renderer', 'soft', '--pictures', `${work}/pictures?at=${frame}`);
    const png = `/native/pictures/${String(frame).padStart(6, '0')}.png`;
    await withPage(async (page) => {
      await toFrame(page, frame);
      const exact = await compare(page, png, null);
      assert.ok(exact.most <= 1, `canvas: ${JSON.stringify(exact)}`);
      await page.addStyleTag({ content: '#figures, #status { visibility: hidden; } .stage { border-radius: 0 !important; }' });
      const shot = await page.locator('#stage').screenshot();
      const seen = await compare(page, png, `data:image/png;base64,${shot.toString('base64')}`);
      assert.ok(seen.mean < 3, `screenshot: ${JSON.stringify(seen)}`);
      console.log(`  canvas: ${exact.most} levels at most; screenshot: ${seen.mean.toFixed(2)} levels in the mean`);
    });
  },

  async 'a click throws a body; drawn further it hits the visitor'() {
    await withPage(async (page) => {
      await toFrame(page, 85); // nothing stands between the camera and the visitor
      const [x, y] = await page.evaluate(visitorOnPicture);
      const box = await page.locator('#stage').boundingBox();
      const bodies = await page.evaluate(async () => (await globalThis.reliefPage.room.relief.call('bodies')).length);
      await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
      await page.mouse.down();
      await page.mouse.move(box.x + x * box.width, box.y + (y + 0.8) * box.height);
      await page.mouse.up();
      const met = new Set();
      for (let i = 0; i < 40 && !met.has('foreground'); i++) {
        const before = await indexOf(page);
        await page.click('#step');
        await page.waitForFunction((n) => globalThis.reliefPage.player.source?.index > n, before);
        for (const other of await page.evaluate(() => globalThis.reliefPage.room.relief.call('met'))) met.add(other);
      }
      assert.ok(met.has('foreground'), `met: ${[...met]}`);
      await told(page, /hit somebody/);
      await page.mouse.click(box.x + 0.3 * box.width, box.y + 0.4 * box.height);
      await page.click('#step');
      await page.waitForFunction(async (n) => (await globalThis.reliefPage.room.relief.call('bodies')).length === n, bodies + 2);
    });
  },

  async 'a body is carried by mouse and by finger'() {
    await withPage(async (page) => {
      await page.selectOption('#scene', 'touch');
      await page.waitForFunction(() => globalThis.reliefPage.player.source?.index > 2);
      const place = await page.evaluate(bodyOnPicture);
      const before = await page.evaluate(async () => (await globalThis.reliefPage.room.relief.call('bodies'))[0].position);
      const box = await page.locator('#stage').boundingBox();
      const at = [box.x + place[0] * box.width, box.y + place[1] * box.height];
      await page.evaluate(dragByTouch, [at, [at[0] + 60, at[1] - 120]]);
      await goesOn(page);
      await page.waitForFunction(async (y) => (await globalThis.reliefPage.room.relief.call('bodies'))[0].position[1] < y - 0.1, before[1]);
      await page.evaluate(() => document.getElementById('stage').dispatchEvent(new PointerEvent('pointerup', { pointerId: 7 })));
    });
  },

  async 'recordings play with bodies in them'() {
    const thrown = JSON.parse(readFileSync(join(root, 'scenes/demo.json'), 'utf8')).bodies.length;
    for (const compression of ['none', 'lz4', 'zstd']) {
      native('record', 'synthetic:room?frames=12&color=320x180', `${work}/${compression}.mcap`, '--compression', compression);
    }
    native('record', 'synthetic:room?frames=12&color=320x180', `${work}/clip/`);
    const files = { 'none.mcap': readFileSync(`${work}/none.mcap`), 'lz4.mcap': readFileSync(`${work}/lz4.mcap`),
      'zstd.mcap': readFileSync(`${work}/zstd.mcap`), 'clip.zip': zipFolder(`${work}/clip`) };
    const wanted = native('run', `${work}/none.mcap`, '--scene', join(root, 'scenes/demo.json'), '--headless', '--hash', '--quiet').trim();
    await withPage(async (page) => {
      for (const [name, buffer] of Object.entries(files)) {
        await drop(page, name, buffer);
        await told(page, new RegExp(`${name}: 12 frames`));
        await goesOn(page);
        const { has, bodies } = await page.evaluate(async () => ({ has: globalThis.reliefPage.room.clip !== null,
          bodies: (await globalThis.reliefPage.room.relief.call('bodies')).length }));
        assert.ok(has && bodies === thrown, `${name}: ${bodies} bodies, not ${thrown}`);
        assert.equal(`hash ${await page.evaluate(hashOfClip)}`, wanted, `${name}: the bits of the command`);
      }
      await page.click('#leave');
      await page.waitForFunction(() => globalThis.reliefPage.room.clip === null);
      await goesOn(page);
    });
  },

  async 'bad files are told, and the room goes on'() {
    const camera = (w, h) => JSON.stringify({ depth: { width: w, height: h, fx: 90, fy: 90, cx: 1, cy: 1, units_per_metre: 1000 } });
    const zip = (w, h, png) => makeZip({ 'a/camera.json': camera(w, h), 'a/depth.txt': '0.0 depth/0.png\n', 'a/depth/0.png': png });
    const depth = makePng16(64, 48, 1500);
    const cases = [
      ['noise.bin', Buffer.from('no recording at all'), /no recording that can be read/],
      ['empty.mcap', Buffer.alloc(0), /no recording/],
      ['cut.zip', zip(64, 48, depth).subarray(0, 200), /is not a whole zip/],
      ['zero.zip', zip(0, 0, depth), /its camera has 0 x 0 pixels/],
      ['other.zip', zip(80, 60, depth), /is 64 x 48, and its camera 80 x 60/],
      ['damaged.zip', zip(64, 48, depth.subarray(0, 60)), /cut short|damaged/],
      ['nothing.zip', makeZip({ 'readme.txt': 'hello' }), /no TUM folder/],
      ['json.zip', makeZip({ 'camera.json': '{', 'depth.txt': '0 depth/0.png', 'depth/0.png': depth }), /camera.json/],
      ['head.mcap', Buffer.from([0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a, 1, 2]), /has no depth pictures/],
    ];
    await withPage(async (page) => {
      for (const [name, buffer, pattern] of cases) {
        await drop(page, name, buffer);
        await told(page, pattern);
        await goesOn(page);
      }
      await drop(page, 'good.zip', zip(64, 48, depth));
      await told(page, /good.zip: 1 frames/);
    });
  },

  async 'out of memory is told, and the room goes on'() {
    await withPage(async (page) => {
      const text = await page.evaluate(async () => {
        const { room, player } = globalThis.reliefPage;
        player.hold();
        const lens = { width: 16000, height: 16000, fx: 9000, fy: 9000, cx: 8000, cy: 8000 };
        room.clip = { name: 'huge', camera: lens, frames: [{ timeMs: 0 }] };
        try {
          await room.openScene('demo');
        } catch (error) {
          return error.message;
        } finally {
          room.clip = null;
          player.play(room.source);
        }
        return 'nothing was told';
      });
      assert.match(text, /memory/i);
      await goesOn(page);
    });
  },

  async 'a lost WebGL context is survived'() {
    await withPage(async (page) => {
      await page.evaluate(() => {
        globalThis.lose = document.querySelector('#stage canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
        globalThis.lose.loseContext();
      });
      await told(page, /took its context back/);
      await page.evaluate(() => globalThis.lose.restoreContext());
      await told(page, /graphics are back/);
      await goesOn(page);
      await page.evaluate(() => document.querySelector('#stage canvas').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext());
      await told(page, /goes on without WebGL/);
      await page.waitForFunction(() => globalThis.reliefPage.screen.kind === 'canvas');
      await goesOn(page);
      assert.ok(await page.evaluate(() => {
        const { canvas } = globalThis.reliefPage.screen;
        return canvas.getContext('2d').getImageData(400, 300, 1, 1).data[0] > 0;
      }), 'there is a picture');
    });
  },

  async 'without WebGL and without a worker there is a picture, too'() {
    await withPage(async (page) => {
      assert.equal(await isElsewhere(page), false);
      assert.equal(await page.evaluate(() => globalThis.reliefPage.screen.kind), 'canvas');
      await goesOn(page);
    }, { path: '/demo/?flat&alone' });
  },

  async 'a minute in the background is told, and nothing races'() {
    const { page, watched } = await openPage(browser);
    await page.clock.install();
    await page.goto(`${server.url}/demo/`);
    await page.waitForFunction(() => globalThis.reliefPage);
    await page.clock.runFor(500);
    const before = await indexOf(page);
    const hide = (isHidden) => page.evaluate((value) => {
      Object.defineProperty(document, 'hidden', { value, configurable: true });
      document.dispatchEvent(new Event('visibilitychange'));
    }, isHidden);
    await hide(true);
    await page.clock.fastForward(60000);
    await hide(false);
    await page.clock.runFor(100);
    await told(page, /in the background for 60 s/);
    const frames = await indexOf(page) - before;
    assert.ok(frames >= 0 && frames < 20, `${frames} frames at once`);
    assert.deepEqual(watched.errors, []);
    await page.close();
  },

  async 'fits 360 pixels, in light and in dark'() {
    for (const colorScheme of ['light', 'dark']) {
      await withPage(async (page) => {
        const [wide, view] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
        assert.ok(wide <= view, `${wide} of ${view} pixels`);
      }, { viewport: { width: 360, height: 740 }, colorScheme });
    }
  },

  async 'the keyboard reaches everything, and throws'() {
    await withPage(async (page) => {
      const wanted = ['stage', 'pause', 'step', 'reset', 'seek', 'scene', 'view', 'file', 'size', 'restitution', 'friction',
        'throw', 'clear', 'gravity'];
      const reached = new Set();
      for (let i = 0; i < 30; i++) {
        await page.keyboard.press('Tab');
        reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.name));
      }
      for (const id of [...wanted, 'kind']) assert.ok(reached.has(id), `${id} is not reached: ${[...reached]}`);
      const names = await page.evaluate(() => [...document.querySelectorAll('button, select, input')]
        .filter((e) => !(e.textContent.trim() || e.labels?.length > 0 || e.ariaLabel)).map((e) => e.id));
      assert.deepEqual(names, [], 'controls without a name');
      await page.focus('#stage');
      const before = await page.evaluate(async () => (await globalThis.reliefPage.room.relief.call('bodies')).length);
      await page.keyboard.press('ArrowLeft');
      await page.keyboard.press('Enter');
      await page.waitForFunction(async (n) => (await globalThis.reliefPage.room.relief.call('bodies')).length === n + 1, before);
      await page.keyboard.press('v');
      assert.equal(await page.inputValue('#view'), 'depth');
      await page.keyboard.press(' ');
      assert.equal(await page.getAttribute('#pause', 'aria-pressed'), 'true');
    });
  },

  async 'all views and all scenes can be had'() {
    await withPage(async (page) => {
      for (const view of await page.evaluate(() => [...document.getElementById('view').options].map((o) => o.value))) {
        await page.selectOption('#view', view);
        await goesOn(page);
      }
      await page.selectOption('#view', 'camera');
      for (const scene of await page.evaluate(() => [...document.getElementById('scene').options].map((o) => o.value))) {
        await page.selectOption('#scene', scene);
        await page.waitForFunction((name) => globalThis.reliefPage.room.name === name, scene);
        await goesOn(page);
        assert.equal(await page.evaluate(() => globalThis.reliefPage.room.clip !== null), scene.startsWith('table'));
      }
      assert.equal(await page.locator('#status.bad:not(:empty)').count(), 0, 'no error was told');
      assert.match(await page.textContent('#about'), /table.zip, with bodies/);
    });
  },

  async 'the page of one file works from a disk'() {
    await withPage(goesOn, { path: pathToFileURL(join(folder, 'relief.html')).href });
  },

  async 'three.js shows what Relief computes'() {
    const { page, watched } = await openPage(browser, { viewport: { width: 480, height: 300 } });
    await page.goto(`${server.url}/examples/three.html`);
    await page.waitForSelector('canvas');
    await page.waitForTimeout(1500);
    const shot = await page.screenshot();
    const colors = await page.evaluate(async (data) => {
      const bitmap = await createImageBitmap(await (await fetch(data)).blob());
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      context.drawImage(bitmap, 0, 0);
      const pixels = new Uint32Array(context.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
      return new Set(pixels).size;
    }, `data:image/png;base64,${shot.toString('base64')}`);
    assert.ok(colors > 5, `${colors} colours`);
    assert.deepEqual(watched.errors, []);
    await page.close();
  },
};

// ---- functions that run in the page -------------------------------------------------------------

/** The most frames that were asked for and had not come yet, in a second. */
async function mostAsked() {
  const { relief } = globalThis.reliefPage.room, run = relief.do.bind(relief);
  let asked = 0, most = 0;
  relief.do = async (calls, spare) => {
    const isFrame = calls[0][0] === 'step';
    most = Math.max(most, asked += isFrame ? 1 : 0);
    const results = await run(calls, spare);
    asked -= isFrame ? 1 : 0;
    return results;
  };
  await new Promise((resolve) => { setTimeout(resolve, 1000); });
  return most;
}

/** Where in the picture the middle of the visitor is, as shares. */
async function visitorOnPicture() {
  const [front, depth, rayX, rayY, width] = await globalThis.reliefPage.room.relief.do([['plane', 'foreground'], ['plane', 'depth'],
    ['plane', 'rayX'], ['plane', 'rayY'], ['width']]);
  const near = [];
  for (let i = 0; i < front.length; i++) if (front[i] && depth[i] > 0) near.push(i);
  const mean = (of) => near.reduce((sum, i) => sum + of(i), 0) / near.length;
  const x = mean((i) => i % width), y = mean((i) => Math.floor(i / width));
  const middle = near.reduce((best, i) => {
    const far = (k) => Math.hypot(k % width - x, Math.floor(k / width) - y);
    return far(i) < far(best) ? i : best;
  }, near[0]);
  const z = depth[middle];
  const point = [z * rayX[middle] - 0.052, z * rayY[middle], z];
  const f = 1081 / 1920;
  return [0.5 + f * point[0] / point[2], 0.5 + f * 960 / 540 * point[1] / point[2]];
}

/** Where in the picture the first body is, as shares. */
async function bodyOnPicture() {
  const [{ position: [x, y, z] }] = await globalThis.reliefPage.room.relief.call('bodies');
  const f = 1081 / 1920;
  return [0.5 + f * (x - 0.052) / z, 0.5 + f * 960 / 540 * y / z];
}

function dragByTouch([from, to]) {
  const stage = document.getElementById('stage');
  stage.setPointerCapture = () => {};
  const send = (kind, [clientX, clientY]) => stage.dispatchEvent(new PointerEvent(kind, { pointerId: 7, pointerType: 'touch',
    button: 0, clientX, clientY, bubbles: true }));
  send('pointerdown', from);
  send('pointermove', to);
}

/** The recording that is open, once through from its start, by itself. */
async function hashOfClip() {
  const [{ Relief }, { sceneOf }, { SCENES }] = await Promise.all([import('/relief/relief.js'), import('/demo/scene.js'),
    import('/demo/scenes.js')]);
  const { clip } = globalThis.reliefPage.room;
  const relief = await Relief.load();
  relief.openCamera(clip.camera, { bodies: sceneOf(SCENES.demo) });
  for (const frame of clip.frames) relief.push(await frame.depth(), frame.timeMs, await frame.color());
  return relief.hash();
}

let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  if (only && !name.includes(only)) continue;
  const start = performance.now();
  try {
    await check();
    console.log(`ok: ${name} (${((performance.now() - start) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed++;
    console.log(`FAILED: ${name}: ${error.stack}`);
  }
}
await browser.close();
await server.close();
rmSync(work, { recursive: true });
console.log(failed === 0 ? 'web page: all is as it should be' : `web page: ${failed} checks failed`);
process.exitCode = failed === 0 ? 0 : 1;
