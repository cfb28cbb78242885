// A mock of a see-through device's depth: what it would give of an analytic scene, or of depth planes of the synthetic
// room, by any projection, pose, turn, mirroring and crop of the buffer, in any format.

export const multiply = (a, b) => {
  const out = new Float64Array(16);
  for (let c = 0; c < 4; c++) {
    for (let r = 0; r < 4; r++) {
      for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    }
  }
  return out;
};

/** A frustum by tangents of its sides, as WebXR's projectionMatrix, by columns. */
export function frustum(left, right, bottom, top, near = 0.1, far = 1000) {
  const p = new Float64Array(16);
  p[0] = 2 / (right - left);
  p[5] = 2 / (top - bottom);
  p[8] = (right + left) / (right - left);
  p[9] = (top + bottom) / (top - bottom);
  p[10] = -(far + near) / (far - near);
  p[11] = -1;
  p[14] = (-2 * far * near) / (far - near);
  return p;
}

/** Pose of a view that stands at p, turned about y and then x. */
export function poseOf([x, y, z], yaw = 0, pitch = 0) {
  const cy = Math.cos(yaw), sy = Math.sin(yaw), cx = Math.cos(pitch), sx = Math.sin(pitch);
  return new Float64Array([cy, 0, -sy, 0, sy * sx, cx, cy * sx, 0, sy * cx, -sx, cy * cx, 0, x, y, z, 1]);
}

// Buffer coordinates by view coordinates, both 0..1 from the top left: rows of [a, b, c], u = a x + b y + c.
export const TURNS = {
  0: [[1, 0, 0], [0, 1, 0]],
  90: [[0, 1, 0], [-1, 0, 1]],
  180: [[-1, 0, 1], [0, -1, 1]],
  270: [[0, -1, 1], [1, 0, 0]],
  flip: [[1, 0, 0], [0, -1, 1]],
  mirror: [[-1, 0, 1], [0, 1, 0]],
  transpose: [[0, 1, 0], [1, 0, 0]],
};

/** normDepthBufferFromNormView: the turn, then a crop: the view is `scale` of the buffer, `offset` from its corner. */
export function bufferMatrix(turn, { scale = [1, 1], offset = [0, 0] } = {}) {
  const m = new Float64Array(16);
  TURNS[turn].forEach(([a, b, c], row) => {
    m[row] = a * scale[row];
    m[4 + row] = b * scale[row];
    m[12 + row] = c * scale[row] + offset[row];
  });
  m[10] = m[15] = 1;
  return m;
}

const invert2 = (m) => {
  const [a, c, b, d, e, f] = [m[0], m[1], m[4], m[5], m[12], m[13]];
  const det = a * d - b * c;
  return (u, v) => [(d * (u - e) - b * (v - f)) / det, (a * (v - f) - c * (u - e)) / det];
};

/** The point at distance 1 along z of each pixel, in the world, and its origin: for casting. */
export function rays({ width, height, bufferFromView, projection, pose }) {
  const toView = invert2(bufferFromView);
  const out = new Float64Array(3 * width * height);
  for (let j = 0; j < height; j++) {
    for (let i = 0; i < width; i++) {
      const [vx, vy] = toView((i + 0.5) / width, (j + 0.5) / height);
      const x = (2 * vx - 1 + projection[8]) / projection[0], y = (1 - 2 * vy + projection[9]) / projection[5];
      for (let k = 0; k < 3; k++) out[3 * (j * width + i) + k] = pose[k] * x + pose[4 + k] * y - pose[8 + k];
    }
  }
  return { origin: [pose[12], pose[13], pose[14]], out };
}

/** Raw values of metres in a format, with its scale; 0 = missing. */
export function encode(metres, format) {
  if (format === 'float32') return { data: Float32Array.from(metres).buffer, rawToMetres: 1, format };
  const raw = Uint16Array.from(metres, (z) => Math.min(65535, Math.round(z * 4000)));
  return { data: raw.buffer, rawToMetres: 0.00025, format };
}

/** A depth buffer of a view of `cast(origin, direction)`, which gives the distance in directions' lengths; 0 = none. */
export function depthBuffer(view, cast, format, timeMs, holes = () => false) {
  const { origin, out } = rays(view);
  const metres = new Float64Array(view.width * view.height);
  for (let i = 0; i < metres.length; i++) {
    metres[i] = holes(i) ? 0 : cast(origin, out.subarray(3 * i, 3 * i + 3));
  }
  return { ...view, ...encode(metres, format), timeMs };
}

const plane = (o, d, axis, at) => ((at - o[axis]) / d[axis] > 1e-9 ? (at - o[axis]) / d[axis] : Infinity);

function box(o, d, low, high) {
  let enter = 0, leave = Infinity;
  for (let k = 0; k < 3; k++) {
    const a = (low[k] - o[k]) / d[k], b = (high[k] - o[k]) / d[k];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave && enter > 0 ? enter : Infinity;
}

/** A room of 5 x 2.6 x 5 m about the origin, floor at y = 0, with a table and boxes. */
export function furnished(o, d) {
  const t = Math.min(plane(o, d, 1, 0), plane(o, d, 1, 2.6), plane(o, d, 0, -2.5), plane(o, d, 0, 2.5),
    plane(o, d, 2, -2.5), plane(o, d, 2, 2.5), box(o, d, [-0.6, 0, -2], [0.2, 0.72, -1.4]),
    box(o, d, [0.7, 0, -1.8], [1.1, 0.4, -1.3]));
  return Number.isFinite(t) ? t : 0;
}
