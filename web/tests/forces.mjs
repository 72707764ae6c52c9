// Every shipped level for 1.5 s in lockstep, by the WebAssembly module and by the native library: with the same libm
// (musl_math.sh) every reading has the same bits, but in two levels, where one soft step differs for a cause that is not
// known (kPart). With glibc's, forces and torques agree within 1e-6 of the largest of the run, over all of it, but for
// levels that amplify a last bit of libm by more (kAmplify): a native run with musl's parts from one with glibc's in the
// same way.
//   node web/tests/forces.mjs [LEVEL...]     needs build/web (./dev web), native_forces and libmusl_math.so (./dev test web)
import {execFileSync} from 'node:child_process';
import {readFileSync, readdirSync} from 'node:fs';

const kTicks = 1500, kBatch = 300, kBytes = 144, kForce = 64, kTorque = 88;  // pliant_reading of include/pliant.h
const kTolerance = 1e-6;                                       // [1] of the largest force, or torque, of an effector
const kAmplify = {'forceps.glb': 1e-3};                        // [1] instead
const kPart = {'grasp.glb': 5e-2, 'hand_squeeze.glb': 0.5};    // [1] instead, with either libm
const root = new URL('../../', import.meta.url).pathname;
const levels = root + 'content/levels/';

const build = root + 'build/web/';
const {default: createPliant} = await import(build + 'pliant.js');
const pliant = await createPliant({wasmBinary: readFileSync(build + 'pliant.wasm')});
for (const file of readdirSync(levels)) pliant.FS.writeFile('/' + file, readFileSync(levels + file));

function text(string) {
  const size = pliant.lengthBytesUTF8(string) + 1, at = pliant._malloc(size);
  pliant.stringToUTF8(string, at, size);
  return at;
}

function check(status) {
  if (status !== 0) throw new Error(pliant.UTF8ToString(pliant._pliant_error_message()));
}

// The readings of every effector and tick, as native_forces writes them, and the durations of a tick.
function run(level) {
  const out = pliant._malloc(64), u32 = at => pliant.HEAPU32[at >> 2];
  check(pliant._pliant_scene_load(text('/' + level), 0, out));
  const scene = u32(out);
  check(pliant._pliant_session_open(scene, 0, 0, out));
  const session = u32(out);
  check(pliant._pliant_session_keep_readings(session, BigInt(kBatch)));
  check(pliant._pliant_session_effector_count(session, out));
  const effectors = u32(out), rows = pliant._malloc(kBatch * kBytes);
  const all = Array.from({length: effectors}, () => new Uint8Array(kTicks * kBytes));
  let seconds = 0;
  for (let done = 0; done < kTicks; done += kBatch) {
    const begin = process.cpuUsage();
    check(pliant._pliant_session_step(session, BigInt(kBatch)));
    const used = process.cpuUsage(begin);
    seconds += (used.user + used.system) / 1e6;
    for (let e = 0; e < effectors; ++e) {
      check(pliant._pliant_session_effector(session, e, out));
      const name = u32(out);
      pliant.HEAPU8.fill(0, rows, rows + kBatch * kBytes);
      pliant.HEAPU32[rows >> 2] = kBytes;
      check(pliant._pliant_session_take_readings(session, name, rows, kBatch, out, out + 8));
      if (u32(out) !== kBatch) throw new Error(`${level}: ${u32(out)} readings of ${kBatch}`);
      all[e].set(pliant.HEAPU8.subarray(rows, rows + kBatch * kBytes), done * kBytes);
    }
  }
  pliant.HEAPU32[out >> 2] = 56;  // sizeof(pliant_figures)
  check(pliant._pliant_session_figures(session, out));
  const p50 = pliant.HEAPF64[(out >> 3) + 2];
  check(pliant._pliant_session_destroy(session));
  check(pliant._pliant_scene_destroy(scene));
  pliant._free(rows);
  pliant._free(out);
  return {all, p50, seconds};
}

