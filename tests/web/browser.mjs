// What the tests of the page share: a static server on loopback, and Chromium driven by playwright-core.
// Chromium: RELIEF_CHROMIUM or /usr/bin/chromium. What is missing skips the test with status 77, and says what.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { join, normalize, extname } from 'node:path';

const SKIPPED = 77;
const CHROMIUM = process.env.RELIEF_CHROMIUM ?? '/usr/bin/chromium';
const TYPES = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.mjs': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8', '.json': 'application/json', '.wasm': 'application/wasm', '.png': 'image/png',
  '.svg': 'image/svg+xml',
};

export function skip(why) {
  console.log(`web: SKIPPED: ${why}`);
  process.exit(SKIPPED);
}

/** Skips unless the build, playwright-core and Chromium are there. `wasm`: the folder build/wasm/web. */
export function needBrowser(wasm) {
  if (!existsSync(join(wasm, 'relief', 'relief.wasm'))) {
    skip(`${wasm} has no relief.wasm: cmake --preset wasm && cmake --build --preset wasm`);
  }
  try {
    createRequire(import.meta.url).resolve('playwright-core');
  } catch {
    skip('no playwright-core: npm ci --prefix tests/web');
  }
  if (!existsSync(CHROMIUM)) skip(`no ${CHROMIUM}: apt-get install chromium`);
}

function answer(folders, path, response) {
  const mount = Object.keys(folders).sort((a, b) => b.length - a.length).find((prefix) => path.startsWith(prefix));
  let file = mount === undefined ? '' : join(folders[mount], normalize(`/${path.slice(mount.length)}`));
  if (file !== '' && existsSync(file) && statSync(file).isDirectory()) file = join(file, 'index.html');
  if (file === '' || !existsSync(file)) {
    response.writeHead(404, { 'content-type': 'text/plain' }).end(`no ${path}`);
    return;
  }
  response.writeHead(200, {
    'content-type': TYPES[extname(file)] ?? 'application/octet-stream',
    'content-length': statSync(file).size,
    'cache-control': 'no-store',
  });
  createReadStream(file).pipe(response);
}

/** Serves folders on 127.0.0.1: {'/': FOLDER, '/three/': FOLDER, ...}. Returns {url, paths, close}. */
export async function serve(folders, port = 0) {
  const paths = [];
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://127.0.0.1').pathname);
    paths.push(path);
    if (path === '/favicon.ico') response.writeHead(204).end();
    else answer(folders, path, response);
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}`,
    paths,
    close: () => new Promise((resolve) => { server.closeAllConnections(); server.close(resolve); }),
  };
}

/** Headless Chromium. Close it with `await browser.close()`. */
export async function launch(options = {}) {
  const { chromium } = await import('playwright-core');
  return chromium.launch({ executablePath: CHROMIUM, ...options });
}

/** A new page that keeps what must not happen: errors on the console, and requests to elsewhere. */
export async function openPage(browser, options = {}) {
  const page = await browser.newPage(options);
  page.setDefaultTimeout(60000);
  const watched = { errors: [], requests: [] };
  page.on('console', (message) => { if (message.type() === 'error') watched.errors.push(message.text()); });
  page.on('pageerror', (error) => watched.errors.push(String(error.stack ?? error)));
  page.on('request', (request) => watched.requests.push(request.url()));
  return { page, watched };
}

/** Requests of a watched page that left `origin`; data: and blob: stay in the page. */
export function outside(watched, origin) {
  return watched.requests.filter((url) => !url.startsWith(origin) && !/^(data|blob):/.test(url));
}
