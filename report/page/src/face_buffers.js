// Reads what report/page_buffers.h packed: base64, deflated, low bytes before high bytes, changes in place of values.

async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export const unpackBytes = inflated;

/** Whole steps, as an Int16Array. */
export async function unpackSteps(text) {
  const planes = await inflated(text);
  const count = planes.length / 2;
  const steps = new Int16Array(count);
  let now = 0;
  for (let k = 0; k < count; ++k) {
    const folded = planes[k] | planes[count + k] << 8;
    now = now + (folded >> 1 ^ -(folded & 1)) & 0xffff;
    steps[k] = now;
  }
  return steps;
}

/** x, y, z of every vertex in mm, one after another. */
export async function unpackPoints(axes, stepMm) {
  const [x, y, z] = await Promise.all(axes.map(unpackSteps));
  const points = new Float32Array(3 * x.length);
  for (let k = 0; k < x.length; ++k) {
    points[3 * k] = x[k] * stepMm;
    points[3 * k + 1] = y[k] * stepMm;
    points[3 * k + 2] = z[k] * stepMm;
  }
  return points;
}
