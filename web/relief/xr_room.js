// What a device knows of the room beside its depth: detected planes and meshes stand in it, and anchors keep bodies.
import { middleOf } from './xr_core.js';
import { quaternionOf } from './xr_hands.js';

// Depth tells where a surface is; what was detected is often off by a centimetre. It lies this far behind, as a net for
// what no depth has seen yet.
const BEHIND_M = 0.02, THICK_M = 0.1;
const MOVED_M = 0.002, MOVED_RAD = 0.004;
const LEFT_M = 0.01; // from its anchor: the body was moved, and the anchor goes
const ANCHORS = 16;  // devices have few

const place = (m) => [m[12], m[13], m[14]];

/** Corners of a plane's outline in their order about its +y, or null where it is not convex. */
function convexOutline(polygon) {
  const points = polygon.map(({ x, z }) => [x, z]).filter((p, i, all) => {
    const next = all[(i + 1) % all.length]; // an outline may be told with its first corner again at the end
    return Math.hypot(p[0] - next[0], p[1] - next[1]) > 1e-4;
  });
  const turns = points.map((p, i) => {
    const a = points[(i + 1) % points.length], b = points[(i + 2) % points.length];
    return (a[0] - p[0]) * (b[1] - a[1]) - (a[1] - p[1]) * (b[0] - a[0]);
  });
  if (points.length < 3 || !(turns.every((t) => t >= -1e-6) || turns.every((t) => t <= 1e-6))) return null;
  return turns.some((t) => t > 1e-6) ? points.reverse() : points;
}

/** A plate behind an outline as seen from side 1 or -1 of the plane: corners and triangles. */
function plate(outline, side) {
  const n = outline.length;
  const points = side > 0 ? outline : [...outline].reverse();
  const corners = [-BEHIND_M, -BEHIND_M - THICK_M].flatMap((y) => points.flatMap(([x, z]) => [x, side * y, z]));
  const triangles = [];
  for (let i = 1; i + 1 < n; i++) triangles.push(0, i, i + 1, n, n + i + 1, n + i);
  for (let i = 0; i < n; i++) triangles.push(i, n + i, n + ((i + 1) % n), i, n + ((i + 1) % n), (i + 1) % n);
  return { corners, triangles };
}

/** A mesh drawn in by BEHIND_M, or null where it is not convex: a whole room is none. */
function convexMesh(vertices, indices) {
  if (vertices.length > 3 * 256 || indices.length > 3 * 512 || indices.length < 12) return null;
  const at = (i) => [vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]];
  const middle = middleOf(vertices);
  let nearest = Infinity, isConvex = true;
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [at(indices[t]), at(indices[t + 1]), at(indices[t + 2])];
    const u = b.map((x, k) => x - a[k]), v = c.map((x, k) => x - a[k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(...n);
    if (length < 1e-9) continue;
    const height = (p) => n.reduce((sum, x, k) => sum + x * (p[k] - a[k]), 0) / length;
    nearest = Math.min(nearest, -height(middle));
    for (let i = 0; 3 * i < vertices.length && isConvex; i++) isConvex = height(at(i)) < 0.005;
  }
  if (!isConvex || !(nearest > 2 * BEHIND_M)) return null;
  const scale = 1 - BEHIND_M / nearest;
  return { corners: Array.from(vertices, (x, i) => middle[i % 3] + scale * (x - middle[i % 3])), triangles: [...indices] };
}

/** What a thing is but for its place: some devices say at every frame that it changed. */
function formOf({ polygon, vertices, indices }) {
  if (!polygon) return `${vertices.length} ${indices.length}`;
  return [...polygon].map(({ x, z }) => `${x.toFixed(3)} ${z.toFixed(3)}`).join();
}

/** Planes and meshes that the device detects. */
export class DetectedRoom {
  #things = new Map(); // plane or mesh: {time, form, at, handle}

  constructor(see, tell) {
    Object.assign(this, { see, tell });
  }

