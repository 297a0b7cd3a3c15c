// Faces of the page as arrays: vertices, triangles, motions, distances. Each is unpacked when it is first asked for.

import {unpackBytes, unpackPoints, unpackSteps} from './face_buffers.js';

const bridged = 2, upperLip = 1, lowerLip = 2;
const partedMm = 1.5;  // as animation/torn_faces.h
const alsoPartedMm = 0.5;  // beside what is torn

/** A gridded surface: positions in mm, corners of triangles, and which vertices bridge a hole. */
async function unpackGrid(grid, stepMm) {
  const [origin, positions] = await Promise.all([unpackBytes(grid.origin), unpackPoints(grid.positions, stepMm)]);
  const place = new Int32Array(origin.length).fill(-1);
  const bridges = new Uint8Array(grid.vertices);
  for (let v = 0, next = 0; v < origin.length; ++v) {
    if (origin[v] === 0) continue;
    bridges[next] = origin[v] === bridged ? 1 : 0;
    place[v] = next++;
  }
  const triangles = [];
  for (let row = 0; row + 1 < grid.rows; ++row)
    for (let col = 0; col + 1 < grid.cols; ++col) {
      const a = place[row * grid.cols + col], b = place[row * grid.cols + col + 1];
      const c = place[(row + 1) * grid.cols + col + 1], d = place[(row + 1) * grid.cols + col];
      if (a < 0 || b < 0 || c < 0 || d < 0) continue;
      triangles.push(a, b, c, a, c, d);
    }
  return {positions, bridges, triangles: Uint32Array.from(triangles)};
}

function distancesOf(steps, stepMm, noValue) {
  return Float32Array.from(steps, step => (step === noValue ? NaN : step * stepMm));
}

/** One face of the page. */
export class Face {
  constructor(packed, stepMm, noValue) {
    this.packed = packed;
    this.stepMm = stepMm;
    this.noValue = noValue;
    this.kept = new Map();
  }
  once(key, make) {
    if (!this.kept.has(key)) this.kept.set(key, make());
    return this.kept.get(key);
  }
  expression(code) { return this.packed.expressions.find(e => e.code === code); }
  shape(code, method) { return this.expression(code)?.shapes.find(s => s.method === method); }
  neutral() { return this.once('neutral', () => unpackGrid(this.packed.neutral, this.stepMm)); }
  real(code) { return this.once(`real ${code}`, () => unpackGrid(this.expression(code).real, this.stepMm)); }
  zone(code) { return this.once(`zone ${code}`, () => unpackBytes(this.expression(code).zone)); }
  nothing(code) {
    return this.once(`nothing ${code}`, async () => distancesOf(await unpackSteps(this.expression(code).nothing.distance), this.stepMm, this.noValue));
  }
  /** Motion at magnitude 1, distances to the real scan there, and the side of each vertex about the mouth. */
  motion(code, method) {
    return this.once(`motion ${code} ${method}`, async () => {
      const shape = this.shape(code, method);
      if (!shape) return null;
      const [motion, distance, lips] = await Promise.all([
        unpackPoints(shape.motion, this.stepMm), unpackSteps(shape.distance), shape.lips ? unpackBytes(shape.lips) : null]);
      let largest = 0;
      for (let k = 0; k < motion.length; k += 3) largest = Math.max(largest, Math.hypot(motion[k], motion[k + 1], motion[k + 2]));
      return {motion, largest, distance: distancesOf(distance, this.stepMm, this.noValue), lips};
    });
  }

  /** The face at some magnitudes: [code, magnitude]. */
  async animated(method, settings) {
    const neutral = await this.neutral();
    const positions = neutral.positions.slice();
    const displacement = new Float32Array(positions.length);
    let lips = null;
    for (const [code, magnitude] of settings) {
      if (magnitude === 0) continue;
      const moved = await this.motion(code, method);
      if (!moved) continue;
      lips ??= moved.lips;
      for (let k = 0; k < displacement.length; ++k) displacement[k] += magnitude * moved.motion[k];
    }
    let largest = 0;
    const length = new Float32Array(positions.length / 3);
    for (let v = 0; v < length.length; ++v) {
      length[v] = Math.hypot(displacement[3 * v], displacement[3 * v + 1], displacement[3 * v + 2]);
      largest = Math.max(largest, length[v]);
    }
    for (let k = 0; k < positions.length; ++k) positions[k] += displacement[k];
    return {positions, length, largest, bridges: neutral.bridges, triangles: withoutTorn(neutral.triangles, lips, displacement)};
  }
}

/** Lips that part leave no surface between them: as animation/torn_faces.h, one opening with whole borders. */
function withoutTorn(triangles, lips, displacement) {
  if (!lips) return triangles;
  const parting = (a, b) => (lips[a] === upperLip && lips[b] === lowerLip
    ? Math.hypot(...[0, 1, 2].map(axis => displacement[3 * a + axis] - displacement[3 * b + axis])) : 0);
  const torn = new Uint8Array(triangles.length / 3), atOpening = new Uint8Array(lips.length);
  let mayFollow = [];
  const tear = t => {
    torn[t] = 1;
    for (const v of triangles.subarray(3 * t, 3 * t + 3)) atOpening[v] = 1;
  };
  for (let t = 0; t < torn.length; ++t) {
    const corners = triangles.subarray(3 * t, 3 * t + 3);
    if (!corners.some(v => lips[v] === upperLip) || !corners.some(v => lips[v] === lowerLip)) continue;
    let widest = 0;
    for (const a of corners) for (const b of corners) widest = Math.max(widest, parting(a, b));
    if (widest > partedMm) tear(t);
    else if (widest > alsoPartedMm) mayFollow.push(t);
  }
  for (let left = -1; left !== mayFollow.length;) {
    left = mayFollow.length;
    mayFollow = mayFollow.filter(t => {
      if (!triangles.subarray(3 * t, 3 * t + 3).some(v => atOpening[v] === 1)) return true;
      tear(t);
      return false;
    });
  }
  const kept = [];
  for (let t = 0; t < torn.length; ++t) if (!torn[t]) kept.push(...triangles.subarray(3 * t, 3 * t + 3));
  return Uint32Array.from(kept);
}

/** Of the values that are known; 0 of none. */
export function quantile(values, share) {
  const known = values.filter(value => !Number.isNaN(value)).sort();
  return known.length === 0 ? 0 : known[Math.min(known.length - 1, Math.floor(share * known.length))];
}
