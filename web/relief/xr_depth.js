// A device's depth of one view in one form, whichever of WebXR's two ways it comes by: matrices, bytes for the core, and
// a float texture that bodies hide behind. A texture that only the GPU has is read back, and comes a frame later with
// the matrices that it was seen by.
import { compile, drawAll, FULL_SCREEN } from './xr_gl.js';

const TEXTURES = { // what a fragment reads of a texture, by its format
  'luminance-alpha': { sampler: 'sampler', value: 'dot(texel.ra, vec2(255.0, 65280.0))' },
  'unsigned-short': { sampler: 'usampler', value: 'float(texel.r)' },
  float32: { sampler: 'sampler', value: 'texel.r' },
};

function copyShader({ sampler, value }, isArray) {
  const kind = `${sampler}2D${isArray ? 'Array' : ''}`;
  return `#version 300 es
    precision highp float;
    precision highp ${kind};
    uniform ${kind} u_depth;
    uniform int u_layer, u_last_row; // u_last_row >= 0: rows come from the bottom
    out vec4 color;
    void main() {
      ivec2 at = ivec2(gl_FragCoord.xy);
      if (u_last_row >= 0) at.y = u_last_row - at.y;
      ${sampler === 'usampler' ? 'uvec4' : 'vec4'} texel = texelFetch(u_depth, ${isArray ? 'ivec3(at, u_layer)' : 'at'}, 0);
      color = vec4(${value}, 0.0, 0.0, 1.0);
    }`;
}

/** A one-channel float texture of a buffer's size. */
class FloatTexture {
  constructor(gl) {
    this.gl = gl;
    this.texture = gl.createTexture();
    this.width = this.height = 0;
  }

  resize(width, height) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    if (width === this.width && height === this.height) return;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, width, height, 0, gl.RED, gl.FLOAT, null);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    Object.assign(this, { width, height, values: new Float32Array(width * height) });
  }

  /** Raw values as they are: 16 bits, or floats. */
  upload(data, format, width, height) {
    const { gl } = this;
    this.resize(width, height);
    this.values.set(format === 'float32' ? new Float32Array(data) : new Uint16Array(data));
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RED, gl.FLOAT, this.values);
  }
}

/** Reads a float texture back without waiting for the GPU. */
class ReadBack {
  constructor(gl) {
    this.gl = gl;
    this.buffer = gl.createBuffer();
    this.waiting = null;
  }

  /** The framebuffer that is bound is on its way; `about` comes with it. */
  start(width, height, about) {
    const { gl } = this;
    if (this.waiting !== null) return;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, width * height * 4, gl.STREAM_READ);
    gl.readPixels(0, 0, width, height, gl.RED, gl.FLOAT, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    this.waiting = { about, bytes: width * height * 4, fence: gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0) };
    gl.flush();
  }

  /** What has come: {data, ...about}; null = nothing yet. */
  take() {
    const { gl, waiting } = this;
    if (waiting === null || gl.clientWaitSync(waiting.fence, 0, 0) === gl.TIMEOUT_EXPIRED) return null;
    this.data = this.data?.byteLength === waiting.bytes ? this.data : new ArrayBuffer(waiting.bytes);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, new Uint8Array(this.data));
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    gl.deleteSync(waiting.fence);
    this.waiting = null;
    return { ...waiting.about, format: 'float32', data: this.data };
  }
}

/** Where a depth view stands and what it sees: its own, or with matchDepthView those of the view. */
function matricesOf(info, view) {
  return {
    width: info.width,
    height: info.height,
    bufferFromView: info.normDepthBufferFromNormView.matrix ?? info.normDepthBufferFromNormView,
    projection: info.projectionMatrix ?? view.projectionMatrix,
    pose: (info.transform ?? view.transform).matrix,
  };
}

export class DepthReader {
  #programs = new Map();
  #eyes = new Map();
  #binding = null;

  /** `gpu`: the session's depth is gpu-optimized; `binding`: makes the XRWebGLBinding. */
  constructor(session, gl, binding) {
    Object.assign(this, { session, gl, isGpu: session.depthUsage === 'gpu-optimized' });
    if (!this.isGpu) return;
    if (gl.getExtension('EXT_color_buffer_float') === null) {
      throw new Error('depth is in a texture, and this GPU cannot write floats: ask for cpu-optimized depth');
    }
    this.#binding = binding(session, gl);
    this.readBack = new ReadBack(gl);
    this.framebuffer = gl.createFramebuffer();
  }

  /** Depth of one view, or null: {width, height, bufferFromView, projection, pose, rawToMetres, near, far, texture}, and
   * data and format where they are at hand. */
  read(frame, view) {
    const info = this.isGpu ? this.#binding.getDepthInformation(view) : frame.getDepthInformation(view);
    if (info === null || info === undefined) return null;
    if (!(info.width > 0 && info.height > 0)) throw new Error(`depth buffer of ${info.width} x ${info.height} pixels`);
    const target = this.#eyes.get(view.eye) ?? new FloatTexture(this.gl);
    this.#eyes.set(view.eye, target);
    return this.isGpu ? this.#fromTexture(info, view, target) : this.#fromBytes(info, view, target);
  }

  /** What the core gets of the eye that it sees by: its bytes now, or those that have come back. */
  bytes(depth) {
    return this.isGpu ? this.readBack.take() : depth;
  }

  #fromBytes(info, view, target) {
    const format = this.session.depthDataFormat;
    const bytes = info.width * info.height * (format === 'float32' ? 4 : 2);
    if (info.data.byteLength !== bytes) {
      const size = `${info.width} x ${info.height} pixels`;
      throw new Error(`depth buffer of ${size}: ${info.data.byteLength} bytes came, not ${bytes}`);
    }
    target.upload(info.data, format, info.width, info.height);
    return {
      ...matricesOf(info, view), rawToMetres: info.rawValueToMeters, near: 0, far: 0, format, data: info.data,
      texture: target.texture,
    };
  }

  #fromTexture(info, view, target) {
    // A device that tells its depth's planes gives an OpenGL depth, from the bottom row on: not WebXR's, but Quest's.
    const isPlanes = info.depthNear > 0;
    const about = {
      ...matricesOf(info, view), rawToMetres: isPlanes ? 1 : info.rawValueToMeters, near: isPlanes ? info.depthNear : 0,
      far: isPlanes ? info.depthFar : 0, texture: target.texture,
    };
    this.#copy(info, target, isPlanes);
    if (view.eye !== 'right') this.readBack.start(info.width, info.height, about);
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, null);
    return about;
  }

  #copy(info, target, isPlanes) {
    const { gl } = this;
    const isArray = info.textureType === 'texture-array';
    const program = this.#program(isPlanes ? 'float32' : this.session.depthDataFormat, isArray);
    target.resize(info.width, info.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target.texture, 0);
    gl.viewport(0, 0, info.width, info.height);
    for (const state of [gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE, gl.SCISSOR_TEST]) gl.disable(state);
    gl.useProgram(program.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(isArray ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, info.texture);
    gl.uniform1i(program.at('u_depth'), 0);
    gl.uniform1i(program.at('u_layer'), info.imageIndex ?? 0);
    gl.uniform1i(program.at('u_last_row'), isPlanes ? info.height - 1 : -1);
    drawAll(gl);
    gl.bindTexture(isArray ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, null);
  }

  #program(format, isArray) {
    const key = `${format} ${isArray}`;
    if (!this.#programs.has(key)) {
      this.#programs.set(key, compile(this.gl, FULL_SCREEN, copyShader(TEXTURES[format], isArray)));
    }
    return this.#programs.get(key);
  }
}
