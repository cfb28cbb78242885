// The panel: fills its lists, and tells what was chosen.
const VIEW_WORDS = { camera: 'Camera', depth: 'Depth', normals: 'Normals', mesh: 'Mesh', regions: 'Regions',
  foreground: 'Foreground', background: 'Background', velocity: 'Velocity', thickness: 'Thickness', reason: 'Missing depth',
  points: 'Points, from anywhere', contacts: 'Contacts', hands: 'Hands' };
export const VIEW_NAMES = Object.keys(VIEW_WORDS);

export const $ = (id) => document.getElementById(id);

function fill(select, entries) {
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
}

/** A slider whose output shows its value. */
function bindSlider(id, onInput = () => {}) {
  const input = $(id), output = document.querySelector(`output[for="${id}"]`);
  const show = () => { output.textContent = `${Number(input.value)}${input.dataset.unit ?? ''}`; };
  input.addEventListener('input', () => { show(); onInput(Number(input.value)); });
  show();
  return { get value() { return Number(input.value); }, set(value) { input.value = value; show(); } };
}

/** A scene in a clip beside the page: the page of one file has none. */
export const clipOf = ({ source = '' }) => (source.startsWith('clips/') ? `${source}.zip` : null);

/** hooks: {scene(name), view(name), gravity(value)}. Returns what a throw is made of, and setters. */
export function bindPanel(scenes, hooks) {
  const names = Object.keys(scenes).filter((name) => !$('wasm') || clipOf(scenes[name]) === null);
  fill($('scene'), names.map((name) => [name, name[0].toUpperCase() + name.slice(1).replaceAll('_', ' ')]));
  fill($('view'), Object.entries(VIEW_WORDS));
  $('scene').addEventListener('change', () => hooks.scene($('scene').value));
  $('view').addEventListener('change', () => hooks.view($('view').value));
  const size = bindSlider('size'), restitution = bindSlider('restitution'), friction = bindSlider('friction');
  const gravity = bindSlider('gravity', hooks.gravity);
  const kinds = [...document.querySelectorAll('input[name="kind"]')];
  return {
    gravity,
    throwOptions: () => ({ kind: kinds.find((k) => k.checked).value, size: size.value, restitution: restitution.value,
      friction: friction.value }),
    nextShape() {
      const next = kinds[(kinds.findIndex((k) => k.checked) + 1) % kinds.length];
      next.checked = true;
      return next.value;
    },
  };
}
