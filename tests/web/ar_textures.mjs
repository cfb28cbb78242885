// Depth that is in a texture, of every kind that a device may give, and a session by such.
import { DepthReader } from '/relief/xr_depth.js';
import { biased, enter, frames, state } from './ar_emulator.mjs';
import { cast, rayOf } from './ar_rays.mjs';

const identity = { matrix: new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]) };

/** A texture of a ramp in a format, alone or as layer 1 of two. */
function rampTexture(gl, format, isArray, width, height) {
  const [internal, layout, type, make] = {
    float32: [gl.R32F, gl.RED, gl.FLOAT, (ramp) => Float32Array.from(ramp, (x) => x / 1000)],
    'unsigned-short': [gl.R16UI, gl.RED_INTEGER, gl.UNSIGNED_SHORT, (ramp) => Uint16Array.from(ramp)],
    'luminance-alpha': [gl.LUMINANCE_ALPHA, gl.LUMINANCE_ALPHA, gl.UNSIGNED_BYTE,
      (ramp) => new Uint8Array(Uint16Array.from(ramp).buffer)],
  }[format];
  const ramp = Array.from({ length: width * height }, (_, i) => 300 + 7 * i), data = make(ramp);
  const target = isArray ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, texture = gl.createTexture();
  gl.bindTexture(target, texture);
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  if (isArray) {
    gl.texImage3D(target, 0, internal, width, height, 2, 0, layout, type, null);
    gl.texSubImage3D(target, 0, 0, 0, 1, width, height, 1, layout, type, data);
  } else {
    gl.texImage2D(target, 0, internal, width, height, 0, layout, type, data);
  }
  return { texture, expected: format === 'float32' ? ramp.map((x) => x / 1000) : ramp };
}

/** What comes back of a texture: the largest error, and whether its rows were turned over as told. */
export async function readTexture(format, isArray, depthNear) {
  const gl = document.createElement('canvas').getContext('webgl2');
  const width = 20, height = 6;
  const { texture, expected } = rampTexture(gl, format, isArray, width, height);
  const info = {
    width, height, texture, textureType: isArray ? 'texture-array' : 'texture', imageIndex: 1, depthNear, depthFar: Infinity,
    normDepthBufferFromNormView: identity, rawValueToMeters: 0.001,
  };
  const session = { depthUsage: 'gpu-optimized', depthDataFormat: format };
  const reader = new DepthReader(session, gl, () => ({ getDepthInformation: () => info }));
  reader.read(null, { eye: 'left', projectionMatrix: identity.matrix, transform: identity });
  let back = null;
  while (back === null) {
    await new Promise((resolve) => setTimeout(resolve, 10));
    back = reader.bytes(null);
  }
  const at = (i) => (depthNear ? (height - 1 - Math.floor(i / width)) * width + (i % width) : i);
  return Math.max(...new Float32Array(back.data).map((x, i) => Math.abs(x - expected[at(i)])));
}

/** A session by textures: the core's depth beside exact rays, with the emulator's bias. */
export async function textureErrors() {
  const endless = (session, gl) => {
    const binding = new XRWebGLBinding(session, gl);
    const getDepthInformation = (view) => {
      const info = binding.getDepthInformation(view);
      return info && { ...info, depthFar: Infinity };
    };
    return { getDepthInformation };
  };
  await enter({ depth: { usage: ['gpu-optimized'] }, binding: endless });
  await frames(20);
  const { relief, last: { pose: { views: [view] } } } = state;
  const depth = relief.plane('depth'), reason = relief.plane('reason'), { width, height } = relief;
  const errors = [];
  for (let j = 70; j < height; j += 12) {
    for (let i = 6; i < width; i += 12) {
      const { o, d } = rayOf(view, [(2 * i + 0.5) / (2 * width), 1 - (2 * j + 0.5) / (2 * height)]);
      const z = cast(state.soup, o, d);
      if (z < 4 && reason[j * width + i] === 0) errors.push(Math.abs(depth[j * width + i] - biased(z)));
    }
  }
  return { usage: state.ar.session.depthUsage, errors };
}
