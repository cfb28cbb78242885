// The core, started: a file of its own, so that the module compiles and the worker starts while the page's other files come.
import { RemoteRelief } from '../relief/remote.js';

/** The module's bytes: inside the page of one file, else beside relief.js. */
async function wasmBytes() {
  const inside = document.getElementById('wasm');
  if (!inside) return undefined;
  const text = atob(inside.textContent.trim());
  const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

function makeWorker() {
  if (new URLSearchParams(location.search).has('alone')) throw new Error('asked to run without a worker');
  const inside = document.getElementById('worker');
  if (!inside) return new Worker(new URL('../relief/worker.js', import.meta.url), { type: 'module' });
  return new Worker(URL.createObjectURL(new Blob([inside.textContent], { type: 'text/javascript' })));
}

/** A core in a thread of its own, or in this one. */
export const startRelief = (wasm) => RemoteRelief.start({ wasm, worker: makeWorker });

/** The room's. */
export const started = startRelief(wasmBytes());
started.catch(() => {}); // main.js tells