function native(level, effectors, libm) {
  const file = build + 'native.bin', env = libm ? {...process.env, LD_PRELOAD: libm} : process.env;
  const said = execFileSync(build + 'native_forces', [levels + level, String(kTicks), file], {encoding: 'utf8', env});
  const bytes = new Uint8Array(readFileSync(file));
  if (bytes.length !== effectors * kTicks * kBytes) throw new Error(`${level}: the native run has other effectors`);
  const size = kTicks * kBytes, [p50, seconds] = said.split(' ').map(Number);
  return {all: Array.from({length: effectors}, (_, e) => bytes.subarray(e * size, (e + 1) * size)), p50, seconds};
}

// The largest difference of a vector, over the largest vector of the run; and the first tick with more than is tolerated,
// or -1.
function difference(a, b, offset) {
  const of = bytes => new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), x = of(a), y = of(b);
  let most = 0, apart = 0;
  const differences = [];
  for (let row = 0; row < kTicks; ++row) {
    let size = 0, between = 0;
    for (let c = 0; c < 3; ++c) {
      const at = row * kBytes + offset + 8 * c, mine = x.getFloat64(at, true), theirs = y.getFloat64(at, true);
      size += theirs * theirs, between += (mine - theirs) ** 2;
    }
    if (Number.isNaN(size + between)) return {apart: NaN, parts: row};
    differences.push(Math.sqrt(between));
    most = Math.max(most, Math.sqrt(size)), apart = Math.max(apart, differences[row]);
  }
  return {apart: apart === 0 ? 0 : apart / most, parts: differences.findIndex(each => each > kTolerance * most)};
}

// The largest difference of forces and torques, the first tick beyond tolerance, the share of rows with the same bits.
function compare(run, other) {
  let most = 0, same = 0, parts = kTicks;
  run.all.forEach((mine, e) => {
    const theirs = other.all[e];
    for (const offset of [kForce, kTorque]) {
      const found = difference(mine, theirs, offset);
      most = Number.isNaN(found.apart) ? NaN : Math.max(most, found.apart);
      if (found.parts >= 0) parts = Math.min(parts, found.parts);
    }
    for (let row = 0; row < kTicks; ++row)
      same += Buffer.compare(mine.subarray(row * kBytes, (row + 1) * kBytes), theirs.subarray(row * kBytes, (row + 1) * kBytes)) === 0;
  });
  return {most, parts, same: same / (run.all.length * kTicks)};
}

const percent = share => share === 1 ? 'all' : (100 * share).toFixed(1) + ' %';
const asked = process.argv.slice(2);
const names = readdirSync(levels).filter(file => /\.(glb|gltf)$/.test(file) && (asked.length === 0 || asked.includes(file)));
let failed = 0;
console.log('level              same bits by one libm   against glibc: difference, same bits   tick [us], all [s], wasm/native');
for (const level of names) {
  run(level);  // once before: the browser's compiler optimises while this one runs
  const here = run(level), there = native(level, here.all.length);
  const twin = compare(here, native(level, here.all.length, build + 'libmusl_math.so')), plain = compare(here, there);
  const limit = kPart[level] ?? kAmplify[level] ?? kTolerance, same = twin.same === 1 || twin.most <= (kPart[level] ?? 0);
  let said = '';
  if (plain.most > kTolerance) said = `   parts at tick ${plain.parts}`;
  if (!(plain.most <= limit)) said += `: FAILED, the limit is ${limit}`;
  if (twin.same !== 1) said += `   ${same ? '' : 'FAILED '}by one libm: differs by ${twin.most.toExponential(1)}, beyond ${kTolerance} from tick ${twin.parts}`;
  failed += !(plain.most <= limit) || !same;
  console.log(`${level.padEnd(20)}${percent(twin.same).padStart(9)}   ${plain.most.toExponential(1).padStart(10)}  ` +
              `${percent(plain.same).padStart(9)}   ${here.p50.toFixed(1)}/${there.p50.toFixed(1)}  ${here.seconds.toFixed(2)}/${there.seconds.toFixed(2)}${said}`);
}
if (names.length === 0 || failed > 0) {
  console.error(names.length === 0 ? 'forces.mjs: no such level' : `forces.mjs: ${failed} of ${names.length} levels differ by more than their limit`);
  process.exit(1);
}
