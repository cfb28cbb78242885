// Pictures of a recording: depth to 16 bits, colour to RGBA. What has the wrong size is told.
import { decodePng16, isPng, pngHead } from './png.js';
import { decodeRvl } from './rvl.js';

const DEPTH_HEAD = 12; // of compressedDepth: a kind and two floats

function checkSize(width, height, camera, what) {
  if (width === camera.width && height === camera.height) return;
  throw new Error(`${what}: is ${width} x ${height}, and its camera ${camera.width} x ${camera.height}`);
}

/** Depth of a compressedDepth message, or of a PNG file. */
export async function decodeDepth(data, format, camera, what) {
  if (format.includes('rvl')) {
    if (data.length < DEPTH_HEAD + 8) throw new Error(`${what}: is cut short`);
    const view = new DataView(data.buffer, data.byteOffset + DEPTH_HEAD, 8);
    checkSize(view.getUint32(0, true), view.getUint32(4, true), camera, what);
    return decodeRvl(data.subarray(DEPTH_HEAD + 8), camera.width * camera.height, what);
  }
  const png = await decodePng16(isPng(data) ? data : data.subarray(DEPTH_HEAD), what);
  checkSize(png.width, png.height, camera, what);
  return png.data;
}

/** Depth of a raw image: 16UC1 and mono16, or 32FC1 in metres, rounded to `unitsPerMetre`. */
export function rawDepth(image, camera, unitsPerMetre, what) {
  checkSize(image.width, image.height, camera, what);
  const isFloat = image.encoding === '32FC1';
  const bytes = isFloat ? 4 : 2;
  const view = new DataView(image.data.buffer, image.data.byteOffset, image.data.length);
  if (image.data.length < image.step * (image.height - 1) + bytes * image.width) throw new Error(`${what}: is cut short`);
  const out = new Uint16Array(image.width * image.height);
  for (let y = 0, i = 0; y < image.height; y++) {
    for (let x = 0; x < image.width; x++, i++) {
      const at = y * image.step + bytes * x;
      if (!isFloat) out[i] = view.getUint16(at, !image.isBig);
      else out[i] = Math.min(65535, Math.round(unitsPerMetre * Math.max(0, view.getFloat32(at, !image.isBig) || 0)));
    }
  }
  return out;
}

/** RGBA of a JPEG or PNG, by the browser. */
export async function decodeColor(data, camera, what) {
  const type = isPng(data) ? 'image/png' : 'image/jpeg';
  let bitmap;
  try {
    bitmap = await createImageBitmap(new Blob([data], { type }), { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  } catch {
    throw new Error(`${what}: the browser cannot read this picture`);
  }
  checkSize(bitmap.width, bitmap.height, camera, what);
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext('2d', { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return context.getImageData(0, 0, canvas.width, canvas.height).data;
}

/** Size of a PNG or JPEG from its head; null for anything else. */
export function pictureSize(data) {
  const png = pngHead(data);
  if (png) return { width: png.width, height: png.height };
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  for (let at = 2; at + 9 < data.length && view.getUint16(0) === 0xffd8;) {
    const marker = data[at + 1];
    const isFrame = marker >= 0xc0 && marker <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(marker);
    if (isFrame) return { width: view.getUint16(at + 7), height: view.getUint16(at + 5) };
    at += 2 + view.getUint16(at + 2);
  }
  return null;
}
