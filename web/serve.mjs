// Serves folders on 127.0.0.1, packed by gzip as a web host would: serve.mjs FOLDER [PORT]
import { createServer } from 'node:http';
import { existsSync, readFileSync, statSync } from 'node:fs';
import { extname, join, normalize } from 'node:path';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';

const TYPES = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.mjs': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8', '.json': 'application/json', '.wasm': 'application/wasm', '.png': 'image/png',
  '.svg': 'image/svg+xml',
};

function fileOf(folders, path) {
  const mount = Object.keys(folders).sort((a, b) => b.length - a.length).find((prefix) => path.startsWith(prefix));
  if (mount === undefined) return null;
  let file = join(folders[mount], normalize(`/${path.slice(mount.length)}`));
  if (existsSync(file) && statSync(file).isDirectory()) file = join(file, 'index.html');
  return existsSync(file) ? file : null;
}

const packed = new Map(); // by file and time: a browser waits for no second packing

function packedOf(file) {
  const key = `${file} ${statSync(file).mtimeMs}`;
  if (!packed.has(key)) packed.set(key, gzipSync(readFileSync(file)));
  return packed.get(key);
}

function answer(folders, path, request, response) {
  const file = fileOf(folders, path);
  if (file === null) {
    response.writeHead(404, { 'content-type': 'text/plain' }).end(`no ${path}`);
    return;
  }
  const isPacked = /\bgzip\b/.test(request.headers['accept-encoding'] ?? '') && extname(file) in TYPES;
  const body = isPacked ? packedOf(file) : readFileSync(file);
  response.writeHead(200, {
    'content-type': TYPES[extname(file)] ?? 'application/octet-stream', 'content-length': body.length, 'cache-control': 'no-store',
    ...(isPacked ? { 'content-encoding': 'gzip' } : {}),
  }).end(body);
}

/** Serves folders: {'/': FOLDER, '/three/': FOLDER, ...}. Returns {url, paths, close}. */
export async function serve(folders, port = 0) {
  const paths = [];
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://127.0.0.1').pathname);
    paths.push(path);
    answer(folders, path, request, response);
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}`,
    paths,
    close: () => new Promise((resolve) => { server.closeAllConnections(); server.close(resolve); }),
  };
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const [folder, port = '0'] = process.argv.slice(2);
  try {
    const { url } = await serve({ '/': folder }, Number(port));
    console.log(`The page: ${url}/demo/\nOn this machine only. Ctrl-C ends it.`);
  } catch (error) {
    console.error(`script/web: port ${port}: ${error.code === 'EADDRINUSE' ? 'is in use: give another one with --port' : error.message}`);
    process.exitCode = 1;
  }
}
