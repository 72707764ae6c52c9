// single.mjs PLIANT.js: writes PLIANT.single.js, a module that holds PLIANT.wasm, for one file that is opened from disk.
import {readFileSync, writeFileSync} from 'node:fs';

const file = process.argv[2], wasm = readFileSync(file.replace(/js$/, 'wasm'));
const text = readFileSync(file, 'utf8').replaceAll('import.meta.url', '""').replace(/export default createPliant;?\s*$/, '');
writeFileSync(file.replace(/js$/, 'single.js'), `${text}
const createPliantWithWasm = (options = {}) => createPliant(
  {wasmBinary: Uint8Array.from(atob("${wasm.toString('base64')}"), c => c.charCodeAt(0)), ...options});
export default createPliantWithWasm;
`);
