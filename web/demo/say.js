// What the page tells: one line over the picture, read aloud by screen readers.
const STAYS_MS = 6000, BAD_STAYS_MS = 12000;

export function makeSay(element) {
  let timer = 0;
  const show = (text, isBad) => {
    clearTimeout(timer);
    element.textContent = text;
    element.classList.toggle('bad', isBad);
    timer = setTimeout(() => { element.textContent = ''; }, isBad ? BAD_STAYS_MS : STAYS_MS);
  };
  return {
    say: (text) => show(text, false),
    /** An error; the page goes on. */
    fail: (error) => show(String(error?.message ?? error).replace(/^relief: /, ''), true),
  };
}
