// Draws each scene with Pliant and with three.js, and writes pictures and figures of the difference. See docs/reference.md.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { chromium } from 'playwright-core';
import { writeBalls, writeLevel } from './scenes.js';

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, '../..'), out = join(here, 'out');
const { values: options } = parseArgs({ options: {
  pliant: { type: 'string', default: join(root, 'build/release/bin/pliant') },
  level: { type: 'string', default: join(root, 'content/levels/three_probes.glb') },
  environment: { type: 'string', default: join(root, 'content/environments/sky.exr') },
  browser: { type: 'string', default: '/usr/bin/chromium' },
  images: { type: 'string', default: join(root, 'docs/images') },
  'no-shadows': { type: 'boolean', default: false },
} });
const kWidth = 640, kHeight = 360;
const kParts = ['all', 'key', 'surroundings'];  // which light: both, the level's lights, the panorama

// Files of this folder, and of the package three under /three/, to the browser alone.
function serve() {
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png' };
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://127.0.0.1').pathname));
    const file = path.startsWith('/three/') ? join(here, 'node_modules', path) : join(here, path);
    if (!existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream' });
    response.end(readFileSync(file));
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

// Pliant's picture of a level at rest.
function drawWithPliant(level) {
  const folder = join(out, `pliant-${basename(level, extname(level))}`);
  execFileSync(options.pliant, ['run', level, '--seconds', '0.01', '--frames', '1', '--size', `${kWidth}x${kHeight}`,
    '--out', folder], { stdio: 'pipe' });
  return join(folder, 'frame-0000.png');
}

// One scene under one light: rows of figures; the sheet is written to `images` when both lights are on.
async function compare(page, name, level, part) {
  const picture = drawWithPliant(join(out, level));
  const address = (path) => `/${path.slice(here.length + 1)}`;
  const { rows, sheet, alone, exposure } = await page.evaluate(async ([level, picture, width, height, shadows]) => {
    const reference = await window.pliant.draw(level, width, height, shadows);
    return { rows: await window.pliant.measure(picture, reference), exposure: reference.exposure,
      sheet: await window.pliant.sideBySide(picture, reference), alone: reference.canvas.toDataURL('image/png') };
  }, [`/out/${level}`, address(picture), kWidth, kHeight, !options['no-shadows']]);
  const save = (path, url) => writeFileSync(path, Buffer.from(url.split(',')[1], 'base64'));
  save(join(out, `sheet_${name}_${part}.png`), sheet);
  save(join(out, `three_${name}_${part}.png`), alone);
  if (part === 'all') save(join(options.images, `reference_${name}.png`), sheet);
  return rows.map((row) => ({ scene: name, part, exposure, ...row }));
}

function table(rows) {
  const f = (x, digits = 1) => x.toFixed(digits), rgb = (v) => v.map((x) => f(x)).join(' / ');
  return ['| body | light | pixels | whole, R / G / B | inside, R / G / B | signed, R / G / B | 95 % | emitted |',
    '|---|---|---|---|---|---|---|---|',
    ...rows.map(({ name, part, whole, inside }) => `| ${name} | ${part} | ${whole.pixels} | ${rgb(whole.absolute)} | ` +
      `${rgb(inside.absolute)} | ${rgb(inside.signed)} | ${f(inside.p95)} | ${f(inside.emitted, 3)} |`)].join('\n');
}

if (!existsSync(options.pliant))
  throw new Error(`${options.pliant}: not there; build it with ./dev run, or give --pliant`);
mkdirSync(out, { recursive: true });
mkdirSync(options.images, { recursive: true });
const panorama = basename(options.environment);
copyFileSync(options.environment, join(out, panorama));

const server = await serve(), profile = mkdtempSync(join(tmpdir(), 'pliant-reference-'));
const browser = await chromium.launchPersistentContext(profile, { executablePath: options.browser, args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-first-run',
  '--disable-quic', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--force-color-profile=srgb'] });
try {
  const page = await browser.newPage();
  page.on('pageerror', (error) => console.error(error.message));
  page.on('console', (message) => { if (message.type() === 'error') console.error(message.text()); });
  await page.goto(`http://127.0.0.1:${server.address().port}/page.html`);
  await page.waitForFunction(() => window.pliant);
  const rows = [];
  for (const part of kParts) {
    writeLevel(options.level, part, panorama, join(out, `organ-${part}.glb`));
    writeBalls(part, panorama, join(out, `balls-${part}.gltf`));
    rows.push(...await compare(page, 'organ', `organ-${part}.glb`, part));
    rows.push(...await compare(page, 'balls', `balls-${part}.gltf`, part));
  }
  rows.sort((a, b) => b.scene.localeCompare(a.scene) || kParts.indexOf(a.part) - kParts.indexOf(b.part));
  writeFileSync(join(out, 'figures.json'), JSON.stringify(rows, null, 1));
  console.log(table(rows));
} finally {
  await browser.close();
  server.close();
  rmSync(profile, { recursive: true, force: true });
}
