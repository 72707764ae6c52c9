#!/usr/bin/env node
// Makes build/web/site (the page, the npm package, the levels) and in it pliant.html, which runs from a disk alone, of
// this folder, the module in build/web, content/ and docs/. Usage: node web/assemble.mjs build/web [--no-pictures]
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const web = dirname(fileURLToPath(import.meta.url)),
  root = dirname(web),
  built = resolve(process.argv[2] ?? join(root, 'build/web')),
  site = join(built, 'site');
const kFirst = 'three_probes'; // the level of page one, and of the single file
const kPage = ['index.html', 'style.css', 'page.js', 'view.js', 'senses.js', 'level.js', 'hid.js'];
const kPackage = [
  'package.json',
  'pliant.js',
  'pliant.d.ts',
  'body.js',
  'library.js',
  'files.js',
  'worker.js',
  'hands.js',
  'frame.js',
  'pictures.js',
  'vec.js',
];

const text = (file) => readFileSync(file, 'utf8');
const html = (words) =>
  words.replace(/[&<>"]/g, (each) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[each]);
const fail = (sentence) => {
  console.error(`web/assemble.mjs: ${sentence}`);
  process.exit(1);
};

function levelOf(file) {
  const bytes = readFileSync(file);
  return JSON.parse(bytes.readUInt32LE(0) === 0x46546c67 ? bytes.subarray(20, 20 + bytes.readUInt32LE(12)) : bytes);
}

function listLevels() {
  const folder = join(root, 'content/levels');
  const levels = readdirSync(folder)
    .filter((each) => /\.(glb|gltf)$/.test(each))
    .map((file) => ({
      name: file.replace(/\.\w+$/, ''),
      file,
      about: levelOf(join(folder, file)).asset.extras?.about ?? '',
    }));
  return levels.sort((a, b) => (b.name === kFirst) - (a.name === kFirst) || a.name.localeCompare(b.name));
}

// By the native command, where it is built.
function pictures(levels) {
  const command = join(root, 'build/release/bin/pliant'),
    kept = join(built, 'pictures');
  if (process.argv.includes('--no-pictures') || !existsSync(command)) return;
  mkdirSync(join(site, 'pictures'), { recursive: true });
  for (const { name, file } of levels) {
    const out = join(kept, name);
    if (!existsSync(join(out, 'frame-0002.png')))
      try {
        execFileSync(
          command,
          [
            'run',
            join(root, 'content/levels', file),
            '--headless',
            '--frames',
            '5',
            '--size',
            '640x400',
            '--force',
            '--out',
            out,
          ],
          { stdio: 'ignore', timeout: 120000 },
        );
      } catch {
        console.error(`web/assemble.mjs: ${name}: pliant run made no picture; the gallery goes without`);
        continue;
      }
    cpSync(join(out, 'frame-0002.png'), join(site, 'pictures', `${name}.png`));
  }
}

function gallery(levels) {
  return levels
    .map(({ name, about }) => {
      const picture = existsSync(join(site, 'pictures', `${name}.png`))
        ? `<img src="pictures/${name}.png" alt="" loading="lazy" width="640" height="400">`
        : '<div class="blank"></div>';
      return `<a href="?level=${name}#touch">${picture}<div><strong>${name.replaceAll('_', ' ')}</strong><p>${html(about)}</p><code>pliant run ${name}</code></div></a>`;
    })
    .join('\n');
}

// The force of the shapes' study against its truths.
function accuracy() {
  const rows = text(join(root, 'bench/results/studies/shapes_force.csv'))
    .trim()
    .split('\n')
    .map((line) => line.match(/("[^"]*"|[^,]*)(,|$)/g).map((cell) => cell.replace(/,$/, '').replace(/"/g, '')));
  const column = (name) => rows[0].indexOf(name),
    number = (cell, digits) => (cell === '' ? '' : (1000 * cell).toFixed(digits));
  const head = ['truth', 'Pliant [mN]', 'closed form [mN]', 'error', 'finite elements [mN]'];
  const body = rows
    .slice(1)
    .map((row) => [
      html(row[column('truth')]),
      number(row[column('model_N')], 2),
      number(row[column('true_N')], 2),
      row[column('by_construction')] === '1'
        ? '0, by construction'
        : `${(100 * row[column('force_error')]).toFixed(1)} %`,
      number(row[column('finest_N')], 2),
    ]);
  const cells = (tag, row) => `<tr>${row.map((cell) => `<${tag}>${cell}</${tag}>`).join('')}</tr>`;
  return `<table><thead>${cells('th', head)}</thead><tbody>${body.map((row) => cells('td', row)).join('\n')}</tbody></table>`;
}

function documents() {
  cpSync(join(root, 'docs'), join(site, 'docs'), { recursive: true });
  cpSync(join(root, 'include/pliant.h'), join(site, 'docs/pliant.h'));
  return readdirSync(join(root, 'docs'))
    .filter((each) => each.endsWith('.md'))
    .map((file) => {
      const [title, ...rest] = text(join(root, 'docs', file)).split('\n');
      const first =
        rest
          .join('\n')
          .split('\n\n')
          .map((each) => each.trim())
          .find((each) => /^[A-Z`[]/.test(each)) ?? '';
      const plain = first
        .replace(/\n/g, ' ')
        .replace(/\[([^\]]*)\]\([^)]*\)/g, '$1')
        .replace(/[`*]/g, '');
      const sentence = plain.match(/^.{20,}?[.:](?= |$)/)?.[0].replace(/:$/, '.') ?? plain;
      return `<div><a href="docs/${file}">${html(title.replace(/^# */, ''))}</a><p>${html(sentence)}</p></div>`;
    })
    .join('\n');
}

// Modules of this folder, and what they import, as one script; the last one's code stands at the top level.
function joined(entry, seen = new Set()) {
  const file = existsSync(join(web, entry)) ? join(web, entry) : join(site, entry);
  const out = [];
  let source = text(file).replace(/^import \{([^}]*)\} from '\.\/([\w.]+)';$/gm, (_, names, from) => {
    if (!seen.has(from)) out.push(wrapped(from, seen));
    return `const {${names.replace(/ as /g, ': ')}} = joined['${from}'];`;
  });
  if (/^import /m.test(source)) fail(`${entry}: an import that cannot be joined`);
  return { before: out.join('\n'), source };
}
function wrapped(entry, seen) {
  seen.add(entry);
  const { before, source } = joined(entry, seen),
    names = [];
  const code = source
    .replace(
      /^export ((?:async )?(?:const|class|function)) (\w+)/gm,
      (_, kind, name) => (names.push(name), `${kind} ${name}`),
    )
    .replace(/^export \{([^}]*)\};$/gm, (_, list) => (names.push(list.trim()), ''));
  return `${before}\njoined['${entry}'] = (() => {\n${code}\nreturn {${names.join(', ')}};\n})();`;
}
function script(entry) {
  const { before, source } = joined(entry, new Set([entry]));
  return `const joined = {};\n${before}\n${source}`.replaceAll('import.meta.url', 'location.href'); // a classic worker: no module loads from file:
}

