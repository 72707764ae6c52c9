// Differences between two pictures over the pixels of each body, and the two side by side.

const kRim = 2;  // [pixels] from a body's outline: there the edges' filters are compared, not its light

const kWidest = 1000;  // [pixels] of a sheet

const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

async function loaded(address) {
  const image = new Image();
  image.src = address;
  await image.decode();
  const canvas = Object.assign(document.createElement('canvas'), { width: image.width, height: image.height });
  canvas.getContext('2d').drawImage(image, 0, 0);
  return canvas;
}

const pixels = (canvas) => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;

// True where every pixel within kRim is of the same body.
function isInside(mask, width, height, x, y) {
  for (let j = -kRim; j <= kRim; ++j)
    for (let i = -kRim; i <= kRim; ++i) {
      const u = x + i, v = y + j;
      if (u < 0 || v < 0 || u >= width || v >= height || mask[v * width + u] !== mask[y * width + x]) return false;
    }
  return true;
}

// Over the pixels that `keep` chooses, in 8-bit sRGB steps: mean absolute and signed difference (ours less the
// reference) per channel, the 95th percentile of the pixels' mean absolute difference, and the ratio of what the two
// screens emit.
function differences(ours, theirs, keep) {
  const absolute = [0, 0, 0], signed = [0, 0, 0], emitted = [0, 0], each = [];
  keep.forEach((p) => {
    let sum = 0;
    for (let c = 0; c < 3; ++c) {
      const d = ours[4 * p + c] - theirs[4 * p + c];
      absolute[c] += Math.abs(d);
      signed[c] += d;
      sum += Math.abs(d) / 3;
      emitted[0] += linear(ours[4 * p + c] / 255);
      emitted[1] += linear(theirs[4 * p + c] / 255);
    }
    each.push(sum);
  });
  each.sort((a, b) => a - b);
  const mean = (x) => x / keep.length;
  return { pixels: keep.length, absolute: absolute.map(mean), signed: signed.map(mean),
    p95: each[Math.floor(0.95 * (each.length - 1))], emitted: emitted[0] / emitted[1] };
}

// One row for each body: {name, whole, inside} of differences.
export async function measure(picture, { canvas, mask, names }) {
  const { width, height } = canvas, ours = pixels(await loaded(picture)), theirs = pixels(canvas);
  return names.map((name, i) => {
    const whole = [], inside = [];
    for (let p = 0; p < mask.length; ++p) {
      if (mask[p] !== i + 1) continue;
      whole.push(p);
      if (isInside(mask, width, height, p % width, Math.floor(p / width))) inside.push(p);
    }
    return { name, whole: differences(ours, theirs, whole), inside: differences(ours, theirs, inside) };
  });
}

// Pliant, the reference, four times the difference: cut to the bodies' box, beneath each other where that is wide,
// else in a row. A PNG as a data address.
export async function sideBySide(picture, { canvas, mask }) {
  const { width, height } = canvas, ours = await loaded(picture);
  let x0 = width, x1 = 0, y0 = height, y1 = 0;
  mask.forEach((body, p) => {
    if (!body) return;
    x0 = Math.min(x0, p % width); x1 = Math.max(x1, p % width);
    y0 = Math.min(y0, Math.floor(p / width)); y1 = Math.max(y1, Math.floor(p / width));
  });
  const margin = 12, title = 20, gap = 4;  // [pixels]
  x0 = Math.max(0, x0 - margin); x1 = Math.min(width, x1 + margin);
  y0 = Math.max(0, y0 - margin); y1 = Math.min(height, y1 + margin);
  const w = x1 - x0, h = y1 - y0, wide = w > 2 * h;

  const change = document.createElement('canvas').getContext('2d');
  Object.assign(change.canvas, { width, height });
  const a = pixels(ours), b = pixels(canvas), shown = change.createImageData(width, height);
  for (let i = 0; i < a.length; ++i)
    shown.data[i] = i % 4 === 3 ? 255 : mask[i >> 2] ? 4 * Math.abs(a[i] - b[i]) : 0;
  change.putImageData(shown, 0, 0);

  const panels = wide ? [1, 3] : [3, 1], full = [panels[0] * (w + gap) - gap, panels[1] * (h + title)];
  const scale = Math.min(1, kWidest / full[0]);
  const sheet = document.createElement('canvas').getContext('2d');
  Object.assign(sheet.canvas, { width: Math.round(scale * full[0]), height: Math.round(scale * full[1]) });
  sheet.scale(scale, scale);
  sheet.imageSmoothingQuality = 'high';
  sheet.fillStyle = '#fff';
  sheet.fillRect(0, 0, ...full);
  sheet.fillStyle = '#222';
  sheet.font = '14px sans-serif';
  [['Pliant', ours], ['three.js', canvas], ['difference × 4', change.canvas]].forEach(([name, panel], i) => {
    const x = wide ? 0 : i * (w + gap), y = wide ? i * (h + title) : 0;
    sheet.fillText(name, x + 2, y + 15);
    sheet.drawImage(panel, x0, y0, w, h, x, y + title, w, h);
  });
  return sheet.canvas.toDataURL('image/png');
}
