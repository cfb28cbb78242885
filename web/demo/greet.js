// The first half minute: whoever only watches sees balls thrown at the visitor of the room. The first act of one's own ends it.
const EVERY_MS = 2500, THROWS = 8;
const ACTS = ['pointerdown', 'keydown', 'change', 'drop'];

/** Where in the picture the middle of who moves is, as shares; null: nobody is in view. */
async function visitorOnPicture(relief) {
  const [front, depth, rayX, rayY] = await relief.do(['foreground', 'depth', 'rayX', 'rayY'].map((name) => ['plane', name]));
  if (!front) return null;
  let count = 0, x = 0, y = 0;
  for (let i = 0; i < front.length; i++) {
    if (!front[i] || !(depth[i] > 0)) continue;
    count++;
    x += rayX[i];
    y += rayY[i];
  }
  if (count < front.length / 200) return null;
  const focal = 1081 / 1920; // of the room's colour camera, in widths of its picture
  return [0.5 + focal * x / count, 0.5 + focal * 16 / 9 * y / count];
}

/** `throwBody(x, y)`: at shares of the picture. `isOn()`: whether the room is the one that the page began with. */
export function greet(relief, { throwBody, isOn, say }) {
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) return;
  let left = THROWS;
  const timer = setInterval(async () => {
    if (document.hidden || !isOn()) return;
    const place = await visitorOnPicture(relief);
    if (place === null || left <= 0) return;
    if (left === THROWS) say('Your turn: click into the picture to throw.');
    throwBody(...place);
    if (--left === 0) stop();
  }, EVERY_MS);
  const stop = () => {
    left = 0;
    clearInterval(timer);
    for (const act of ACTS) document.removeEventListener(act, stop, true);
  };
  for (const act of ACTS) document.addEventListener(act, stop, true);
}
