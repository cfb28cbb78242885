// A closed convex OBJ as a hull: about its centre of mass, and scaled to fit into a size.
function readObj(text) {
  const vertices = [], triangles = [];
  for (const line of text.split('\n')) {
    const [kind, ...rest] = line.trim().split(/\s+/);
    if (kind === 'v') vertices.push(rest.slice(0, 3).map(Number));
    if (kind === 'f') {
      const corners = rest.map((corner) => Number.parseInt(corner, 10) - 1);
      for (let i = 2; i < corners.length; i++) triangles.push([corners[0], corners[i - 1], corners[i]]);
    }
  }
  return { vertices, triangles };
}

const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The mean of the tetrahedra between the faces and the origin, by their volumes. */
function massCentre({ vertices, triangles }) {
  let volume = 0;
  const sum = [0, 0, 0];
  for (const [a, b, c] of triangles.map((t) => t.map((i) => vertices[i]))) {
    const part = dot(a, cross(b, c));
    volume += part;
    for (let i = 0; i < 3; i++) sum[i] += part * (a[i] + b[i] + c[i]) / 4;
  }
  return { volume, centre: sum.map((s) => s / volume) };
}

/** {vertices, triangles}, flat, as Relief takes them. */
export function hullOf(text, size) {
  const mesh = readObj(text);
  const { volume, centre } = massCentre(mesh);
  const extents = [0, 1, 2].map((i) => {
    const values = mesh.vertices.map((v) => v[i]);
    return Math.max(...values) - Math.min(...values);
  });
  const scale = size ? Math.min(...size.map((s, i) => s / extents[i])) : 1;
  const turned = volume < 0 ? ([a, b, c]) => [a, c, b] : (t) => t; // faces are seen from outside
  return { vertices: mesh.vertices.flatMap((v) => v.map((x, i) => scale * (x - centre[i]))),
    triangles: mesh.triangles.flatMap(turned) };
}
