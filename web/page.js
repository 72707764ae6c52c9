// The page: opens levels, passes pointers to the worker, draws what comes back, and lets one feel it.
import { open } from './files.js';
import { kHeader, kEffector, kTraceRow, traceAt } from './frame.js';
import { available, connect } from './hid.js';
import { describe } from './level.js';
import { Plot, Tone, gamepads, vibrate } from './senses.js';
import { View } from './view.js';

const $ = (id) => document.getElementById(id);
const kPalette = [
  [0.95, 0.32, 0.14],
  [0.05, 0.55, 0.6],
  [0.95, 0.7, 0.1],
  [0.45, 0.4, 0.9],
  [0.3, 0.7, 0.3],
];
const kLaws = ['linear', 'cubic', 'exponential'];
const kShapes = ['volume', 'punch', 'hertz', 'gaussian', 'wendland', 'kelvinlet'];
const kHalfForce = 1; // [N] at which the drawn cursor moves half as far as the pointer (HeavyCursor)
const kFirstSteps = 4,
  kMostSteps = 12; // of depth

const canvas = $('picture');
const view = new View(canvas);
const tone = new Tone();
const css = (color) => `rgb(${color.map((each) => Math.round(255 * each ** (1 / 2.2))).join()})`;
const plot = new Plot($('plot'), (effector) => css(colorOf(effector)));
const narrow = matchMedia('(max-width: 52rem)');

let level = null; // what runs: {name, words, probes, about, effectors, objects, values, asked}
let steps = kFirstSteps;
const pointers = new Map(); // of the mouse and fingers, in pixels: {id, x, y, tx, ty, down, turns}
const settings = Object.fromEntries(
  new URLSearchParams(location.hash.slice(1).includes('=') ? location.hash.slice(1) : ''),
);

function colorOf(effector) {
  return level?.probes.get(level.effectors[effector]) ?? kPalette[effector % kPalette.length];
}

// ---- Sentences

let hides = 0;
function say(sentence, seconds = 8) {
  $('sentence').textContent = sentence;
  $('sentence').hidden = false;
  clearTimeout(hides);
  hides = setTimeout(() => ($('sentence').hidden = true), 1000 * seconds);
}

// ---- The worker

const worker = globalThis.pliantWorker?.() ?? new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
worker.onerror = (event) =>
  say(
    `The worker does not start: ${event.message || 'this browser lacks module workers or WebAssembly exceptions'}; take a newer one.`,
    60,
  );
const told = {
  open: opened,
  frame({ frame }) {
    if (!level) return;
    level.values = frame;
    view.pace(Math.min(0.1, (performance.now() - level.asked) / 1000)); // it may have been hidden
    level.asked = 0;
    const at = traceAt(level.effectors.length);
    for (let i = 0; i < frame[3]; ++i) plot.add(...frame.subarray(at + i * kTraceRow, at + (i + 1) * kTraceRow));
  },
  meets({ id, meets }) {
    const pointer = pointers.get(id);
    if (!pointer?.asks) return;
    Object.assign(pointer, { asks: false, down: meets, turns: !meets });
    canvas.classList.toggle('turns', !meets);
  },
  events: ({ events }) => say(events.at(-1).sentence, 4),
  note: ({ sentence }) => console.info(sentence),
  failed({ sentence }) {
    document.body.dataset.failed = sentence;
    say(sentence, 20);
    if (!level) $('about').textContent = sentence;
  },
  report({ number, bytes }) {
    hid[number]?.sendReport(bytes[0], bytes.subarray(1)).catch(() => {});
  },
  recorded({ text }) {
    const link = Object.assign(document.createElement('a'), {
      href: URL.createObjectURL(new Blob([text], { type: 'text/csv' })),
      download: 'forces.csv',
    });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  },
};
worker.onmessage = ({ data }) => told[data.did]?.(data);
const ask = (act, more = {}, transfer = []) => worker.postMessage({ do: act, ...more }, transfer);
if (canvas.transferControlToOffscreen) {
  const offscreen = canvas.transferControlToOffscreen();
  ask('canvas', { canvas: offscreen }, [offscreen]);
} else say('This browser draws no pictures in a worker (OffscreenCanvas); take a newer one.', 60);

// ---- Levels

let pending = null,
  opens = 0;
