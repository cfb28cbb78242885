// "spawn" of a scene.json: many bodies from one, at the places and with the variety of the command's.
import { cosine, sine } from './sine.js';

const MASK = (1n << 64n) - 1n;

/** SplitMix64 (Steele, Lea, Flood 2014): a seed's streams have nothing to do with each other. */
class Random {
  constructor(seed, stream) {
    this.state = BigInt.asUintN(32, BigInt(seed)) << 32n | BigInt.asUintN(32, BigInt(stream));
    this.state = this.next();
  }

  next() {
    this.state = (this.state + 0x9e3779b97f4a7c15n) & MASK;
    let z = this.state;
    z = ((z ^ z >> 30n) * 0xbf58476d1ce4e5b9n) & MASK;
    z = ((z ^ z >> 27n) * 0x94d049bb133111ebn) & MASK;
    return z ^ z >> 31n;
  }

  uniform() { return Number(this.next() >> 11n) * 2 ** -53; }
  about(reach) { return reach.map((r) => (2 * this.uniform() - 1) * r); }

  /** All orientations alike (Shoemake 1992). */
  turn() {
    const u = this.uniform();
    const a = 2 * Math.PI * this.uniform(), b = 2 * Math.PI * this.uniform();
    const s = Math.sqrt(1 - u), c = Math.sqrt(u);
    return [s * sine(a), s * cosine(a), c * sine(b), c * cosine(b)];
  }
}

function placeGrid({ count: [nx, ny, nz], spacing }) {
  return Array.from({ length: nx * ny * nz }, (_, i) => {
    const layer = nx * nz;
    return [(i % nx - 0.5 * (nx - 1)) * spacing[0], (0.5 * (ny - 1) - Math.floor(i / layer)) * spacing[1],
      (Math.floor(i % layer / nx) - 0.5 * (nz - 1)) * spacing[2]];
  });
}

function placeStack({ count, spacing }) {
  return Array.from({ length: count }, (_, i) => [0, -i * spacing, 0]);
}

function placeRing({ count, radius }) {
  return Array.from({ length: count }, (_, i) => {
    const angle = 2 * Math.PI * i / count;
    return [radius * cosine(angle), 0, radius * sine(angle)];
  });
}

/** The box cut into the largest cells of which there are `count`. */
function cutBox(box, count) {
  const cells = (edge) => box.map((extent) => Math.trunc(Math.max(1, extent / edge)));
  const total = ([a, b, c]) => a * b * c;
  const longest = Math.max(...box);
  let low = longest / (count + 1), high = 2 * longest;
  for (let i = 0; i < 60; i++) {
    const middle = 0.5 * (low + high);
    if (total(cells(middle)) >= count) low = middle; else high = middle;
  }
  return cells(Math.max(low, 1e-12));
}

/** Each in a cell of its own, so that none begins inside another. */
function placeRandom({ count, box }, seed, reach) {
  const n = cutBox(box, count);
  const cells = Array.from({ length: n[0] * n[1] * n[2] }, (_, i) => i);
  const random = new Random(seed, -1);
  return Array.from({ length: count }, (_, i) => {
    const k = i + Math.trunc(random.uniform() * (cells.length - i));
    const cell = cells[k];
    cells[k] = cells[i];
    const at = [cell % n[0], Math.trunc(cell / n[0]) % n[1], Math.trunc(cell / n[0] / n[1])];
    return at.map((c, axis) => {
      const width = box[axis] / n[axis];
      return (c + 0.5) * width - 0.5 * box[axis] + (random.uniform() - 0.5) * Math.max(0, width - 2 * reach);
    });
  });
}

/** Largest distance from a body's centre to its surface. */
function reachOf({ shape = 'box', size = [0.1, 0.1, 0.1], radius = 0, height = 0 }) {
  if (shape === 'box') return 0.5 * Math.hypot(...size);
  if (shape === 'cylinder') return Math.hypot(radius, 0.5 * height);
  return shape === 'capsule' ? radius + 0.5 * height : radius;
}

function placesOf(entry, seed) {
  switch (entry.pattern) {
    case 'grid': return placeGrid(entry);
    case 'stack': return placeStack(entry);
    case 'ring': return placeRing(entry);
    case 'random': return placeRandom(entry, seed, reachOf(entry.body));
    default: throw new Error(`spawn pattern '${entry.pattern}': there are grid, stack, ring, random`);
  }
}

const add = (a, b) => a.map((v, i) => v + b[i]);

/** The bodies of entry number `index` of "spawn". */
export function spawn(entry, index) {
  const { body, interval = 0, seed = index, turned = false, colors } = entry;
  const { position = [0, 0, 1], velocity = [0, 0, 0], angular_velocity: spin = [0, 0, 0], release_time: release = 0 } = body;
  return placesOf(entry, seed).map((place, i) => {
    const random = new Random(seed, i);
    const turn = random.turn(); // all numbers are drawn, needed or not
    return { ...body, position: add(position, place), ...(turned ? { orientation: turn } : {}),
      velocity: add(velocity, random.about(entry.velocity_spread ?? [0, 0, 0])),
      angular_velocity: add(spin, random.about(entry.angular_velocity_spread ?? [0, 0, 0])),
      release_time: release + i * interval, ...(colors ? { color: colors[i % colors.length] } : {}) };
  });
}
