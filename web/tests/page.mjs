#!/usr/bin/env node
// Tests of build/web/site in Debian's headless Chromium. Usage: node web/tests/page.mjs [NAME...]: tests whose name has one
// of these words. Pictures go into build/web/shots. playwright-core comes from build/web/node_modules (npm).
import { execFileSync, spawnSync } from 'node:child_process';
import { createServer } from 'node:http';
import {
  createReadStream,
  existsSync,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  readdirSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = dirname(dirname(dirname(fileURLToPath(import.meta.url)))),
  built = join(root, 'build/web'),
  site = join(built, 'site');
const native = join(root, 'build/release/bin/pliant'),
  shots = join(built, 'shots');
const { chromium } = playwright();
const kDrawn = ['three_probes', 'glass_heart', 'palpation', 'inclusion'],
  kDrawnAt = 600, // [ticks]
  kMeanApart = 0.5; // of 255
const kTypes = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.json': 'application/json',
  '.png': 'image/png',
};

function playwright() {
  try {
    return createRequire(join(built, 'x.js'))('playwright-core');
  } catch {
    console.error(
      'web/tests/page.mjs: playwright-core is missing; run ./dev test web, or npm install --prefix build/web playwright-core',
    );
    process.exit(1);
  }
}

function serve(headers) {
  const server = createServer((request, response) => {
    const path = join(site, decodeURIComponent(new URL(request.url, 'http://x').pathname)),
      file = path.endsWith('/') ? path + 'index.html' : path;
    if (!file.startsWith(site) || !existsSync(file) || statSync(file).isDirectory())
      return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': kTypes[extname(file)] ?? 'application/octet-stream', ...headers });
    createReadStream(file).pipe(response);
  });
  return new Promise((done) =>
    server.listen(0, '127.0.0.1', () =>
      done({ at: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() }),
    ),
  );
}

const expect = (holds, sentence) => {
  if (!holds) throw new Error(sentence);
};
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: [
    '--no-sandbox',
    '--use-gl=angle',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--ignore-gpu-blocklist',
    '--autoplay-policy=no-user-gesture-required',
  ],
});
const plain = await serve({});
const isolated = await serve({
  'cross-origin-opener-policy': 'same-origin',
  'cross-origin-embedder-policy': 'require-corp',
});
mkdirSync(shots, { recursive: true });

// A page and the errors that it logs.
async function opened(address, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120000); // pictures are slow without a GPU, on a machine that does other things
  page.faults = [];
  page.on('pageerror', (error) => page.faults.push(error.stack ?? error.message));
  page.on(
    'console',
    (message) => message.type() === 'error' && !/404|favicon/.test(message.text()) && page.faults.push(message.text()),
  );
  await page.goto(address);
  return page;
}
const ready = (page, level = /./) =>
  page.waitForFunction((name) => new RegExp(name).test(document.body.dataset.level ?? ''), level.source, {
    timeout: 60000,
  });
const force = (page) => page.locator('#force b').textContent().then(Number);
async function pressed(page, x = 0.42, y = 0.5) {
  const box = await page.locator('#picture').boundingBox();
  await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  await page.waitForTimeout(100);
  await page.mouse.down();
}
async function untilForce(page, seconds = 10) {
  await page.waitForFunction(() => Number(document.querySelector('#force b').textContent) > 0.2, null, {
    timeout: 1000 * seconds,
  });
  return force(page);
}
// Ends a recording; its rows, and the file.
async function recorded(page) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#record').click()]);
  const file = join(mkdtempSync(join(tmpdir(), 'pliant-')), 'forces.csv');
  await download.saveAs(file);
  return Object.assign(
    readFileSync(file, 'utf8')
      .trim()
      .split('\n')
      .map((line) => line.split(',')),
    { file },
  );
}
async function closed(page) {
  const { faults } = page;
  await page.context().close();
  expect(!faults.length, `the page logged: ${faults.join('; ')}`);
}

