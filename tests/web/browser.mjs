// What the tests of the page share: a static server on loopback, and Chromium driven by playwright-core.
// Chromium: RELIEF_CHROMIUM or /usr/bin/chromium. What is missing skips the test with status 77, and says what.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

export { serve } from '../../web/serve.mjs';

const SKIPPED = 77;
const CHROMIUM = process.env.RELIEF_CHROMIUM ?? '/usr/bin/chromium';

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
