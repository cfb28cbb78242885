// Calls as a list, so that they can be made in another thread.

/** Calls on `target`, each [name, ...arguments]: what they return, in order. A getter is a call without arguments. */
export function perform(target, calls) {
  return calls.map(([name, ...args]) => {
    const member = target[name];
    return typeof member === 'function' ? member.apply(target, args) : member;
  });
}

/** Answers the messages of remote.js in a worker. `make(wasm)`: what the calls are made on; `memory()`: the core's. */
export function serveCalls(scope, make, memory) {
  let target = null;
  scope.addEventListener('messageerror', () => scope.postMessage({ id: 0, error: { message: 'the module could not be sent' } }));
  scope.addEventListener('message', async ({ data: { id, wasm, calls = [], spare } }) => {
    try {
      if (wasm) target = make(wasm);
      const on = await target;
      const start = performance.now();
      const results = perform(on, calls);
      const ms = performance.now() - start;
      const moved = [];
      const owned = results.map((result) => own(result, memory(), spare, moved));
      scope.postMessage({ id, results: owned, ms }, moved);
    } catch ({ name, message }) {
      scope.postMessage({ id, error: { name, message } });
    }
  });
}

/** A result without views of the core's memory: they are copied, a picture into `spare` if it has its size. */
function own(value, memory, spare, moved) {
  if (value?.data) return { ...value, data: own(value.data, memory, spare, moved) };
  if (!ArrayBuffer.isView(value) || value.buffer !== memory) return value;
  let copy;
  if (spare?.byteLength === value.byteLength) {
    copy = new value.constructor(spare);
    copy.set(value);
  } else {
    copy = value.slice();
  }
  moved.push(copy.buffer);
  return copy;
}
