// Shows pictures: by WebGL2, else by a 2D canvas. What the core composited is shown as it is.
const VERTEX = `#version 300 es
out vec2 at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  at = vec2(corner.x, 1.0 - corner.y);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
uniform sampler2D picture;
in vec2 at;
out vec4 color;
void main() { color = vec4(texture(picture, at).rgb, 1.0); }`;
const BACK_MS = 2000; // a context that is not back by then does not come

function compile(gl, type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

/** Draws a picture over the whole canvas, or null where there is no WebGL2. */
function makeWebgl(canvas) {
  const gl = canvas.getContext('webgl2', { antialias: false, alpha: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, VERTEX));
  gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, FRAGMENT));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  return ({ data, width, height }) => {
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.length);
    gl.viewport(0, 0, width, height);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };
}

function makeFlat(canvas) {
  const context = canvas.getContext('2d', { alpha: false });
  return ({ data, width, height }) => context.putImageData(new ImageData(data, width, height), 0, 0);
}

/** A screen within `stage`. `tell(text)`: what happened to it. */
export class Screen {
  constructor(stage, tell, { webgl = true } = {}) {
    this.stage = stage;
    this.tell = tell;
    this.#begin(webgl);
  }

  #begin(webgl) {
    const canvas = document.createElement('canvas');
    canvas.setAttribute('aria-hidden', 'true');
    this.canvas?.remove();
    this.stage.prepend(canvas);
    this.canvas = canvas;
    this.draw = webgl ? makeWebgl(canvas) : null;
    this.kind = this.draw ? 'webgl2' : 'canvas';
    this.draw ??= makeFlat(this.#fresh(canvas, webgl));
    if (this.last) this.show(this.last);
    if (this.kind === 'webgl2') this.#watch(canvas);
  }

  /** A canvas that failed to give WebGL2 may give nothing else: another one then. */
  #fresh(canvas, wasTried) {
    if (!wasTried) return canvas;
    this.canvas = canvas.cloneNode();
    canvas.replaceWith(this.canvas);
    return this.canvas;
  }

  #watch(canvas) {
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      this.draw = () => {};
      this.tell('The graphics card took its context back: waiting for it.');
      this.timer = setTimeout(() => {
        this.#begin(false);
        this.tell('The graphics did not come back: the picture goes on without WebGL.');
      }, BACK_MS);
    });
    canvas.addEventListener('webglcontextrestored', () => {
      clearTimeout(this.timer);
      this.#begin(true);
      this.tell('The graphics are back.');
    });
  }

  /** picture: {data, width, height} as Relief.picture() gives it. */
  show(picture) {
    if (this.canvas.width !== picture.width || this.canvas.height !== picture.height) {
      this.canvas.width = picture.width;
      this.canvas.height = picture.height;
      this.stage.style.aspectRatio = `${picture.width} / ${picture.height}`;
    }
    this.last = picture;
    this.draw(picture);
  }
}
