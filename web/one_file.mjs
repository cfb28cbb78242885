// The page as one file without modules, so that it also runs from a disk: one_file.mjs FOLDER_OF_demo_AND_relief
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';
import { gzipSync } from 'node:zlib';

const folder = process.argv[2];
const read = (path) => readFileSync(join(folder, path), 'utf8');
const order = [];

/** `import { a, b as c } from './x.js'` of a file: [whole text, names, path]. */
function importsOf(path, text) {
  return [...text.matchAll(/^(?:import|export) (?:\{([^}]*)\} )?from ['"](\.[^'"]+)['"];?$/gm)]
    .map(([whole, names, from]) => ({ whole, names, path: normalize(join(dirname(path), from)) }));
}

/** Each module becomes a function's body that returns what it exports; those it imports come first. */
function add(path, seen = new Set()) {
  if (seen.has(path)) return;
  seen.add(path);
  let text = read(path);
  for (const { whole, names, path: from } of importsOf(path, text)) {
    add(from, seen);
    const isExport = whole.startsWith('export');
    const taken = `const {${names.replaceAll(' as ', ': ')}} = modules[${JSON.stringify(from)}];`;
    text = text.replace(whole, () => (isExport ? `${taken} export {${names}};` : taken));
  }
  const exported = [...text.matchAll(/^export (?:async )?(?:function|class|const) ([\w$]+)/gm)].map((match) => match[1]);
  const listed = [...text.matchAll(/export \{([^}]*)\};/g)].flatMap((match) => match[1].split(',').map((name) => name.trim()));
  const body = text.replace(/export \{[^}]*\};/g, '').replace(/^export /gm, '').replaceAll('import.meta.url', 'location.href');
  order.push(`modules[${JSON.stringify(path)}] = (() => {\n${body}\nreturn { ${[...exported, ...listed].join(', ')} };\n})();`);
}

/** A module and all that it imports, as one script. */
function scriptOf(path) {
  order.length = 0;
  add(normalize(path));
  return `'use strict';\nconst modules = {};\n${order.join('\n')}`.replaceAll('</script', '<\\/script');
}

const script = scriptOf('demo/main.js'), worker = scriptOf('relief/worker.js');
const wasm = gzipSync(readFileSync(join(folder, 'relief/relief.wasm')), { level: 9 }).toString('base64');
const html = read('demo/index.html')
  .replace(/ *<link rel="(?:module)?preload".*\n/g, '')
  .replace('<script type="module" src="wasm.js" async></script>\n', '')
  .replace('<link rel="stylesheet" href="style.css">', () => `<style>\n${read('demo/style.css')}</style>`)
  .replace('<script type="module" src="main.js"></script>', () => `<script id="wasm" type="text/plain">${wasm}</script>
  <script id="worker" type="text/plain">${worker}</script>
  <script>\n${script}\n</script>`);
writeFileSync(join(folder, 'relief.html'), html);
