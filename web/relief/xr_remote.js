// A see-through room in a worker: a headset's frame has a dozen milliseconds, of which the core needs most. What a frame
// asks of the room is sent along with its depth; what the room says of it comes when it comes. Two halves: the room where
// the core is, and its stand-in where the session is.
import { SeeThrough } from './xr_core.js';

/** A buffer without what belongs to the session's thread: its texture. */
function plain({ width, height, data, format, bufferFromView, projection, pose, head, rawToMetres, near, far, timeMs, every }) {
  return { width, height, data, format, bufferFromView, projection, pose, head, rawToMetres, near, far, timeMs, every };
}

/** Gives a Relief in a worker what RemoteSee calls. */
export function attachSeeThrough(relief) {
  const see = new SeeThrough(relief), statics = new Map(), holds = [false, false];
  const acts = {
    open: (buffer, isAnew) => { see.isOpen &&= !isAnew; see.open(buffer); statics.clear(); },
    pinch: (which, ...place) => { holds[which] = see.pinch(which, ...place); },
    addHull: (key, ...solid) => { statics.set(key, see.addHull(...solid)); },
    removeStatic: (key) => { if (statics.has(key)) see.removeStatic(statics.get(key)); },
  };

  /** Commands [name, ...arguments], each by itself, then a buffer. */
  relief.seeFrame = (commands, buffer) => {
    const troubles = [];
    const attempt = (name, run) => {
      try {
        return run();
      } catch (error) {
        troubles.push([name, error.name, error.message]);
        return undefined;
      }
    };
    for (const [name, ...args] of commands) attempt(name, () => (acts[name] ?? see[name].bind(see))(...args));
    const isNew = attempt('push', () => see.push(buffer));
    return { isNew, holds, bodies: see.isOpen ? see.bodies() : [], troubles };
  };
}

/** SeeThrough's calls, of a RemoteRelief. What they return is what the room said last. */
export class RemoteSee {
  #remote;
  #commands = [];
  #last = { bodies: [], holds: [false, false] };
  #isBusy = false;
  #handles = 0;

  constructor(remote) {
    this.#remote = remote;
    this.isOpen = false;
  }

  open(buffer) {
    this.#command('open', { ...plain(buffer), data: null }, !this.isOpen);
    this.isOpen = true;
    return this;
  }

  /** `done({isNew, troubles, ms})` once the room has taken the buffer; one that comes while it is busy is left out. */
  send(buffer, done) {
    if (this.#isBusy) return;
    this.#isBusy = true;
    const commands = this.#commands;
    this.#commands = [];
    this.#remote.call('seeFrame', commands, plain(buffer)).then((said) => {
      this.#last = said;
      this.#isBusy = false;
      done({ ...said, ms: this.#remote.ms });
    }, (error) => {
      this.#isBusy = false;
      done({ isNew: undefined, troubles: [['push', error.name, error.message]], ms: 0 });
    });
  }

  bodies() { return this.#last.bodies; }
  addBody(body) { this.#command('addBody', body); }
  place(id, position, quaternion) { this.#command('place', id, position, quaternion); }
  remove(id) { this.#command('remove', id); }
  setGravity(x, y, z) { this.#command('setGravity', x, y, z); }
  hand(which, bones) { this.#latest('hand', which, bones && bones.slice()); }

  pinch(which, position, quaternion) {
    this.#latest('pinch', which, position, quaternion);
    return this.#last.holds[which];
  }

  addHull(corners, triangles, position, quaternion) {
    this.#command('addHull', ++this.#handles, corners, triangles, position, quaternion);
    return this.#handles;
  }

  removeStatic(handle) { this.#command('removeStatic', handle); }

  close() {
    this.isOpen = false;
    this.#remote.close();
  }

  #command(...command) { this.#commands.push(command); }

  /** Of a hand only where it is now counts. */
  #latest(name, which, ...args) {
    this.#commands = this.#commands.filter(([other, of]) => other !== name || of !== which);
    this.#command(name, which, ...args);
  }
}
