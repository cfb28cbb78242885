// Where frames come from: the synthetic room, or a recording. Both play round and round. A frame is what the page shows of
// it: {picture, met, ms, isFromElsewhere}.
const CUT_MS = 2000; // between the last frame and the first again: long enough for bodies to wait

class Source {
  constructor(relief, fps) {
    Object.assign(this, { relief, fps, index: -1, count: -1 });
  }

  async prepare() {}

  /** A frame by calls, and what else they return. Pictures come in two buffers in turn: one is on the screen. */
  async frame(...calls) {
    const { relief, spare } = this;
    this.spare = undefined;
    const [picture, met, ...rest] = (await relief.do([...calls, ['picture'], ['met'], ['index']], spare)).slice(calls.length);
    this.spare = this.shown;
    this.shown = relief.isElsewhere ? picture?.data.buffer : undefined;
    return [{ picture, met, ms: relief.ms, isFromElsewhere: relief.isElsewhere }, ...rest];
  }
}

/** The simulated room of an address. */
export class RoomSource extends Source {
  constructor(relief, address, scene) {
    super(relief, 30);
    this.opening = ['openSynthetic', address, { bodies: scene, end: 'loop', opensSoon: true }];
  }

  async open() { [, this.count] = await this.relief.do([this.opening, ['count']]); }

  async advance() {
    const [frame, index] = await this.frame(['step']);
    this.index = index;
    return frame;
  }

  seek(index) { return this.relief.call('seek', index); }
}

function frameRate(frames) {
  const span = frames.at(-1).timeMs - frames[0].timeMs;
  return span > 0 ? Math.min(120, Math.max(1, 1000 * (frames.length - 1) / span)) : 30;
}

/** A recording of recording/open.js, with bodies in it. */
export class ClipSource extends Source {
  constructor(relief, clip, scene) {
    super(relief, frameRate(clip.frames));
    this.clip = clip;
    this.count = clip.frames.length;
    const gravity = clip.gravity ?? 'floor';
    this.opening = ['openCamera', clip.camera, { bodies: { ...scene, gravity }, matchLight: !clip.isSimulated }];
  }

  async open() {
    await this.relief.do([this.opening]);
    Object.assign(this, { next: 0, index: -1, offset: 0, time: 0 });
  }

  /** Reads the next frame; one that cannot be read is left out, and ten in a row are an error. */
  async prepare() {
    for (let failed = 0; ; failed++) {
      const frame = this.clip.frames[this.next];
      try {
        const [depth, color] = await Promise.all([frame.depth(), frame.color()]);
        this.ready = { depth, color, frame };
        return;
      } catch (error) {
        if (failed === Math.min(9, this.count - 1)) throw error;
        this.next = (this.next + 1) % this.count;
      }
    }
  }

  async advance() {
    const { depth, color, frame } = this.ready;
    const follows = this.next === this.index + 1;
    if (!follows) this.offset = this.time + CUT_MS - frame.timeMs;
    this.time = frame.timeMs + this.offset;
    const taken = this.next;
    this.next = (this.next + 1) % this.count;
    const [shown] = await this.frame(['push', depth, this.time, color]);
    this.index = taken;
    return shown;
  }

  seek(index) { this.next = index; }
}
