// Meshes of the core's shapes at unit size. A corner is base * scale + (0, side * half, 0): so capsules keep round caps.

const LAT = 16, LON = 24;

/** Rows of a surface of revolution about y: [radius, y, side, normal's radius, normal's y]. */
function revolve(rows) {
  const corners = [], triangles = [];
  for (const [radius, y, side, nr, ny] of rows) {
    for (let i = 0; i <= LON; i++) {
      const c = Math.cos((2 * Math.PI * i) / LON), s = Math.sin((2 * Math.PI * i) / LON);
      corners.push(radius * c, y, radius * s, side, nr * c, ny, nr * s);
    }
  }
  for (let r = 0; r + 1 < rows.length; r++) {
    for (let i = 0; i < LON; i++) {
      const a = r * (LON + 1) + i, b = a + LON + 1;
      triangles.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  return { corners, triangles };
}

/** A ball whose halves may stand apart. */
function ball() {
  const rows = [];
  for (let half = 0; half < 2; half++) {
    for (let i = 0; i <= LAT / 2; i++) {
      const angle = (Math.PI * (half * (LAT / 2) + i)) / LAT;
      rows.push([Math.sin(angle), Math.cos(angle), half === 0 ? 1 : -1, Math.sin(angle), Math.cos(angle)]);
    }
  }
  return revolve(rows);
}

const cylinder = () => revolve([[0, 0.5, 0, 0, 1], [1, 0.5, 0, 0, 1], [1, 0.5, 0, 1, 0], [1, -0.5, 0, 1, 0],
  [1, -0.5, 0, 0, -1], [0, -0.5, 0, 0, -1]]);

function box() {
  const corners = [], triangles = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const sign of [-1, 1]) {
      const first = corners.length / 7;
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
        const p = [0, 0, 0], n = [0, 0, 0];
        p[axis] = sign / 2;
        n[axis] = sign;
        p[(axis + 1) % 3] = (u * sign) / 2;
        p[(axis + 2) % 3] = v / 2;
        corners.push(...p, 0, ...n);
      }
      triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  }
  return { corners, triangles };
}

/** Corners of 7 floats: base, side, normal; triangles. */
export const MESHES = { sphere: ball(), box: box(), capsule: ball(), cylinder: cylinder() };

/** Scale and half of a body for its mesh, and the radius of the sphere about it. */
export function measures({ shape, size: [x, y, z] }) {
  if (shape === 'box') return { scale: [x, y, z], half: 0, radius: Math.hypot(x, y, z) / 2 };
  if (shape === 'capsule') return { scale: [x, x, x], half: y / 2, radius: x + y / 2 };
  if (shape === 'cylinder') return { scale: [x, y, x], half: 0, radius: Math.hypot(x, y / 2) };
  return { scale: [x, x, x], half: 0, radius: x };
}