async function show(source, options = {}) {
  const tag = ++opens;
  try {
    const { name, bytes, files } = await open(source, options);
    const next = { tag, name, ...describe(bytes), given: options.given };
    if (tag !== opens) return; // another one was chosen
    pending = next;
    delete document.body.dataset.failed;
    ask('open', { tag, source: bytes, options: { name, files, probes: 5 } });
  } catch (error) {
    told.failed({ sentence: error.message });
  }
}
function showNamed(name) {
  const inlined = globalThis.pliantLevels?.[name];
  return inlined
    ? show(inlined.bytes(), { name: inlined.name, files: inlined.files(), given: name })
    : show(new URL(`levels/${levels.find((each) => each.name === name)?.file ?? name}`, import.meta.url), {
        given: name,
      });
}

function opened({ tag, effectors, objects, bounds, view: camera, notes, version }) {
  if (tag !== pending.tag) return;
  level = { ...pending, effectors, objects, values: null, asked: 0 };
  view.open(bounds, camera);
  pointers.clear();
  plot.clear();
  steps = kFirstSteps;
  if (level.given !== levels[0].name) $('about').textContent = level.about || `${level.name}: press it.`;
  $('version').textContent = `Pliant ${version}`;
  if (level.given) $('level').value = level.given;
  else $('level').selectedIndex = -1;
  for (const sentence of notes) console.info(sentence);
  const used = sliders(),
    unused = Object.keys(settings).filter((key) => !used.has(key));
  if (unused.length) say(`${level.name} does not take these settings: ${unused.join(', ')}.`);
  document.body.dataset.level = level.name;
}

// ---- Settings

const rounded = (value) => +value.toPrecision(3);
function sliders() {
  const rows = [],
    used = new Set(); // settings that act here
  const surfaces = level.objects.filter((each) => each.surface),
    bodies = level.objects.filter((each) => each.keys.young > 0 && !each.surface);
  const slide = (key, label, unit, objects, factor = 1) => {
    const start = objects[0].keys[key],
      row = document.createElement('label'),
      input = document.createElement('input'),
      out = document.createElement('output');
    Object.assign(input, { type: 'range', min: -100, max: 100, step: 1, value: 0, name: key });
    const apply = (value) => {
      out.textContent = `${rounded(value * factor)} ${unit}`;
      if (value === start) return;
      for (const each of objects)
        ask('set', { object: each.name, key, value: ((each.keys[key] ?? start) * value) / start });
      settings[key] = rounded(value);
    };
    input.oninput = () => apply(start * 10 ** (input.value / 100));
    row.append(label, out, input);
    rows.push(row);
    const value = +settings[key] > 0 ? +settings[key] : start;
    if (value !== start || +settings[key] === start) used.add(key);
    input.value = Math.round(100 * Math.log10(value / start));
    apply(value);
  };
  const choose = (key, label, words, first) => {
    const row = document.createElement('label'),
      select = document.createElement('select');
    select.name = key;
    for (const word of new Set([first, ...words])) select.append(new Option(word, word));
    const apply = () => {
      for (const each of surfaces) ask('set', { object: each.name, key, value: select.value });
      settings[key] = select.value;
      plot.clear();
    };
    select.onchange = apply;
    row.append(label, select);
    rows.push(row);
    if (words.includes(settings[key])) (used.add(key), (select.value = settings[key]), apply());
  };
  if (surfaces[0]?.keys.stiffness) slide('stiffness', 'Stiffness', 'N/m', surfaces);
  if (bodies.length) slide('young', "Young's modulus", 'kPa', bodies, 1e-3);
  if (surfaces.length) {
    const words = level.words(surfaces[0].name);
    choose('spring', 'Law', kLaws, words.spring);
    choose('shape', 'Shape', kShapes, words.shape);
  }
  $('sliders').replaceChildren(...rows);
  return used;
}

function link() {
  const at = new URL(location.href);
  if (level?.given) at.searchParams.set('level', level.given);
  else at.searchParams.delete('level');
  at.hash = new URLSearchParams(settings).toString();
  return at.href;
}

// ---- Pointers: on an object they press, beside it they turn the view

