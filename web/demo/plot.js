// Milliseconds of the last frames as bars, with a line where 30 frames a second end.
const BARS = 140, LINE_MS = 1000 / 30, TOP_MS = 2 * LINE_MS;

export class Plot {
  constructor(canvas, text) {
    this.canvas = canvas;
    this.text = text;
    this.times = [];
  }

  /** One frame: milliseconds of computing, and since the frame before it. */
  add(ms, periodMs) {
    this.times.push([ms, periodMs]);
    if (this.times.length > BARS) this.times.shift();
  }

  median(which) {
    const sorted = this.times.map((t) => t[which]).sort((a, b) => a - b);
    return sorted.length > 0 ? sorted[sorted.length >> 1] : 0;
  }

  draw() {
    const { canvas } = this;
    const context = canvas.getContext('2d');
    const style = getComputedStyle(canvas);
    const width = canvas.width / BARS;
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.fillStyle = style.getPropertyValue('--accent');
    this.times.forEach(([ms], i) => {
      const height = Math.min(1, ms / TOP_MS) * canvas.height;
      context.fillRect(i * width, canvas.height - height, Math.max(1, width - 0.5), height);
    });
    context.fillStyle = style.getPropertyValue('--soft');
    context.fillRect(0, Math.round(canvas.height * (1 - LINE_MS / TOP_MS)), canvas.width, 1);
    const ms = this.median(0).toFixed(1), fps = (1000 / Math.max(1, this.median(1))).toFixed(0);
    this.text.textContent = `${ms} ms a frame, ${fps} frames a second. The line: 33 ms.`;
    return `${ms} ms · ${fps} fps`;
  }
}
