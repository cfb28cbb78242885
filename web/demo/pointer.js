// Mouse, pen and finger on the picture: throw, hold, bring nearer, turn; and an aim for the keyboard.
const DRAG_PX = 8, AIM_STEP = 0.02, TURN = Math.PI;

export class Pointer {
  /** hooks: {relief, screen, thrown(u, v, drag), isElsewhere(), turned(x, y, zoom)}. */
  constructor(stage, aim, hooks) {
    this.stage = stage;
    this.mark = aim;
    this.hooks = hooks;
    this.aim = [0.5, 0.5];
    this.press = null;
    stage.addEventListener('pointerdown', (event) => this.#down(event));
    stage.addEventListener('pointermove', (event) => this.#move(event));
    stage.addEventListener('pointerup', (event) => this.#up(event));
    stage.addEventListener('pointercancel', () => this.#end());
    stage.addEventListener('contextmenu', (event) => event.preventDefault());
    stage.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
    stage.addEventListener('blur', () => { aim.hidden = true; });
  }

  /** Shares of the picture to its pixels. */
  pixel([x, y]) {
    const { width, height } = this.hooks.screen.canvas;
    return [x * width - 0.5, y * height - 0.5];
  }

  #place(event) {
    const box = this.stage.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  }

  #down(event) {
    this.stage.setPointerCapture(event.pointerId);
    this.mark.hidden = true;
    this.aim = this.#place(event);
    const isTurn = event.button === 2 || this.hooks.isElsewhere();
    const at = [event.clientX, event.clientY];
    this.press = { at, last: at, from: this.aim, place: this.aim, isTurn, isHeld: false, button: event.button };
    if (!isTurn && event.button === 0) this.press.asked = this.#grab(this.press);
  }

  /** Whether there was a body to hold is known a little later: it follows then to where the pointer is by now. */
  async #grab(press) {
    press.isHeld = await this.hooks.relief.call('grab', ...this.pixel(press.from));
    if (!press.isHeld || this.press !== press) return;
    this.stage.classList.add('held');
    if (press.place !== press.from) this.#carry(press);
  }

  #carry({ place }) { this.hooks.relief.call('drag', ...this.pixel(place)); }

  async #look(event) {
    if (event.pointerType !== 'mouse' || this.isLooking) return;
    this.isLooking = true;
    const isOver = await this.hooks.relief.call('hasBodyAt', ...this.pixel(this.aim));
    this.stage.classList.toggle('over', isOver);
    this.isLooking = false;
  }

  #move(event) {
    const place = this.#place(event);
    if (!this.press) {
      this.aim = place;
      this.#look(event);
    } else if (this.press.asked) {
      this.press.place = place;
      if (this.press.isHeld) this.#carry(this.press);
    } else if (this.press.isTurn) {
      const { height } = this.stage.getBoundingClientRect();
      const [x, y] = this.press.last;
      this.hooks.turned(TURN * (event.clientX - x) / height, TURN * (event.clientY - y) / height, 0);
      this.press.last = [event.clientX, event.clientY];
    }
  }

  async #up(event) {
    const { press } = this;
    this.#end();
    if (!press?.asked || await press.asked.then(() => press.isHeld)) return;
    const way = Math.hypot(event.clientX - press.at[0], event.clientY - press.at[1]);
    const drag = way < DRAG_PX ? 0 : way / this.stage.getBoundingClientRect().height;
    this.hooks.thrown(...this.pixel(press.from), drag);
  }

  #end() {
    this.hooks.relief.call('release');
    this.press = null;
    this.stage.classList.remove('held');
  }

  #wheel(event) {
    const steps = -Math.sign(event.deltaY);
    if (this.press?.isHeld) this.hooks.relief.call('reach', steps);
    else if (this.hooks.isElsewhere()) this.hooks.turned(0, 0, steps);
    else return;
    event.preventDefault();
  }

  /** The keyboard's arrows. */
  moveAim(x, y) {
    const clamp = (v) => Math.min(1, Math.max(0, v));
    this.aim = [clamp(this.aim[0] + AIM_STEP * x), clamp(this.aim[1] + AIM_STEP * y)];
    this.mark.hidden = false;
    this.mark.style.left = `${100 * this.aim[0]}%`;
    this.mark.style.top = `${100 * this.aim[1]}%`;
  }
}
