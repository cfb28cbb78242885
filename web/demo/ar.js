// The page's way into AR: its button is shown only where this browser offers AR with depth.
import { arSupport, enterAr } from '../relief/xr.js';

/** `button` starts AR; `status` tells what happens: an element, or a function of words; `relief` gives a module of AR's
 * own, or is one. Resolves to whether AR is offered. */
export async function offerAr({ button, status, relief, ...options }) {
  const say = typeof status === 'function' ? status : (words) => { status.textContent = words; };
  const { isOffered, why } = await arSupport(options.xr);
  button.hidden = !isOffered;
  if (!isOffered) {
    say(`No AR: ${why}.`);
    return false;
  }
  button.addEventListener('click', async () => {
    button.disabled = true;
    try {
      const module = typeof relief === 'function' ? await relief() : relief;
      const tell = (kind, words) => { if (words !== '') say(words); };
      const ar = await enterAr(module, { ...options, tell });
      say(await ar.ended);
    } catch (error) {
      say(error.message);
    } finally {
      button.disabled = false;
    }
  });
  return true;
}
