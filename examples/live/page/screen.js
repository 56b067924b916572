// SPDX-License-Identifier: MIT
// Shows the current frame with its metadata, or the view of another tab.
import { contextOf, drawPicture, drawTargets } from "./drawing.js";

const kLayers = {
  ellipse: "Ellipse",
  axes: "Axes",
  centre: "Centre",
  region: "Region",
  candidates: "Candidates",
  truth: "Truth",
};

export class Screen {
  /** Which layers are on. */
  layers = { ellipse: true, axes: true, centre: true, region: true, candidates: true, truth: false };
  /** The shown frame, {pts, bitmap, line}; null before the first one. */
  frame = null;
  /** Replaces the drawing of frame and metadata if set: (context, frame) => void. */
  view = null;
  /** Draws over the frame and its metadata: (context) => void. */
  overlay = () => {};
  #aspect = 0;  // width / height of the video

  constructor(canvas, layerList) {
    this.canvas = canvas;
    this.shown = 0;
    this.isClear = false;  // all layers hidden
    for (const [name, title] of Object.entries(kLayers)) {
      layerList.append(this.#toggle(name, title));
    }
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  show(frame) {
    const { width, height } = frame.bitmap;
    if (width / height !== this.#aspect) {
      this.#aspect = width / height;
      // Used by the style sheet for the layout.
      this.canvas.closest("main").style.setProperty("--aspect", String(this.#aspect));
    }
    if (this.frame && this.frame.bitmap !== frame.bitmap) this.frame.bitmap.close?.();
    this.frame = frame;
    ++this.shown;
    this.draw();
  }

  draw() {
    if (!this.frame) return;
    const { bitmap, line, pts } = this.frame;
    const context = contextOf(this.canvas, bitmap.width, bitmap.height);
    if (this.view) {
      this.view(context, this.frame);
    } else {
      drawPicture(context, bitmap, bitmap.width, bitmap.height);
      if (!this.isClear) {
        drawTargets(context, line, this.layers);
        this.overlay(context);
      }
    }
    this.canvas.dataset.pts = pts;
    this.canvas.dataset.shown = this.shown;
  }

  /** Hides or shows all layers. */
  toggleAll() {
    this.isClear = !this.isClear;
    this.draw();
  }

  /** The position of a pointer event [frame px]. */
  picturePoint(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const { bitmap } = this.frame;
    return {
      x: (event.clientX - left) / width * bitmap.width - 0.5,
      y: (event.clientY - top) / height * bitmap.height - 0.5,
    };
  }

  #toggle(name, title) {
    const button = document.createElement("button");
    button.className = "toggle";
    button.textContent = title;
    button.dataset.layer = name;
    button.setAttribute("aria-pressed", this.layers[name]);
    button.onclick = () => {
      this.layers[name] = !this.layers[name];
      button.setAttribute("aria-pressed", this.layers[name]);
      this.draw();
    };
    return button;
  }
}
