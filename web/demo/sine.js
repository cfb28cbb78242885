// Sine and cosine of the core, src/math/elementary.c, step by step: a browser's own may differ in the last bit, and places
// that are drawn by them are to be the command's.
const HALF_PI_HIGH = 1.57079632673412561417, HALF_PI_LOW = 6.07710050650619224932e-11;
const SINE = [-1 / 1307674368000, 1 / 6227020800, -1 / 39916800, 1 / 362880, -1 / 5040, 1 / 120, -1 / 6];
const COSINE = [1 / 20922789888000, -1 / 87178291200, 1 / 479001600, -1 / 3628800, 1 / 40320, -1 / 720, 1 / 24];

const series = (terms, z) => terms.reduce((sum, term) => sum * z + term);
const sineNear0 = (x) => x + x * (x * x) * series(SINE, x * x);
const cosineNear0 = (x) => 1 - 0.5 * (x * x) + x * x * (x * x) * series(COSINE, x * x);

function quadrant(x, shift) {
  if (!(Math.abs(x) <= 1e5)) return 0;
  const k = x * (2 / Math.PI);
  const n = Math.trunc(k < 0 ? k - 0.5 : k + 0.5);
  const r = (x - n * HALF_PI_HIGH) - n * HALF_PI_LOW;
  const turned = (n + shift) & 3;
  const value = turned % 2 === 0 ? sineNear0(r) : cosineNear0(r);
  return turned < 2 ? value : -value;
}

export const sine = (x) => quadrant(x, 0);
export const cosine = (x) => quadrant(x, 1);