const place = (event) => {
  const box = canvas.getBoundingClientRect();
  return { tx: event.clientX - box.left, ty: event.clientY - box.top };
};
const idOf = (event) => (event.pointerType === 'mouse' ? 'mouse' : `touch${event.pointerId}`);

canvas.addEventListener('pointerdown', (event) => {
  const at = place(event),
    id = idOf(event);
  tone.wake();
  canvas.setPointerCapture(event.pointerId);
  const asks = event.button === 0; // whether it presses
  pointers.set(id, { id, ...at, x: at.tx, y: at.ty, down: false, turns: !asks, asks });
  canvas.classList.toggle('turns', !asks);
  if (asks) ask('meets', { id, ...view.ray(at.tx, at.ty) });
  event.preventDefault();
});
canvas.addEventListener('pointermove', (event) => {
  const at = place(event),
    id = idOf(event),
    pointer = pointers.get(id);
  if (!pointer) {
    if (id === 'mouse') pointers.set(id, { id, ...at, x: at.tx, y: at.ty, down: false, turns: false });
    return;
  }
  const [dx, dy] = [at.tx - pointer.tx, at.ty - pointer.ty];
  if (pointer.turns) {
    const other = [...pointers.values()].find((each) => each !== pointer && each.turns);
    if (other) {
      const before = Math.hypot(pointer.tx - other.tx, pointer.ty - other.ty),
        after = Math.hypot(at.tx - other.tx, at.ty - other.ty);
      view.zoom(before / Math.max(1, after));
    } else view.turn(dx, dy);
  }
  Object.assign(pointer, at);
  ((pointer.x += dx * pointer.gain || 0), (pointer.y += dy * pointer.gain || 0));
});
const up = (event) => {
  const id = idOf(event),
    pointer = pointers.get(id);
  canvas.classList.remove('turns');
  if (id === 'mouse' && pointer && event.type === 'pointerup')
    Object.assign(pointer, { down: false, turns: false, asks: false });
  else pointers.delete(id);
};
canvas.addEventListener('pointerup', up);
canvas.addEventListener('pointercancel', up);
canvas.addEventListener('pointerleave', (event) => !pointers.get(idOf(event))?.down && pointers.delete(idOf(event)));
canvas.addEventListener('contextmenu', (event) => event.preventDefault());
canvas.addEventListener(
  'wheel',
  (event) => {
    const presses = [...pointers.values()].some((each) => each.down);
    if (!presses && !event.ctrlKey && narrow.matches) return;
    event.preventDefault();
    if (presses) steps = Math.min(kMostSteps, Math.max(1, steps - Math.sign(event.deltaY)));
    else view.zoom(1.0015 ** event.deltaY);
  },
  { passive: false },
);

// ---- Every picture

const effector = (i) => {
  const at = kHeader + i * kEffector,
    f = level.values;
  return {
    position: f.subarray(at, at + 3),
    force: f.subarray(at + 3, at + 6),
    touching: f[at + 10],
    drawn: f[at + 14],
  };
};
let before = performance.now(),
  shownForce = 0,
  plotted = 0;
function frame(now) {
  requestAnimationFrame(frame);
  const dt = Math.min(0.1, (now - before) / 1000);
  before = now;
  if (!level) return;
  for (const pointer of pointers.values()) {
    // the drawn cursor becomes heavy with the force, then returns
    pointer.gain = pointer.down ? 1 / (1 + shownForce / kHalfForce) : 1;
    if (pointer.down) continue;
    const rejoin = 1 - Math.exp(-dt / 0.08);
    ((pointer.x += rejoin * (pointer.tx - pointer.x)), (pointer.y += rejoin * (pointer.ty - pointer.y)));
  }
  view.update(...(narrow.matches ? [0, -0.1] : [Math.min(0.35, 340 / innerWidth), 0.12]));
  if (!level.asked) {
    level.asked = performance.now();
    ask('frame', { view: view.seen() });
  }
  if (level.values) feel(now);
}
// Pointers go on their own clock: pictures may be slow, hands may not.
setInterval(() => {
  if (!level || !view.forward || document.hidden) return;
  const rays = [...pointers.values()]
    .filter((each) => !each.turns)
    .map(({ id, x, y, down }) => ({ id, down, steps, ...view.ray(x, y) }));
  ask('hands', { pointers: [...rays, ...gamepads(view)] });
}, 16);

