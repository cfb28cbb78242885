// Bodies over the passthrough picture, in WebGL2: instanced, hidden softly by an eye's depth, with a shadow where they
// come near to what is real.
import { compile, invertRigid } from './xr_gl.js';
import { BODY_FRAGMENT, BODY_VERTEX, SHADOW_FRAGMENT, SHADOW_VERTEX } from './xr_shaders.js';
import { MESHES, measures } from './xr_shapes.js';

const INSTANCE_FLOATS = 16; // place, radius; quaternion; scale, half; colour, 0
const COLORS = [[0.96, 0.45, 0.1], [0.12, 0.55, 0.9], [0.95, 0.75, 0.15], [0.3, 0.7, 0.35], [0.8, 0.25, 0.45],
  [0.55, 0.4, 0.85]];

function makeMesh(gl, { corners, triangles }) {
  const vao = gl.createVertexArray();
  gl.bindVertexArray(vao);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(corners), gl.STATIC_DRAW);
  gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 28, 0);
  gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 28, 16);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(triangles), gl.STATIC_DRAW);
  for (let i = 0; i < 6; i++) gl.enableVertexAttribArray(i);
  for (let i = 2; i < 6; i++) gl.vertexAttribDivisor(i, 1);
  gl.bindVertexArray(null);
  return { vao, count: triangles.length };
}

export class BodyDrawer {
  constructor(gl) {
    this.gl = gl;
    this.instances = gl.createBuffer();
    this.capacity = 0;
    this.meshes = Object.fromEntries(Object.entries(MESHES).map(([shape, mesh]) => [shape, makeMesh(gl, mesh)]));
    this.body = compile(gl, BODY_VERTEX, BODY_FRAGMENT);
    this.shadow = compile(gl, SHADOW_VERTEX, SHADOW_FRAGMENT);
    this.groups = [];
  }

  /** Bodies of the next pictures, as SeeThrough.bodies() has them; `ahead` seconds after the core's last frame. */
  take(bodies, ahead = 0) {
    const shapes = Object.keys(this.meshes);
    if (bodies.length > this.capacity) {
      this.capacity = 2 * bodies.length;
      this.values = new Float32Array(this.capacity * INSTANCE_FLOATS);
    }
    let at = 0;
    this.groups = shapes.map((shape) => {
      const first = at;
      for (const body of bodies) if (body.shape === shape) this.#put(at++, body, ahead);
      return { shape, first, count: at - first };
    }).filter(({ count }) => count > 0);
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    gl.bufferData(gl.ARRAY_BUFFER, this.values ?? new Float32Array(0), gl.DYNAMIC_DRAW);
  }

  /** Draws into the viewport of a view; depth null: nothing hides them. */
  draw(view, depth) {
    const { gl } = this;
    const eye = view.transform.matrix;
    const clip = multiply(view.projectionMatrix, invertRigid(eye));
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.CULL_FACE);
    gl.disable(gl.DEPTH_TEST);
    gl.cullFace(gl.FRONT);
    this.#use(this.shadow, clip, eye, depth);
    for (const group of this.groups) this.#drawGroup(this.meshes.box, group);
    gl.enable(gl.DEPTH_TEST);
    gl.cullFace(gl.BACK);
    this.#use(this.body, clip, eye, depth);
    for (const group of this.groups) this.#drawGroup(this.meshes[group.shape], group);
    gl.bindVertexArray(null);
  }

  #put(at, body, ahead) {
    const { scale, half, radius } = measures(body);
    const place = body.position.map((p, k) => p + (body.isAsleep ? 0 : body.velocity[k] * ahead));
    const color = COLORS[(body.id?.[0] ?? at) % COLORS.length];
    this.values.set([...place, radius, ...body.quaternion, ...scale, half, ...color, 0], at * INSTANCE_FLOATS);
  }

  #use({ program, at }, clip, eye, depth) {
    const { gl } = this;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at('u_clip_from_world'), false, clip);
    gl.uniform3f(at('u_eye'), eye[12], eye[13], eye[14]);
    gl.uniform2f(at('u_size'), depth?.width ?? 0, depth?.height ?? 0);
    if (!depth) return;
    const { bufferFromView: b, projection: p } = depth;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, depth.texture);
    gl.uniform1i(at('u_depth'), 0);
    gl.uniformMatrix4fv(at('u_depth_from_world'), false, invertRigid(depth.pose));
    gl.uniformMatrix4fv(at('u_world_from_depth'), false, depth.pose);
    gl.uniform4f(at('u_lens'), p[0], p[5], p[8], p[9]);
    gl.uniform3fv(at('u_buffer'), [b[0], b[4], b[12], b[1], b[5], b[13]]);
    const isFinite = Number.isFinite(depth.far) && depth.far > 0;
    gl.uniform3f(at('u_raw'), depth.rawToMetres, depth.near, isFinite ? depth.near / depth.far : 0);
  }

  #drawGroup(mesh, { first, count }) {
    const { gl } = this;
    gl.bindVertexArray(mesh.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    for (let i = 0; i < 4; i++) {
      gl.vertexAttribPointer(2 + i, 4, gl.FLOAT, false, 4 * INSTANCE_FLOATS, 4 * INSTANCE_FLOATS * first + 16 * i);
    }
    gl.drawElementsInstanced(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0, count);
  }
}

function multiply(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++) {
    for (let r = 0; r < 4; r++) {
      for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    }
  }
  return out;
}
