// The page's way into AR: its button is shown only where this browser offers AR with depth.
import { arSupport, enterAr } from '../relief/xr.js';

const teller = (to) => (typeof to === 'function' ? to : (words) => { to.textContent = words; });

/** `button` starts AR; `status` tells what happens, and `reason` why AR is not offered: each an element, or a function of
 * words. `relief` gives a module of AR's own, or is one. Resolves to whether AR is offered. */
export async function offerAr({ button, status, reason = status, relief, ...options }) {
  const say = teller(status);
  const { isOffered, why } = await arSupport(options.xr);
  button.hidden = !isOffered;
  if (!isOffered) {
    teller(reason)(`No AR: ${why}.`);
    return false;
  }
  button.addEventListener('click', async () => {
    button.disabled = true;
    try {
      const tell = (kind, words) => { if (words !== '') say(words); };
      const ar = await enterAr(relief, { ...options, tell });
      say(await ar.ended);
    } catch (error) {
      say(error.message);
    } finally {
      button.disabled = false;
    }
  });
  return true;
}
