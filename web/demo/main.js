// The page: puts the room, the screen, the pointer, the keys and the panel together.
import { $, bindPanel, clipOf, VIEW_NAMES } from './controls.js';
import { takeFiles } from './files.js';
import { greet } from './greet.js';
import { listenToKeys } from './keys.js';
import { offerAr } from './parts.js';
import { Player } from './player.js';
import { Plot } from './plot.js';
import { Pointer } from './pointer.js';
import { Room } from './room.js';
import { makeSay } from './say.js';
import { MODELS, SCENES } from './scenes.js';
import { Screen } from './screen.js';
import { started, startRelief } from './wasm.js';

const PLOT_EVERY = 10; // frames
const { say, fail } = makeSay($('status'));
const touches = new Set(); // what thrown bodies met: told once each

function show(page, picture) {
  if (picture) page.screen.show(picture);
}

async function redraw(page) {
  try {
    const [, picture] = await page.room.relief.do([['redraw'], ['picture']]);
    show(page, picture);
  } catch (error) {
    fail(error);
  }
}

function tellTouches(met) {
  for (const other of met) {
    if (other !== 'foreground' || touches.has(other)) continue;
    touches.add(other);
    say('A body hit somebody.');
  }
}

function tellPlace({ player: { source } }) {
  const seconds = Math.max(0, source.index) / source.fps;
  $('place').textContent = `${seconds.toFixed(1)} s`;
  if (document.activeElement !== $('seek')) $('seek').value = source.count > 1 ? source.index / (source.count - 1) : 0;
}

/** Opens a room by `open()`, after those that are being opened. On an error the page says why, and what was open goes on. */
function play(page, open) {
  page.opening = (page.opening ?? Promise.resolve()).then(async () => {
    page.player.hold();
    try {
      await open();
      touches.clear();
      $('leave').hidden = page.room.clip === null;
      $('simulated').hidden = page.room.clip !== null;
      $('about').textContent = page.room.clip ? `${page.room.clip.name}, with bodies in it` : SCENES[page.room.name].about;
    } catch (error) {
      fail(error);
    }
    if (page.room.source) page.player.play(page.room.source);
  });
  return page.opening;
}

function openFile(page, file) {
  say(`Reading ${file.name}…`);
  const onProgress = (share) => say(`Reading ${file.name}: ${Math.round(100 * share)} %`);
  return play(page, async () => {
    const source = await page.room.openFile(file, $('scene').value, onProgress);
    say(`${file.name}: ${source.count} frames. Nothing of it leaves this machine.`);
  });
}

/** A scene; one in a clip of ours loads it first. */
async function openScene(page, name) {
  const clip = clipOf(SCENES[name]);
  if (clip === null || page.room.clip !== null) {
    await play(page, () => page.room.openScene(name));
    return;
  }
  try {
    const response = await fetch(clip);
    if (!response.ok) throw new Error(`${clip}: ${response.status} ${response.statusText}`);
    await openFile(page, new File([await response.blob()], clip));
  } catch (error) {
    fail(error);
  }
}

async function throwBody(page, u, v, drag = 0) {
  if (page.room.isElsewhere) {
    say('No throws in this view: choose another one.');
    return;
  }
  try {
    await page.room.relief.call('throwBody', u, v, { ...page.panel.throwOptions(), drag });
  } catch (error) {
    fail(error);
  }
}

function setPaused(page, isPaused) {
  page.player.setPaused(isPaused);
  $('pause').textContent = isPaused ? 'Play' : 'Pause';
  $('pause').setAttribute('aria-pressed', String(isPaused));
}

function chooseView(page, index) {
  const name = VIEW_NAMES[index % VIEW_NAMES.length];
  $('view').value = name;
  page.room.setView(name);
  $('stage').classList.toggle('elsewhere', page.room.isElsewhere);
  redraw(page);
}