function singleFile(levels) {
  const single = text(join(built, 'pliant.single.js')).replace(
    /export default (\w+);\s*$/,
    'globalThis.pliantModule = (options) => $1({ locateFile: (name) => name, ...options });',
  );
  const { name, file } = levels[0],
    folder = join(root, 'content/levels');
  const base64 = (path) => readFileSync(path).toString('base64');
  const files = Object.fromEntries(
    readdirSync(folder)
      .filter((each) => each.startsWith(`${name}_`) && each.endsWith('.csv'))
      .map((each) => [each, base64(join(folder, each))]),
  );
  files['../environments/sky.exr'] = base64(join(root, 'content/environments/sky.exr'));
  const data = JSON.stringify({ list: [levels[0]], name: file, level: base64(join(folder, file)), files });
  const worker = `${single}\n${script('worker.js')}`;
  const start = `
const data = JSON.parse(document.getElementById('data').textContent);
const bytes = (base64) => Uint8Array.from(atob(base64), (each) => each.charCodeAt(0));
globalThis.pliantLevelList = data.list;
globalThis.pliantLevels = { [data.list[0].name]: { name: data.name, bytes: () => bytes(data.level),
  files: () => Object.fromEntries(Object.entries(data.files).map(([name, each]) => [name, bytes(each)])) } };
globalThis.pliantWorker = () => new Worker(URL.createObjectURL(new Blob([document.getElementById('worker').textContent], { type: 'text/javascript' })));
`;
  const inline = (code) => code.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
  return text(join(web, 'index.html'))
    .replace(/<main>[\s\S]*<\/main>\n/, '')
    .replace(/\s*<nav>.*<\/nav>/, '')
    .replace('<link rel="stylesheet" href="style.css">', () => `<style>\n${text(join(web, 'style.css'))}</style>`)
    .replace(
      '<script type="module" src="page.js"></script>',
      () =>
        `<script type="application/json" id="data">${data}</script>\n<script type="text/plain" id="worker">${inline(worker)}</script>\n` +
        `<script type="module">${inline(start + script('page.js'))}</script>`,
    );
}

for (const file of ['pliant.js', 'pliant.wasm', 'pliant.single.js'])
  if (!existsSync(join(built, file))) fail(`build/web/${file} is missing; run ./dev web`);
rmSync(site, { recursive: true, force: true });
mkdirSync(join(site, 'wasm'), { recursive: true });
for (const file of [...kPage, ...kPackage]) cpSync(join(web, file), join(site, file));
cpSync(join(web, 'examples'), join(site, 'examples'), { recursive: true });
writeFileSync(
  join(site, 'abi.js'),
  execFileSync('python3', [join(root, 'bindings/generate.py'), 'javascript', join(root, 'include/pliant.h')]),
);
for (const file of ['pliant.js', 'pliant.wasm']) cpSync(join(built, file), join(site, 'wasm', file));
for (const folder of ['levels', 'environments'])
  cpSync(join(root, 'content', folder), join(site, folder), { recursive: true });
mkdirSync(join(site, 'images'));
cpSync(join(root, 'bench/results/studies/fidelity.png'), join(site, 'images/fidelity.png'));
cpSync(join(root, 'LICENSE'), join(site, 'LICENSE'));
const levels = listLevels();
writeFileSync(join(site, 'levels.json'), JSON.stringify(levels));
pictures(levels);
const parts = { gallery: gallery(levels), accuracy: accuracy(), documents: documents() };
writeFileSync(
  join(site, 'index.html'),
  text(join(web, 'index.html')).replace(/<!-- (gallery|accuracy|documents) -->/g, (_, part) => parts[part]),
);
writeFileSync(join(site, 'pliant.html'), singleFile(levels));
console.log(
  `build/web/site: ${levels.length} levels, ${basename(site)}/pliant.html ${(readFileSync(join(site, 'pliant.html')).length / 1e6).toFixed(1)} MB`,
);