function feel(now) {
  const forces = level.effectors.map((_, i) => Math.hypot(...effector(i).force));
  const driving = level.values[5] > 0,
    most = Math.max(0, ...forces);
  shownForce = most;
  tone.play(driving ? forces : forces.map(() => 0)); // a script's own motion is not heard
  if (driving) vibrate(most, now);
  $('force').firstElementChild.textContent = most.toFixed(2);
  if (now - plotted > 120) {
    plotted = now;
    const [, tick, speed] = level.values;
    $('rate').textContent =
      `${tick.toFixed(0)} µs a tick${speed < 0.95 ? `, ${Math.round(100 * speed)} % of real time` : ''}`;
    plot.draw();
  }
  const mouse = pointers.get('mouse'),
    over = mouse && !mouse.turns && [0, 1, 2].some((k) => effector(0).drawn && level.values[kHeader + k] !== 0);
  $('cursor').hidden = !(mouse && mouse.down);
  canvas.classList.toggle('over', Boolean(mouse?.down && over));
  if (mouse) $('cursor').style.transform = `translate(${mouse.x}px, ${mouse.y}px)`;
}

// ---- The panel

const levels = globalThis.pliantLevelList ?? (await (await fetch(new URL('levels.json', import.meta.url))).json());
for (const { name } of levels) $('level').append(new Option(name.replaceAll('_', ' '), name));
$('level').onchange = () => {
  for (const key of ['stiffness', 'young', 'spring', 'shape']) delete settings[key];
  showNamed($('level').value);
};
$('record').onclick = ({ currentTarget: button }) => {
  const on = button.getAttribute('aria-pressed') !== 'true';
  button.setAttribute('aria-pressed', on);
  ask('record', { on });
};
$('restart').onclick = () => (plot.clear(), ask('restart'));
$('sound').onclick = ({ currentTarget: button }) => {
  tone.on = !tone.on;
  button.setAttribute('aria-pressed', tone.on);
  tone.wake();
};
$('share').onclick = async () => {
  const href = link();
  history.replaceState(null, '', href);
  const holds = level?.given
    ? 'it holds the level and its settings.'
    : `it holds the settings alone. ${level?.name ?? 'The level'} is a file of yours: put it on a server, and open it by ?level=ADDRESS.`;
  try {
    await navigator.clipboard.writeText(href);
    say(`The link is copied: ${holds}`, level?.given ? 3 : 12);
  } catch {
    say(`Copy the address of this page: ${holds}`, 12);
  }
};

const hid = []; // devices by number
$('device').hidden = !available();
$('device').onclick = async () => {
  try {
    const device = await connect(ask, hid.length);
    if (!device) return;
    hid.push(device);
    say(`${device.productName} moves ${level?.effectors[0] ?? 'a probe'}.`, 4);
  } catch (error) {
    say(`${error.message}; on Linux install devices/70-pliant.rules, and plug the device in again.`);
  }
};

// ---- Files

async function take(list) {
  const all = [...list],
    main = all.find((each) => /\.(glb|gltf|obj|stl|ply)$/i.test(each.name)) ?? all[0];
  if (!main) return;
  const files = {};
  for (const each of all)
    try {
      if (each !== main) files[each.name] = new Uint8Array(await each.arrayBuffer());
    } catch {
      return told.failed({ sentence: `${each.name}: this browser does not read it; drop files, not folders` });
    }
  show(main, { files });
}
$('open').onclick = () => $('file').click();
$('file').onchange = () => take($('file').files);
addEventListener('dragover', (event) => (event.preventDefault(), document.body.classList.add('drops')));
addEventListener('dragleave', (event) => !event.relatedTarget && document.body.classList.remove('drops'));
addEventListener('drop', (event) => {
  event.preventDefault();
  document.body.classList.remove('drops');
  take(event.dataTransfer.files);
});

// For tests.
globalThis.pliantPage = {
  readings: () => (level?.values ? level.effectors.map((_, i) => effector(i)) : null),
  memory: () => level?.values?.[6] ?? 0,
};

const wanted = new URLSearchParams(location.search).get('level') ?? levels[0].name;
if (levels.some((each) => each.name === wanted)) showNamed(wanted);
else show(wanted, { given: wanted });
requestAnimationFrame(frame);
