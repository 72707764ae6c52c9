// The session's owner: 1,000 ticks a second in batches that follow performance.now(), and its pictures, at most
// one a frame of the screen. The page says 60 times a second where its pointers are; without a message for 100 ms every
// probe leaves, without force.
import { Pliant } from './pliant.js';
import { Hands } from './hands.js';
import { kHeader, kEffector, kTraceRow, kTraceRows, traceAt } from './frame.js';

const kSilence = 100; // [ms]
const kHidden = 1000; // [ms]
const kBehind = 100; // [ms] that are caught up; more is left out, and the speed shown is below 1
const kRecorded = 600000; // [rows] that a recording keeps: ten minutes of one probe

let pliant, level; // the engine; what runs in it
let canvas = null; // the page's, as an OffscreenCanvas
let heard = 0; // [ms] when the page was last heard of

class Level {
  constructor(session) {
    this.session = session;
    this.hands = new Hands(session);
    this.show();
    this.trace = [];
    this.tickTime = 0;
    this.speed = 1;
    this.rows = null; // of a recording
    this.began = performance.now();
    this.dt = 0.001;
    this.done = session.time;
  }

  // Runs what is due.
  run(now) {
    const start = this.session.time;
    let due = Math.floor((now - this.began) / (1000 * this.dt));
    if (due * this.dt * 1000 > kBehind) {
      due = Math.floor(kBehind / (1000 * this.dt));
      this.began = now - kBehind;
    }
    let ran = 0;
    for (; ran < due && performance.now() - now < kBehind; ++ran) this.tick();
    if (!ran) return;
    this.dt = (this.session.time - start) / ran || this.dt;
    const spent = performance.now() - now;
    this.tickTime += 0.05 * ((1000 * spent) / ran - this.tickTime);
    const due2 = now - (this.last ?? now - 1);
    this.speed += 0.05 * (Math.min(1, (1000 * this.dt * ran) / due2) - this.speed);
    this.last = now;
    this.began += 1000 * this.dt * ran;
  }

  tick() {
    const { session } = this;
    this.hands.advance(this.dt);
    session.step(1);
    this.readings = session.effectors.map((name) => session.reading(name));
    this.readings.forEach((r, i) => {
      if (!r.touching) return;
      const fn = Math.abs(r.force[0] * r.normal[0] + r.force[1] * r.normal[1] + r.force[2] * r.normal[2]);
      if (this.trace.length < kTraceRows) this.trace.push([i, r.depth, fn]);
    });
    if (!this.rows || this.rows.length >= kRecorded) return;
    this.readings.forEach((r, i) => this.rows.push({ ...r, probe: session.effectors[i] }));
    if (this.rows.length >= kRecorded)
      postMessage({
        did: 'failed',
        during: 'record',
        sentence: `recording: ${kRecorded} rows are kept, the rest is left out; download them`,
        code: '',
      });
  }

  // Pictures of the session as it is now.
  show() {
    this.pictures = null;
    if (canvas) this.#try('pictures', () => (this.pictures = this.session.pictures(canvas)));
  }
  draw({ width, height, ...view }) {
    if (!this.pictures) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.#try('draw', () => this.pictures.draw(view));
  }
  #try(during, act) {
    try {
      act();
    } catch (error) {
      this.pictures = null;
      fail(error, during);
    }
  }
  restart() {
    this.hands.lose();
    this.pictures?.close();
    this.session.restart();
    this.show();
    this.began = performance.now();
  }
  close() {
    this.pictures?.close();
    this.session.close();
  }

  // The picture's numbers.
  numbers() {
    const { session, trace } = this,
      at = traceAt(session.effectors.length),
      out = new Float32Array(at + kTraceRow * kTraceRows);
    this.readings ??= session.effectors.map((name) => session.reading(name));
    out.set([
      session.time,
      this.tickTime,
      this.speed,
      trace.length,
      this.rows?.length ?? 0,
      this.hands.driving ? 1 : 0,
      pliant.library.bytes.length,
    ]);
    this.readings.forEach((r, i) => {
      const hover = this.hands.hovering(session.effectors[i]);
      const fn = r.force[0] * r.normal[0] + r.force[1] * r.normal[1] + r.force[2] * r.normal[2];
      out.set(
        [
          ...(hover ?? r.position),
          ...r.force,
          ...r.normal,
          r.depth,
          r.touching,
          r.object,
          r.ready,
          fn,
          hover || r.ready ? 1 : 0,
        ],
        kHeader + i * kEffector,
      );
    });
    trace.forEach((row, i) => out.set(row, at + i * kTraceRow));
    trace.length = 0;
    return out;
  }
}

// An object, for the page's sliders.
function describe(body) {
  const get = (act) => {
    try {
      return act();
    } catch {
      return null;
    }
  };
  const keys = Object.fromEntries(['stiffness', 'young'].map((key) => [key, get(() => body.get(key))]));
  return { name: body.name, surface: get(() => body.stream()) !== null, keys };
}

