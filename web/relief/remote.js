// A Relief in a worker: the page draws and answers its visitor while the core computes. Where there can be no worker the
// same calls run in this thread. They are promises both ways, and are done in the order in which they are made.
import { perform } from './calls.js';
import { compileRelief, Relief } from './relief.js';

const usualWorker = () => new Worker(new URL('worker.js', import.meta.url), { type: 'module' });

export class RemoteRelief {
  #worker = null;
  #local = null;
  #waiting = new Map();
  #last = 0;

  /** `wasm`: as Relief.load has it; `worker()` makes the worker, or throws. */
  static async start({ wasm, worker = usualWorker } = {}) {
    const remote = new RemoteRelief();
    const [made, module] = [remote.#make(worker), await compileRelief(wasm)]; // the worker starts while the module compiles
    if (!made || !(await remote.#enlist(module))) {
      remote.#worker?.terminate();
      remote.#worker = null;
      remote.#local = await Relief.load(module);
    }
    remote.module = module;
    return remote;
  }

  /** Whether the core has a thread of its own. */
  get isElsewhere() { return this.#worker !== null; }

  /** The Relief of this thread; null where the core is elsewhere. */
  get local() { return this.#local; }

  /** One call: a method of Relief, or a getter, by its name. */
  async call(name, ...args) {
    const [result] = await this.do([[name, ...args]]);
    return result;
  }

  /** Several in one go, [[name, ...arguments], ...]. `spare`: a buffer that the picture may come in, given away.
   * After it `ms` is what they took. */
  async do(calls, spare) {
    if (this.#worker) return this.#send({ calls, spare }, spare ? [spare] : []);
    const start = performance.now();
    const results = perform(this.#local, calls);
    this.ms = performance.now() - start;
    return results;
  }

  /** Ends the thread. */
  close() {
    this.#worker?.terminate();
    this.#fail('the room is closed');
  }

  #make(worker) {
    try {
      this.#worker = worker();
    } catch {
      return false;
    }
    this.#worker.addEventListener('message', ({ data }) => this.#take(data));
    this.#worker.addEventListener('error', ({ message }) => this.#fail(message || 'the worker did not start'));
    return true;
  }

  async #enlist(module) {
    try {
      await this.#send({ wasm: module }, []);
      return true;
    } catch {
      return false;
    }
  }

  #send(message, moved) {
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ id, ...message }, moved);
    });
  }

  #take({ id, results, ms, error }) {
    if (id === 0) {
      this.#fail(error.message);
      return;
    }
    const { resolve, reject } = this.#waiting.get(id);
    this.#waiting.delete(id);
    this.ms = ms;
    if (error) reject(Object.assign(new Error(error.message), { name: error.name }));
    else resolve(results);
  }

  #fail(words) {
    for (const { reject } of this.#waiting.values()) reject(new Error(words));
    this.#waiting.clear();
  }
}