  /** Things that stand in the core's room, and those that could not. */
  get count() { return [...this.#things.values()].filter(({ handle }) => handle >= 0).length; }
  get leftOut() { return this.#things.size - this.count; }

  /** `head`: where from it is seen. */
  update(frame, space, head) {
    const seen = new Set(), { leftOut } = this;
    for (const plane of frame.detectedPlanes ?? []) this.#take(frame, space, plane, plane.planeSpace, head, seen);
    for (const mesh of frame.detectedMeshes ?? []) this.#take(frame, space, mesh, mesh.meshSpace, head, seen);
    for (const [thing, { handle }] of this.#things) {
      if (seen.has(thing)) continue;
      if (handle >= 0) this.see.removeStatic(handle);
      this.#things.delete(thing);
    }
    if (this.leftOut > leftOut) {
      this.tell('room', `${this.leftOut} detected shapes are not convex: live depth answers for them`);
    }
  }

  /** The core's room is a new one. */
  forget() { this.#things.clear(); }

  #take(frame, space, thing, own, head, seen) {
    seen.add(thing);
    const before = this.#things.get(thing);
    if (before !== undefined && before.time === thing.lastChangedTime) return;
    const pose = frame.getPose(own, space);
    if (!pose) return;
    const { matrix } = pose.transform;
    const at = { position: place(matrix), quaternion: quaternionOf(matrix) }, form = formOf(thing);
    if (before !== undefined && before.form === form && !hasMoved(at, before.at)) {
      before.time = thing.lastChangedTime;
      return;
    }
    if (before?.handle >= 0) this.see.removeStatic(before.handle);
    this.#things.set(thing, { time: thing.lastChangedTime, form, at, handle: this.#add(thing, at, matrix, head) });
  }

  #add(thing, { position, quaternion }, matrix, head) {
    // The free side of a plane is the one that it is seen from: devices do not agree on the way of its y.
    const height = [0, 1, 2].reduce((sum, k) => sum + matrix[4 + k] * (head[12 + k] - matrix[12 + k]), 0);
    const outline = thing.polygon ? convexOutline([...thing.polygon]) : null;
    const solid = thing.polygon ? outline && plate(outline, height < 0 ? -1 : 1) : convexMesh(thing.vertices, thing.indices);
    if (!solid) return -1;
    try {
      return this.see.addHull(solid.corners, solid.triangles, position, quaternion);
    } catch (error) {
      this.tell('room', `a detected shape is left out: ${error.message}`);
      return -1;
    }
  }
}

function hasMoved(a, b) {
  const turn = 2 * Math.acos(Math.min(1, Math.abs(a.quaternion.reduce((sum, x, k) => sum + x * b.quaternion[k], 0))));
  return Math.hypot(...a.position.map((x, k) => x - b.position[k])) > MOVED_M || turn > MOVED_RAD;
}

/** A body that rests gets an anchor; when the device corrects where that is, the body moves with it. */
export class Anchors {
  #held = new Map(); // body's id: {anchor, at, body} or {} while it is asked for

  constructor(see, tell) {
    Object.assign(this, { see, tell, moved: 0 });
  }

  get count() { return this.#held.size; }

  /** `bodies`: as the core's last frame left them. */
  update(frame, space, bodies) {
    if (typeof frame.createAnchor !== 'function') return;
    const keys = new Set();
    for (const body of bodies) {
      const key = body.id.join(' ');
      keys.add(key);
      const held = this.#held.get(key);
      if (held?.anchor) this.#follow(frame, space, held, body, key);
      else if (held === undefined && body.isAsleep && this.#held.size < ANCHORS) this.#ask(frame, space, body, key);
    }
    for (const [key, { anchor }] of this.#held) if (!keys.has(key)) this.#drop(key, anchor);
  }

  #follow(frame, space, held, body, key) {
    const pose = frame.getPose(held.anchor.anchorSpace, space);
    if (!pose) return;
    const now = { position: place(pose.transform.matrix), quaternion: quaternionOf(pose.transform.matrix) };
    if (Math.hypot(...body.position.map((x, k) => x - held.body[k])) > LEFT_M) {
      this.#drop(key, held.anchor);
    } else if (hasMoved(now, held.at)) {
      this.see.place(body.id, now.position, now.quaternion);
      Object.assign(held, { at: now, body: now.position });
      this.moved++;
    }
  }

  #ask(frame, space, { position: [x, y, z], quaternion: [a, b, c, d] }, key) {
    const held = { body: [x, y, z], at: { position: [x, y, z], quaternion: [a, b, c, d] } };
    this.#held.set(key, held);
    frame.createAnchor(new XRRigidTransform({ x, y, z }, { x: a, y: b, z: c, w: d }), space).then(
      (anchor) => { held.anchor = anchor; },
      (error) => this.tell('anchors', `no anchor: ${error.message}`),
    );
  }

  #drop(key, anchor) {
    anchor?.delete();
    this.#held.delete(key);
  }
}