/** The acts that buttons and keys share. */
function makeActs(page) {
  const { room, player, pointer } = page;
  return {
    pause: () => setPaused(page, !player.isPaused),
    step: () => { setPaused(page, true); player.step(); },
    reset: () => play(page, () => room.openScene(room.name)),
    throwBody: () => throwBody(page, ...pointer.pixel(pointer.aim)),
    nextShape: () => say(`Throws a ${page.panel.nextShape()}.`),
    nextView: () => {
      chooseView(page, VIEW_NAMES.indexOf(room.view) + 1);
      say(`View: ${$('view').selectedOptions[0].text}`);
    },
    chooseView: (index) => chooseView(page, index),
    aim: (x, y) => pointer.moveAim(x, y),
    remove: async () => {
      const isRemoved = await room.relief.call('removeAt', ...pointer.pixel(pointer.aim));
      say(isRemoved ? 'Removed.' : 'No body at the aim.');
    },
  };
}

function bindButtons(page, acts) {
  for (const [id, act] of [['pause', acts.pause], ['step', acts.step], ['reset', acts.reset], ['throw', acts.throwBody]]) {
    $(id).addEventListener('click', act);
  }
  $('clear').addEventListener('click', () => { page.room.relief.call('removeAll'); redraw(page); });
  $('leave').addEventListener('click', () => {
    page.room.leaveFile();
    if (clipOf(SCENES[$('scene').value])) $('scene').value = 'demo';
    play(page, () => page.room.openScene($('scene').value));
  });
  $('seek').addEventListener('input', () => {
    const { source } = page.player;
    source.seek(Math.round($('seek').value * (source.count - 1)));
    page.player.step();
  });
  takeFiles($('drop'), $('file'), (file) => openFile(page, file));
}

function makePlayer(page) {
  let frames = 0;
  return new Player({
    advanced: ({ picture, met }) => { show(page, picture); tellTouches(met); tellPlace(page); },
    failed: (error) => { fail(error); setPaused(page, true); },
    wasAway: (seconds) => say(`This tab was in the background for ${Math.round(seconds)} s: the room waited.`),
    timed: (ms, periodMs) => {
      page.plot.add(ms, periodMs);
      if (++frames % PLOT_EVERY === 0) $('figures').textContent = page.plot.draw();
    },
  });
}

function makePage(relief) {
  const page = { room: new Room(relief, SCENES, MODELS) };
  const stage = $('stage');
  page.screen = new Screen(stage, say, { webgl: !new URLSearchParams(location.search).has('flat') });
  page.plot = new Plot($('plot'), $('times'));
  page.player = makePlayer(page);
  page.pointer = new Pointer(stage, $('aim'), { relief, screen: page.screen, isElsewhere: () => page.room.isElsewhere,
    thrown: (u, v, drag) => throwBody(page, u, v, drag),
    turned: (x, y, zoom) => { page.room.turn(x, y, zoom); if (page.player.isPaused) redraw(page); } });
  page.panel = bindPanel(SCENES, {
    scene: (name) => openScene(page, name),
    view: (name) => chooseView(page, VIEW_NAMES.indexOf(name)),
    gravity: (value) => page.room.setGravity(value),
  });
  return page;
}

async function start() {
  const relief = await started;
  const page = makePage(relief);
  const acts = makeActs(page);
  bindButtons(page, acts);
  listenToKeys($('stage'), acts);
  $('scene').value = 'demo';
  await play(page, () => page.room.openScene('demo'));
  $('loading').remove();
  greet(relief, { say, throwBody: (x, y) => throwBody(page, ...page.pointer.pixel([x, y]), 0.6),
    isOn: () => page.room.name === 'demo' && page.room.clip === null && !page.player.isPaused });
  globalThis.reliefPage = page; // for the console, and for tests
  await offerAr?.({ button: $('ar'), status: say, reason: $('ar-why'), relief: () => startRelief(relief.module) });
}

start().catch((error) => {
  $('loading').textContent = 'This browser cannot run Relief: it needs WebAssembly with SIMD.';
  fail(error);
});
