// SPDX-License-Identifier: MIT
// The search region, drawn on the picture with a mouse or pen; touch scrolls the page. The settings
// roi and roi-source do the same by keyboard.
import { drawRegion } from "./drawing.js";

const kMinPx = 8;  // screen pixels; a shorter drag is a click
const kNone = [0, 0, 0, 0];

export class Region {
  /** Whether dragging draws a region; other views use the pointer themselves. */
  isOn = true;
  #start = null;  // {x, y} in the frame where the drag began
  #dragged = null;  // [x, y, width, height] during the drag

  constructor(screen, settings, notify) {
    Object.assign(this, { screen, settings, notify });
    const { canvas } = screen;
    canvas.addEventListener("pointerdown", (event) => this.#begin(event));
    canvas.addEventListener("pointermove", (event) => this.#drag(event));
    canvas.addEventListener("pointerup", () => this.#end());
    canvas.addEventListener("pointercancel", () => this.#cancel());
    canvas.addEventListener("dblclick", () => this.#clear());
    canvas.addEventListener("keydown", ({ key }) => {
      if (key !== "Escape") return;
      if (this.#start) this.#cancel();
      else this.#clear();
    });
    screen.overlay = (context) => this.#draw(context);
  }

  #begin(event) {
    const isDrawing = event.pointerType !== "touch" && event.button === 0;
    if (!this.isOn || !isDrawing || !this.screen.frame) return;
    this.#start = this.screen.picturePoint(event);
    this.screen.canvas.setPointerCapture(event.pointerId);
  }

  #drag(event) {
    if (!this.#start) return;
    const { bitmap } = this.screen.frame;
    const end = this.screen.picturePoint(event);
    const px = bitmap.width / this.screen.canvas.clientWidth;
    const isLong = Math.max(Math.abs(end.x - this.#start.x), Math.abs(end.y - this.#start.y)) > kMinPx * px;
    if (isLong || this.#dragged) this.#dragged = rectOf(this.#start, end, bitmap);
    this.screen.draw();
  }

  #end() {
    const roi = this.#dragged;
    this.#cancel();
    if (!roi) return;
    this.settings.set({ roi, "roi-source": "property" });
    this.screen.draw();
    this.notify(`Search region: ${roi[2]} × ${roi[3]} px; Escape or a double click removes it`);
  }

  #cancel() {
    this.#start = this.#dragged = null;
    this.screen.draw();
  }

  #clear() {
    if (!this.isOn || !this.#chosen()) return;
    this.settings.set({ roi: kNone, "roi-source": "none" });
    this.screen.draw();
    this.notify("Search region removed");
  }

  /** The region in force, or null. */
  #chosen() {
    const { roi, "roi-source": source } = this.settings.values();
    return source === "property" && roi[2] > 0 ? roi : null;
  }

  #draw(context) {
    const roi = this.#dragged ?? (this.screen.layers.region && this.#chosen());
    if (roi) drawRegion(context, roi, "chosen");
  }
}

// The rectangle of whole pixels between two points, clipped to the frame.
function rectOf(a, b, { width, height }) {
  const span = (one, other, size) => {
    const low = Math.max(0, Math.floor(Math.min(one, other) + 0.5));
    const high = Math.min(size, Math.ceil(Math.max(one, other) + 0.5));
    const from = Math.min(low, size - 1);
    return [from, Math.max(1, high - from)];
  };
  const [x, w] = span(a.x, b.x, width);
  const [y, h] = span(a.y, b.y, height);
  return [x, y, w, h];
}
