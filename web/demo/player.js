// The frame clock: asks a source for frames at its pace, and never races after a pause or a hidden tab.
const AWAY_MS = 1000; // without a callback: the tab was hidden

export class Player {
  /** hooks: {advanced(frame), failed(error), wasAway(seconds), timed(ms, periodMs)}. */
  constructor(hooks) {
    this.hooks = hooks;
    this.source = null;
    this.isPaused = false;
    this.isBusy = false;
    this.isStepDue = false;
    this.due = 0;
    this.seen = 0;
    this.shown = 0;
    this.wasHidden = false;
    document.addEventListener('visibilitychange', () => { this.wasHidden ||= document.hidden; });
    requestAnimationFrame((now) => this.#tick(now));
  }

  play(source) {
    this.source = source;
    this.isStepDue = true;
    this.due = performance.now();
  }

  /** Asks for no more frames until the next play: another room is being opened. */
  hold() { this.source = null; }

  setPaused(isPaused) {
    this.isPaused = isPaused;
    this.due = performance.now();
  }

  /** One frame, also while paused. */
  step() { this.isStepDue = true; }

  #tick(now) {
    requestAnimationFrame((next) => this.#tick(next));
    if (this.seen > 0 && now - this.seen > AWAY_MS && this.wasHidden) {
      this.hooks.wasAway((now - this.seen) / 1000);
      this.due = now;
    }
    this.wasHidden = document.hidden;
    this.seen = now;
    this.#ask(now);
  }

  #ask(now) {
    const isDue = this.isStepDue || (!this.isPaused && now >= this.due - 1);
    if (this.source && !this.isBusy && isDue) this.#advance(now);
  }

  async #advance(now) {
    const { source } = this;
    const period = 1000 / source.fps;
    this.isBusy = true;
    this.isStepDue = false;
    this.due = this.due + period > now - period ? this.due + period : now;
    const frame = await this.#next(source);
    this.isBusy = false; // before the next is asked for: there is one at a time
    if (frame && source === this.source) this.#show(frame);
  }

  async #next(source) {
    try {
      await source.prepare();
      return source === this.source ? await source.advance() : null;
    } catch (error) {
      if (source === this.source) this.hooks.failed(error);
      return null;
    }
  }

  /** The next frame is asked for before this one is drawn, where another thread computes it. */
  #show(frame) {
    const now = performance.now();
    if (frame.isFromElsewhere && !document.hidden) this.#ask(now);
    this.hooks.advanced(frame);
    this.hooks.timed(frame.ms, now - this.shown);
    this.shown = now;
  }
}
