// The worker of remote.js: one Relief in a thread of its own.
import { serveCalls } from './calls.js';
import { Relief } from './relief.js';
import { attachSeeThrough } from './xr_remote.js';

let relief = null;
serveCalls(globalThis, async (wasm) => {
  relief = await Relief.load(wasm);
  attachSeeThrough(relief);
  return relief;
}, () => relief.functions.memory.buffer);