let loading = null;
async function start({ source, options, tag }) {
  level?.close();
  level = null;
  loading ??= Pliant.load({
    module: globalThis.pliantModule,
    log: (sentence) => postMessage({ did: 'note', sentence }),
  });
  pliant = await loading;
  const session = await pliant.session(source, options);
  const next = new Level(session);
  const [min, max] = session.bounds();
  postMessage({
    did: 'open',
    tag,
    effectors: session.effectors,
    tools: [...next.hands.tools],
    objects: session.objects.map((name) => describe(session.bodies[name])),
    notes: session.notes,
    bounds: [min, max],
    view: next.pictures?.view ?? null,
    version: pliant.version,
  });
  heard = performance.now();
  next.began = performance.now();
  level = next;
  for (const [number, driver] of plugged) connect(number, driver);
}

// The columns of a native forces.csv that a session knows: `pliant plot` reads it.
function csv(rows, objects) {
  const lines = ['tick,time_s,probe,x,y,z,in_contact,object,depth_m,nx,ny,nz,fx,fy,fz,fn,ft'];
  for (const r of rows) {
    const fn = r.force[0] * r.normal[0] + r.force[1] * r.normal[1] + r.force[2] * r.normal[2];
    const ft = Math.sqrt(Math.max(0, r.force[0] ** 2 + r.force[1] ** 2 + r.force[2] ** 2 - fn * fn));
    lines.push(
      [
        r.tick,
        r.time,
        r.probe,
        ...r.position,
        r.touching,
        objects[r.object] ?? '',
        r.depth,
        ...r.normal,
        ...r.force,
        fn,
        ft,
      ].join(),
    );
  }
  return lines.join('\n') + '\n';
}

const acts = {
  open: start,
  hands({ pointers }) {
    heard = performance.now();
    level?.hands.set(pointers);
  },
  canvas(data) {
    ({ canvas } = data);
  },
  // Draws, at the screen's pace, and answers with the numbers.
  frame({ view }) {
    const of = level;
    nextFrame(() => of && of === level && show(view));
  },
  // Whether a ray meets an object.
  meets({ id, from, along }) {
    postMessage({ did: 'meets', id, meets: Boolean(level?.session.ray(from, along)) });
  },
  set({ object, key, value }) {
    level?.session.set(object, key, value);
  },
  restart() {
    level?.restart();
  },
  record({ on }) {
    if (!level) return;
    if (!on && level.rows) postMessage({ did: 'recorded', text: csv(level.rows, level.session.objects) });
    level.rows = on ? [] : null;
  },
  // A HID device of the page: its reports go to the native driver, which moves the first free effector.
  plug({ number, driver, vendor, product, name, descriptor, features }) {
    const { library } = pliant,
      { module } = library;
    library.call('register_all_drivers');
    library.within(() =>
      library.lend(descriptor, (at) =>
        module._pliant_web_hid_add(number, vendor, product, library.put(name), at, descriptor.length),
      ),
    );
    for (const [report, bytes] of features)
      library.lend(bytes, (at) => module._pliant_web_hid_feature(number, report, at, bytes.length));
    plugged.set(number, driver);
    if (level) connect(number, driver);
  },
  report({ number, bytes }) {
    pliant.library.lend(bytes, (at) => pliant.library.module._pliant_web_hid_report(number, at, bytes.length));
  },
  unplug({ number }) {
    plugged.delete(number);
    pliant.library.module._pliant_web_hid_remove(number);
    level?.hands.give(number);
  },
};

function show(view) {
  try {
    level.draw(view);
    const frame = level.numbers();
    postMessage({ did: 'frame', frame }, [frame.buffer]);
    const events = level.session.events();
    if (events.length) postMessage({ did: 'events', events });
  } catch (error) {
    fail(error, 'frame');
    level = null;
  }
}

const nextFrame = globalThis.requestAnimationFrame?.bind(globalThis) ?? ((act) => act());
const plugged = new Map(); // drivers of HID devices by number

function connect(number, driver) {
  const effector = level.hands.lend(number);
  if (effector === null) return;
  level.session.release(effector);
  level.session.connect(effector, `${driver}:${number}`);
}

// The drivers' reports to their devices.
function sendReports() {
  const { library } = pliant;
  for (const number of plugged.keys())
    library.within(() => {
      const room = 128,
        at = library.room(room);
      for (let count; (count = library.module._pliant_web_hid_take(number, at, room)) > 0;)
        postMessage({ did: 'report', number, bytes: library.bytes.slice(at, at + count) });
    });
}

function fail(error, during) {
  postMessage({ did: 'failed', during, sentence: error.message, code: error.code ?? '' });
}

addEventListener('message', async ({ data }) => {
  try {
    await acts[data.do](data);
  } catch (error) {
    fail(error, data.do);
  }
});

function clock() {
  const now = performance.now();
  if (level)
    try {
      if (now - heard > kSilence) level.hands.lose();
      if (now - heard > kHidden)
        level.began = now; // a page that is not seen stands still
      else level.run(now);
      sendReports();
    } catch (error) {
      fail(error, 'tick');
      level = null;
    }
  setTimeout(clock, 2);
}
clock();
