// Where frames come from: the synthetic room, or a recording. Both play round and round.
const CUT_MS = 2000; // between the last frame and the first again: long enough for bodies to wait

/** The simulated room of an address. */
export class RoomSource {
  constructor(relief, address, scene) {
    this.relief = relief;
    this.fps = 30;
    this.open = () => relief.openSynthetic(address, { bodies: scene, end: 'loop' });
    this.open();
  }

  get index() { return this.relief.index; }
  get count() { return this.relief.count; }
  async prepare() {}
  advance() { this.relief.step(); }
  seek(index) { this.relief.seek(index); }
}

function frameRate(frames) {
  const span = frames.at(-1).timeMs - frames[0].timeMs;
  return span > 0 ? Math.min(120, Math.max(1, 1000 * (frames.length - 1) / span)) : 30;
}

/** A recording of recording/open.js, with bodies in it. */
export class ClipSource {
  constructor(relief, clip, scene) {
    this.relief = relief;
    this.clip = clip;
    this.fps = frameRate(clip.frames);
    this.count = clip.frames.length;
    const gravity = clip.gravity ?? 'floor';
    this.open = () => {
      relief.openCamera(clip.camera, { bodies: { ...scene, gravity }, matchLight: !clip.isSimulated });
      this.next = 0;
      this.index = -1;
      this.offset = 0;
      this.time = 0;
    };
    this.open();
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

  advance() {
    const { depth, color, frame } = this.ready;
    const follows = this.next === this.index + 1;
    if (!follows) this.offset = this.time + CUT_MS - frame.timeMs;
    this.time = frame.timeMs + this.offset;
    this.index = this.next;
    this.next = (this.next + 1) % this.count;
    this.relief.push(depth, this.time, color);
  }

  seek(index) { this.next = index; }
}
