// Poses {position, quaternion}: just enough to go from one camera to the other.
function turn([x, y, z, w], [a, b, c]) {
  const tx = 2 * (y * c - z * b), ty = 2 * (z * a - x * c), tz = 2 * (x * b - y * a);
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
}

export function invert({ position, quaternion: [x, y, z, w] }) {
  const quaternion = [-x, -y, -z, w];
  return { position: turn(quaternion, position).map((v) => -v), quaternion };
}

export function multiply(a, b) {
  const [ax, ay, az, aw] = a.quaternion, [bx, by, bz, bw] = b.quaternion;
  return {
    position: turn(a.quaternion, b.position).map((v, i) => v + a.position[i]),
    quaternion: [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
      aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz],
  };
}

/** T_to_from by way of known transforms; null where no way leads. */
export function findPose(transforms, from, to) {
  const edges = transforms.flatMap(({ parent, child, pose }) => [[child, parent, pose], [parent, child, invert(pose)]]);
  const known = new Map([[from, { position: [0, 0, 0], quaternion: [0, 0, 0, 1] }]]);
  for (let grew = true; grew && !known.has(to);) {
    grew = false;
    for (const [a, b, pose] of edges) {
      if (!known.has(a) || known.has(b)) continue;
      known.set(b, multiply(pose, known.get(a)));
      grew = true;
    }
  }
  return known.get(to) ?? null;
}

/** From a rotation's three rows. */
export function quaternionOf([[a, b, c], [d, e, f], [g, h, i]]) {
  const four = [1 + a - e - i, 1 - a + e - i, 1 - a - e + i, 1 + a + e + i];
  const largest = four.indexOf(Math.max(...four));
  const q = [[four[0], b + d, c + g, h - f], [b + d, four[1], f + h, c - g], [c + g, f + h, four[2], d - b],
    [h - f, c - g, d - b, four[3]]][largest];
  const length = Math.hypot(...q);
  return q.map((v) => v / length);
}
