// A scene.json as Relief's JavaScript takes it.
import { hullOf } from './hull.js';
import { spawn } from './spawn.js';

function bodyOf(body, models, hulls) {
  if (body.shape !== 'hull') return body;
  const key = `${body.model} ${body.size}`;
  if (!hulls.has(key)) hulls.set(key, hullOf(models[body.model], body.size));
  const { size, model, ...rest } = body;
  return { ...rest, hull: hulls.get(key) };
}

/** json: the file's object; models: texts of the OBJ files that it names. */
export function sceneOf(json, models = {}) {
  const hulls = new Map();
  const bodies = (json.bodies ?? []).map((body) => bodyOf(body, models, hulls));
  const spawned = (json.spawn ?? []).flatMap((entry, i) => spawn(entry, i));
  return { gravity: json.gravity ?? null, border: json.border ?? 'extend', bodies: [...bodies, ...spawned] };
}
