// Keys, as the window has them. A control that has the focus keeps the keys that it needs.
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function ownsKeys(target, key) {
  if (/^(SELECT|TEXTAREA)$/.test(target.tagName)) return true;
  if (target.tagName === 'INPUT') return true;
  return /^(BUTTON|SUMMARY|A)$/.test(target.tagName) && (key === ' ' || key === 'Enter');
}

/** acts: {pause, step, reset, throwBody, nextShape, nextView, chooseView(i), remove, aim(x, y)}. */
export function listenToKeys(stage, acts) {
  const table = { ' ': acts.pause, n: acts.step, '.': acts.step, r: acts.reset, t: acts.throwBody, g: acts.nextShape,
    v: acts.nextView, Delete: acts.remove, Backspace: acts.remove };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || ownsKeys(event.target, event.key)) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const isOnStage = event.target === stage;
    let act = table[key];
    if (isOnStage && ARROWS[key]) act = () => acts.aim(...ARROWS[key]);
    if (isOnStage && key === 'Enter') act = acts.throwBody;
    if (/^[0-9]$/.test(key)) act = () => acts.chooseView(key === '0' ? 9 : Number(key) - 1);
    if (!act) return;
    event.preventDefault();
    act();
  });
}
