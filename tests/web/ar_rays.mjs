// Exact answers about a captured room's mesh: where a ray meets it, how far a point is from it; and what a view's
// picture shows where.

/** Triangles of all captured meshes, in the world. */
export function meshOf(sem) {
  const soup = [];
  sem.scene.updateMatrixWorld(true);
  sem.meshes.traverse((mesh) => {
    const position = mesh.geometry?.attributes?.position;
    if (!position) return;
    const index = mesh.geometry.index, m = mesh.matrixWorld.elements;
    for (let i = 0; i < (index?.count ?? position.count); i++) {
      const k = index ? index.getX(i) : i;
      const [x, y, z] = [position.getX(k), position.getY(k), position.getZ(k)];
      for (let r = 0; r < 3; r++) soup.push(m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r]);
    }
  });
  return withoutSlivers(Float64Array.from(soup));
}

function withoutSlivers(soup) {
  const kept = [];
  for (let t = 0; t < soup.length; t += 9) {
    const [ux, uy, uz, vx, vy, vz] = [3, 4, 5, 6, 7, 8].map((k) => soup[t + k] - soup[t + (k % 3)]);
    if (Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) > 1e-10) kept.push(...soup.subarray(t, t + 9));
  }
  return Float64Array.from(kept);
}

/** Distance along a ray in lengths of d to the mesh (Moller and Trumbore 1997); Infinity = none. */
export function cast(soup, o, d) {
  let best = Infinity;
  for (let t = 0; t < soup.length; t += 9) {
    const ux = soup[t + 3] - soup[t], uy = soup[t + 4] - soup[t + 1], uz = soup[t + 5] - soup[t + 2];
    const vx = soup[t + 6] - soup[t], vy = soup[t + 7] - soup[t + 1], vz = soup[t + 8] - soup[t + 2];
    const px = d[1] * vz - d[2] * vy, py = d[2] * vx - d[0] * vz, pz = d[0] * vy - d[1] * vx;
    const det = ux * px + uy * py + uz * pz;
    if (Math.abs(det) < 1e-14) continue;
    const sx = o[0] - soup[t], sy = o[1] - soup[t + 1], sz = o[2] - soup[t + 2];
    const u = (sx * px + sy * py + sz * pz) / det;
    if (u < 0 || u > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
    const at = (vx * qx + vy * qy + vz * qz) / det;
    if (v >= 0 && u + v <= 1 && at > 1e-6 && at < best) best = at;
  }
  return best;
}

/** The distance from a point to the mesh. */
export function distance(soup, p) {
  let best = Infinity;
  for (let t = 0; t < soup.length; t += 9) {
    const q = nearest(soup, t, p);
    best = Math.min(best, (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2 + (q[2] - p[2]) ** 2);
  }
  return Math.sqrt(best);
}

/** The point of a triangle nearest to p (Ericson 2005, 5.1.5). */
function nearest(soup, t, p) {
  const a = soup.subarray(t, t + 3), b = soup.subarray(t + 3, t + 6), c = soup.subarray(t + 6, t + 9);
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const sub = (u, v) => [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
  const along = (from, way, s) => [from[0] + s * way[0], from[1] + s * way[1], from[2] + s * way[2]];
  const ab = sub(b, a), ac = sub(c, a), ap = sub(p, a);
  const d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = sub(p, b), d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return along(a, ab, d1 / (d1 - d3));
  const cp = sub(p, c), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return along(a, ac, d2 / (d2 - d6));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return along(b, sub(c, b), (d4 - d3) / (d4 - d3 + d5 - d6));
  const sum = va + vb + vc;
  return [0, 1, 2].map((k) => a[k] + (ab[k] * vb + ac[k] * vc) / sum);
}

function toView({ transform: { matrix: m } }, p) {
  const way = [p[0] - m[12], p[1] - m[13], p[2] - m[14]];
  return [0, 1, 2].map((c) => m[4 * c] * way[0] + m[4 * c + 1] * way[1] + m[4 * c + 2] * way[2]);
}

/** Where a point is in a view's picture, 0..1 from the lower left, or null. */
export function project(view, p) {
  const [x, y, z] = toView(view, p), P = view.projectionMatrix;
  const at = [(P[0] * x + P[8] * z) / -z, (P[5] * y + P[9] * z) / -z].map((t) => 0.5 * t + 0.5);
  return z < -0.1 && at.every((t) => t > 0.02 && t < 0.98) ? at : null;
}

/** The point of a view's picture as a ray of length 1 along z. */
export function rayOf(view, [u, v]) {
  const P = view.projectionMatrix, m = view.transform.matrix;
  const t = [(2 * u - 1 + P[8]) / P[0], (2 * v - 1 + P[9]) / P[5], -1];
  return { o: [m[12], m[13], m[14]], d: [0, 1, 2].map((r) => m[r] * t[0] + m[4 + r] * t[1] + m[8 + r] * t[2]) };
}

/** Distance along a ray to the front of a ball, in lengths of d; Infinity: it misses. */
export function castBall({ o, d }, { position, size: [r] }) {
  const w = o.map((x, k) => x - position[k]), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const a = dot(d, d), b = dot(w, d), root = b * b - a * (dot(w, w) - r * r);
  return root < 0 ? Infinity : (-b - Math.sqrt(root)) / a;
}
