// How alike two pictures of a face are, whatever their size and background: the share of cells that both cover, and the
// correlation of the cells' lightness.

const cells = 32;

/** In the page, which can decode PNG: of each cell of the face's box, how much of it the face covers and how light it is. */
const look = `async (url, cells) => {
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const {data, width, height} = context.getImageData(0, 0, image.width, image.height);
  const ground = [0, 1, 2].map(c => data[4 * (width * (height - 12) + 12) + c]);
  const isFace = at => [0, 1, 2].some(c => Math.abs(data[at + c] - ground[c]) > 14);
  let left = width, right = 0, top = height, bottom = 0;
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) if (isFace(4 * (y * width + x))) {
    left = Math.min(left, x); right = Math.max(right, x); top = Math.min(top, y); bottom = Math.max(bottom, y); }
  const covered = Array(cells * cells).fill(0), light = Array(cells * cells).fill(0), count = Array(cells * cells).fill(0);
  for (let y = top; y <= bottom; ++y) for (let x = left; x <= right; ++x) {
    const cell = Math.floor(cells * (y - top) / (bottom - top + 1)) * cells + Math.floor(cells * (x - left) / (right - left + 1));
    const at = 4 * (y * width + x);
    ++count[cell];
    if (!isFace(at)) continue;
    ++covered[cell];
    light[cell] += 0.3 * data[at] + 0.6 * data[at + 1] + 0.1 * data[at + 2];
  }
  return {covered: covered.map((c, k) => c / Math.max(1, count[k])), light: light.map((l, k) => l / Math.max(1, covered[k])),
    shape: (right - left) / (bottom - top)};
}`;

export async function likeness(page, one, other) {
  const looks = [];
  for (const png of [one, other])
    looks.push(await page.value(`(${look})(${JSON.stringify(`data:image/png;base64,${png.toString('base64')}`)}, ${cells})`));
  const [a, b] = looks;
  let both = 0, either = 0;
  const pairs = [];
  for (let k = 0; k < cells * cells; ++k) {
    const inA = a.covered[k] > 0.5, inB = b.covered[k] > 0.5;
    if (inA || inB) ++either;
    if (inA && inB) { ++both; pairs.push([a.light[k], b.light[k]]); }
  }
  const mean = axis => pairs.reduce((sum, pair) => sum + pair[axis], 0) / pairs.length;
  const [ma, mb] = [mean(0), mean(1)];
  const sum = term => pairs.reduce((total, [x, y]) => total + term(x - ma, y - mb), 0);
  return {overlap: both / either, shape: a.shape / b.shape, light: sum((x, y) => x * y) / Math.sqrt(sum(x => x * x) * sum((x, y) => y * y))};
}