const tests = {
  async 'page one opens, is touched, and lets go'() {
    const page = await opened(plain.at);
    const began = Date.now();
    await ready(page);
    const open = Date.now() - began;
    await pressed(page);
    const felt = await untilForce(page);
    const touched = Date.now() - began;
    await page.waitForTimeout(1200);
    await page.screenshot({ path: join(shots, 'desktop.png') });
    await page.mouse.up();
    await page.waitForFunction(() => Number(document.querySelector('#force b').textContent) < 0.02, null, { timeout: 5000 });
    console.log(`    open after ${open} ms, touched after ${touched} ms, ${felt.toFixed(2)} N`);
    await closed(page);
  },

  async 'two fingers are two probes, on a phone'() {
    const page = await opened(plain.at, {
      viewport: { width: 390, height: 844 },
      deviceScaleFactor: 2,
      hasTouch: true,
      isMobile: true,
      colorScheme: 'dark',
    });
    await ready(page);
    await page.waitForTimeout(500);
    const box = await page.locator('#picture').boundingBox(),
      cdp = await page.context().newCDPSession(page);
    const touchPoints = [
      [0.36, 0.45],
      [0.6, 0.5],
    ].map(([x, y], id) => ({ id, x: box.x + x * box.width, y: box.y + y * box.height }));
    await cdp.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints });
    await untilForce(page);
    await page.waitForFunction(
      () => globalThis.pliantPage.readings().filter((each) => each.touching).length === 2,
      null,
      { timeout: 10000 },
    );
    await page.waitForTimeout(1000);
    await page.screenshot({ path: join(shots, 'phone.png') });
    await closed(page);
  },

  async 'the whole page, light and dark'() {
    for (const colorScheme of ['light', 'dark']) {
      const page = await opened(plain.at, { colorScheme });
      await ready(page);
      await pressed(page, 0.38, 0.45);
      await page.waitForTimeout(1500);
      await page.screenshot({ path: join(shots, `top_${colorScheme}.png`) });
      await page.mouse.up();
      for (const image of await page.locator('img').all()) await image.evaluate((each) => (each.loading = 'eager'));
      await page.waitForTimeout(600);
      await page.screenshot({ path: join(shots, `all_${colorScheme}.png`), fullPage: true });
      await closed(page);
    }
  },

  async 'the worker lets go when it hears nothing for 100 ms'() {
    const page = await opened(plain.at);
    await ready(page);
    await page.locator('#record').click();
    await pressed(page);
    await untilForce(page);
    await page.waitForTimeout(600);
    await page.evaluate(() => {
      const until = performance.now() + 500;
      while (performance.now() < until); // the page hangs
    });
    await untilForce(page); // the finger is still there, so it presses again
    await page.mouse.up();
    const rows = await recorded(page),
      forces = rows.filter((row) => row[2] === rows[1][2]).map((row) => Math.hypot(row[12], row[13], row[14]));
    const felt = forces.slice(forces.findIndex((each) => each > 0.2)),
      from = felt.indexOf(0);
    const quiet = felt.slice(from).findIndex((each) => each > 0);
    expect(from > 0 && quiet > 50, `in a hang of 500 ms the force was zero for ${quiet} ms`);
    await closed(page);
  },

  async 'pictures are those of the native library'() {
    const page = await opened(plain.at + 'tests.html');
    for (const level of kDrawn) {
      const picture = join(site, `${level}.rgba`),
        words = [join(root, `content/levels/${level}.glb`), String(kDrawnAt), join(built, 'native.bin'), picture];
      execFileSync(join(built, 'native_forces'), words);
      const found = await page.evaluate((all) => globalThis.drawn(...all), [level, kDrawnAt, `${level}.rgba`]);
      rmSync(picture);
      writeFileSync(join(shots, `${level}.png`), Buffer.from(found.png, 'base64'));
      console.log(`    ${level}: ${found.mean.toFixed(2)} of 255 in the mean, ${found.most} at most`);
      expect(found.mean <= kMeanApart && found.error === 0, `${level}: ${found.mean} apart, error ${found.error}`);
    }
    await closed(page);
  },

  async 'an isolated page runs, and begins again'() {
    const page = await opened(isolated.at);
    await ready(page);
    expect(await page.evaluate(() => crossOriginIsolated), 'the page is not isolated');
    await pressed(page);
    await untilForce(page);
    await page.mouse.up();
    await page.locator('#restart').click(); // with pictures of its own
    await pressed(page);
    await untilForce(page);
    const failed = await page.evaluate(() => document.body.dataset.failed);
    expect(!failed, `after a restart the page says "${failed}"`);
    await closed(page);
  },

  async 'settings are in the link, and act'() {
    const soft = await opened(`${plain.at}?level=minimal#stiffness=100`);
    await ready(soft, /minimal/);
    expect(/100 N\/m/.test(await soft.locator('#sliders').textContent()), 'the slider does not show 100 N/m');
    await soft.locator('select[name=spring]').selectOption('cubic');
    await soft.locator('#share').click();
    expect(/level=minimal.*stiffness=100.*spring=cubic/.test(soft.url()), `the link is ${soft.url()}`);
    await closed(soft);
  },

  async 'an address that cannot be opened is said, and settings that do not act'() {
    for (const [level, sentence] of [
      ['http://127.0.0.1:1/x.glb', /127.0.0.1:1\/x.glb.*CORS/],
      ['http://', /not an address/],
      ['missing.glb', /answers 404/],
    ]) {
      const page = await opened(`${plain.at}?level=${encodeURIComponent(level)}`);
      await page.waitForFunction(() => document.body.dataset.failed, null, { timeout: 20000 });
      const failed = await page.evaluate(() => document.body.dataset.failed);
      expect(sentence.test(failed), `${level}: the page says "${failed}"`);
      await page.context().close();
    }
    const page = await opened(`${plain.at}?level=minimal#stiffness=soft&sprong=cubic`);
    await ready(page, /minimal/);
    const said = await page.locator('#sentence').textContent();
    expect(/stiffness, sprong/.test(said), `the page says "${said}"`);
    await closed(page);
  },

  async 'a recording is a forces.csv'() {
    const page = await opened(plain.at);
    await ready(page);
    await page.locator('#record').click();
    await pressed(page);
    await untilForce(page);
    await page.mouse.up();
    const rows = await recorded(page);
    expect(
      rows[0].join().startsWith('tick,time_s,probe,x,y,z,in_contact,object,depth_m') && rows.length > 300,
      `${rows.length} rows: ${rows[0]}`,
    );
    if (existsSync(native))
      execFileSync(native, ['plot', rows.file, '--out', join(dirname(rows.file), 'plot')], { stdio: 'ignore' });
    await closed(page);
  },

  async 'broken and hostile files give the sentences of the native command'() {
    if (!existsSync(native)) return console.log('    skipped: build/release/bin/pliant is not built');
    const good = readFileSync(join(root, 'content/levels/minimal.gltf'), 'utf8'),
      json = JSON.parse(good);
    const hostile = structuredClone(json);
    hostile.accessors[0].count = 4e9;
    const unknown = structuredClone(json);
    unknown.nodes[0].extensions.PLIANT_deformable.stifness = 3;
    const glb = readFileSync(join(root, 'content/levels/stack.glb'));
    const files = {
      'broken.gltf': Buffer.from(good.slice(0, 300)),
      'hostile.gltf': Buffer.from(JSON.stringify(hostile)),
      'unknown.gltf': Buffer.from(JSON.stringify(unknown)),
      'short.glb': glb.subarray(0, 5000),
      'empty.glb': Buffer.alloc(0),
      'nothing.stl': Buffer.from('solid x\nendsolid x\n'),
    };
    const folder = mkdtempSync(join(tmpdir(), 'pliant-'));
    for (const name of ['minimal.bin', 'minimal.csv'])
      writeFileSync(join(folder, name), readFileSync(join(root, 'content/levels', name)));
    const page = await opened(plain.at);
    await ready(page);
    for (const [name, bytes] of Object.entries(files)) {
      writeFileSync(join(folder, name), bytes);
      const run = spawnSync(native, ['run', name, '--headless', '--frames', '0', '--seconds', '0.01', '--out', 'out'], {
        cwd: folder,
        encoding: 'utf8',
      });
      const expected = run.stderr
        .trim()
        .split('\n')
        .find((line) => line.startsWith('pliant: error: '))
        ?.slice('pliant: error: '.length);
      await page.evaluate(() => delete document.body.dataset.failed);
      await page.locator('#file').setInputFiles([name, 'minimal.bin', 'minimal.csv'].map((each) => join(folder, each)));
      await page.waitForFunction(() => document.body.dataset.failed !== undefined, null, { timeout: 20000 });
      const sentence = await page.evaluate(() => document.body.dataset.failed);
      // The command adds what else it can do about a level.
      expect(
        sentence.length > 20 && expected?.startsWith(sentence),
        `${name}: the page says "${sentence}", the command "${expected}" (${run.stderr})`,
      );
    }
    await page.locator('#level').selectOption('minimal'); // and the page goes on
    await ready(page, /minimal/);
    await closed(page);
  },

  async 'a state is restored to the bit'() {
    const page = await opened(plain.at + 'tests.html');
    expect(await page.evaluate(() => globalThis.restored()), 'the same path after restore() gives other forces');
    const wrong = await page.evaluate(() => globalThis.wrong());
    expect(
      /valid/.test(wrong.code + wrong.message) || wrong.name === 'PliantError',
      `a wrong name gives ${JSON.stringify(wrong)}`,
    );
    await closed(page);
  },

  async 'the single file opens from disk'() {
    const page = await opened(`file://${join(site, 'pliant.html')}`);
    await ready(page);
    await pressed(page);
    console.log(`    ${(await untilForce(page)).toFixed(2)} N`);
    await page.screenshot({ path: join(shots, 'single.png') });
    await closed(page);
  },

  async 'an emulated SpaceMouse moves a probe by the native driver'() {
    const page = await opened('about:blank');
    await page.addInitScript(() => {
      const device = Object.assign(new EventTarget(), {
        vendorId: 0x256f,
        productId: 0xc635,
        productName: 'SpaceMouse Compact',
        opened: false,
        open: async () => {},
      });
      const axes = (reportId, first) => ({
        reportId,
        items: [
          {
            usages: [0, 1, 2].map((i) => 0x10030 + first + i),
            logicalMinimum: -350,
            logicalMaximum: 350,
            reportSize: 16,
            reportCount: 3,
            isAbsolute: true,
          },
        ],
      });
      const buttons = {
        reportId: 3,
        items: [
          {
            isRange: true,
            usageMinimum: 0x90001,
            usageMaximum: 0x90010,
            logicalMinimum: 0,
            logicalMaximum: 1,
            reportSize: 1,
            reportCount: 16,
            isAbsolute: true,
          },
        ],
      };
      device.collections = [
        {
          usagePage: 1,
          usage: 8,
          inputReports: [axes(1, 0), axes(2, 3), buttons],
          outputReports: [],
          featureReports: [],
        },
      ];
      Object.defineProperty(navigator, 'hid', {
        value: Object.assign(new EventTarget(), { requestDevice: async () => [device] }),
      });
      globalThis.push = (x) => {
        // to the right
        const data = new DataView(new ArrayBuffer(6));
        data.setInt16(0, x, true);
        device.dispatchEvent(Object.assign(new Event('inputreport'), { reportId: 1, data }));
      };
    });
    await page.goto(plain.at + '?level=minimal');
    await ready(page, /minimal/);
    await page.locator('#device').click();
    await page.waitForTimeout(1500);
    const x = () => page.evaluate(() => globalThis.pliantPage.readings()[0].position[0]);
    const before = await x();
    await page.waitForTimeout(500);
    const failed = await page.evaluate(() => document.body.dataset.failed);
    expect(!failed, `the driver says "${failed}"`);
    expect(before === (await x()), 'the probe moves before the cap does');
    await page.evaluate(
      () =>
        new Promise((done) => {
          let sent = 0;
          const timer = setInterval(() => (globalThis.push(350), ++sent > 60 && (clearInterval(timer), done())), 10);
        }),
    );
    await page.waitForTimeout(500);
    const after = await x();
    expect(after > before + 0.01, `the probe went from ${before} to ${after} m`);
    await closed(page);
  },

  async 'memory stays flat'() {
    const page = await opened(plain.at),
      cdp = await page.context().newCDPSession(page);
    await ready(page);
    const used = async () => {
      await cdp.send('HeapProfiler.collectGarbage');
      const { usedSize } = await cdp.send('Runtime.getHeapUsage');
      return [usedSize, await page.evaluate(() => globalThis.pliantPage.memory())];
    };
    const move = async (seconds) => {
      const box = await page.locator('#picture').boundingBox(),
        until = Date.now() + 1000 * seconds;
      for (let i = 0; Date.now() < until; ++i) {
        await page.mouse.move(
          box.x + box.width * (0.4 + 0.05 * Math.sin(i / 7)),
          box.y + box.height * (0.48 + 0.05 * Math.cos(i / 5)),
        );
        if (i % 20 === 0) await page.mouse.down();
        if (i % 20 === 15) await page.mouse.up();
        await page.waitForTimeout(16);
      }
    };
    await move(25);  // until a state can no longer be saved, which needs the poses since time 0
    const [heap, wasm] = await used();
    await move(Number(process.env.PLIANT_WEB_SECONDS ?? 10));
    const [heapAfter, wasmAfter] = await used();
    console.log(
      `    JavaScript ${(heap / 1e6).toFixed(2)} → ${(heapAfter / 1e6).toFixed(2)} MB, module ${(wasm / 1e6).toFixed(0)} → ${(wasmAfter / 1e6).toFixed(0)} MB`,
    );
    expect(heapAfter < heap + 1e6 && wasmAfter === wasm && wasm < 150e6, 'memory grows');
    await closed(page);
  },
};

writeFileSync(join(site, 'tests.html'), readFileSync(join(root, 'web/tests/tests.html')));
let failed = 0;
const words = process.argv.slice(2);
for (const [name, act] of Object.entries(tests)) {
  if (words.length && !words.some((each) => name.includes(each))) continue;
  const began = Date.now();
  try {
    await act();
    console.log(`ok   ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed = 1;
    console.log(`FAIL ${name}: ${error.message}`);
    for (const context of browser.contexts()) await context.close();
  }
}
rmSync(join(site, 'tests.html'));
await browser.close();
plain.close();
isolated.close();
process.exit(failed);
