// WebXR's hands: 25 joints become 24 capsules that push, and a pinch of thumb and index takes hold.

const FINGERS = ['index', 'middle', 'ring', 'pinky'];
const JOINTS = ['wrist', 'thumb-metacarpal', 'thumb-phalanx-proximal', 'thumb-phalanx-distal', 'thumb-tip',
  ...FINGERS.flatMap((f) => ['metacarpal', 'phalanx-proximal', 'phalanx-intermediate', 'phalanx-distal', 'tip'].map((j) =>
    `${f}-finger-${j}`))];
// Each joint but the wrist ends a bone that begins at the joint before it, or at the wrist.
const BONES = JOINTS.slice(1).map((name, i) => [name.endsWith('metacarpal') ? 0 : i, i + 1]);
const CLOSES_M = 0.02, OPENS_M = 0.04; // between the tips: a pinch begins, and ends
const THUMB_TIP = 4, INDEX_TIP = 9;
const SIDES = { left: 0, right: 1 };

class Hand {
  constructor() {
    this.transforms = new Float32Array(16 * JOINTS.length);
    this.radii = new Float32Array(JOINTS.length);
    this.bones = new Float32Array(8 * BONES.length);
    this.pinches = false;
  }

  /** False: it is not tracked. */
  read(frame, hand, space) {
    this.spaces ??= JOINTS.map((name) => hand.get(name));
    if (!frame.fillPoses(this.spaces, space, this.transforms)) return false;
    if (!frame.fillJointRadii(this.spaces, this.radii)) return false;
    BONES.forEach(([from, to], i) => {
      for (let k = 0; k < 3; k++) {
        this.bones[8 * i + k] = this.transforms[16 * from + 12 + k];
        this.bones[8 * i + 3 + k] = this.transforms[16 * to + 12 + k];
      }
      this.bones[8 * i + 6] = Math.min(this.radii[from], this.radii[to]);
    });
    return this.bones.every(Number.isFinite);
  }

  /** Where the tips meet; null: they do not. */
  pinch() {
    const tip = (joint) => this.transforms.subarray(16 * joint + 12, 16 * joint + 15);
    const a = tip(THUMB_TIP), b = tip(INDEX_TIP);
    const apart = Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    this.pinches = apart < (this.pinches ? OPENS_M : CLOSES_M);
    return this.pinches ? [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2] : null;
  }

  /** How the wrist is turned: what is held turns with it. */
  turn() { return quaternionOf(this.transforms); }
}

/** Quaternion x y z w of a rigid matrix, by columns (Shepperd 1978). */
export function quaternionOf(m) {
  const trace = m[0] + m[5] + m[10];
  const squares = [1 + 2 * m[0] - trace, 1 + 2 * m[5] - trace, 1 + 2 * m[10] - trace, 1 + trace];
  const largest = squares.indexOf(Math.max(...squares));
  const s = 2 * Math.sqrt(squares[largest]);
  const q = [
    [s / 4, (m[1] + m[4]) / s, (m[2] + m[8]) / s, (m[6] - m[9]) / s],
    [(m[1] + m[4]) / s, s / 4, (m[6] + m[9]) / s, (m[8] - m[2]) / s],
    [(m[2] + m[8]) / s, (m[6] + m[9]) / s, s / 4, (m[1] - m[4]) / s],
    [(m[6] - m[9]) / s, (m[8] - m[2]) / s, (m[1] - m[4]) / s, s / 4],
  ][largest];
  const length = Math.hypot(...q);
  return q.map((x) => x / length);
}

export class Hands {
  #hands = [new Hand(), new Hand()];

  /** `onEmptyPinch(place)`: a pinch began and nothing was in reach. */
  constructor(see, onEmptyPinch = () => {}) {
    Object.assign(this, { see, onEmptyPinch });
  }

  /** Before each frame of the core. */
  update(frame, sources, space) {
    const seen = [false, false];
    for (const source of sources) {
      const which = SIDES[source.handedness];
      if (!source.hand || which === undefined) continue;
      const hand = this.#hands[which];
      if (!hand.read(frame, source.hand, space)) continue;
      seen[which] = true;
      this.#touch(which, hand);
    }
    seen.forEach((is, which) => {
      if (is) return;
      this.#hands[which].pinches = false;
      this.see.hand(which, null);
      this.see.pinch(which, null);
    });
    return seen;
  }

  #touch(which, hand) {
    const began = !hand.pinches;
    const place = hand.pinch();
    const holds = this.see.pinch(which, place, hand.turn());
    if (place !== null && began && !holds) this.onEmptyPinch(place);
    this.see.hand(which, hand.bones);
  }
}
