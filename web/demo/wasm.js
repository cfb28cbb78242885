// The module's bytes: inside the page of one file, else beside relief.js.
export async function wasmBytes() {
  const inside = document.getElementById('wasm');
  if (!inside) return undefined;
  const text = atob(inside.textContent.trim());
  const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}
