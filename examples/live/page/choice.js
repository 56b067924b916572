// SPDX-License-Identifier: MIT
// Choice of a frame's target: from a list, by a click on the picture, drawn by points on the edge, or none.
import { ellipseText } from "./analysis.js";
import { make } from "./controls.js";
import { distanceTo, drawEllipse, drawPicture } from "./drawing.js";
import { ellipseThrough, kMinPoints } from "./hand.js";

const kMaxChoices = 12;
const kSamePx = 2;
const kOthers = { drawn: true, none: true };

export class TargetChoice {
  #choices = [];       // ellipses
  #chosen = null;      // an index, "drawn" or "none"
  #points = [];        // clicked on the edge of a target that was not found
  #isWaiting = true;   // for the choices of a frame

  /**
   * @param list      The <fieldset> for the choices.
   * @param undo      The button that removes the last point.
   * @param onChange  Called when answer() may have changed.
   */
  constructor(screen, list, undo, onChange) {
    Object.assign(this, { screen, list, undo, onChange });
    undo.onclick = () => {
      this.#points.pop();
      this.#choose("drawn");
    };
  }

  get isWaiting() {
    return this.#isWaiting;
  }

  /** The chosen ellipse; null = no target in the frame, undefined = no choice yet. */
  answer() {
    if (this.#isWaiting) return undefined;
    if (this.#chosen === "none") return null;
    if (this.#chosen === "drawn") return ellipseThrough(this.#points) ?? undefined;
    return this.#choices[this.#chosen];
  }

  /** Disables the controls: a choice made now would apply to the previous frame or be lost. */
  wait() {
    this.#isWaiting = true;
    this.list.disabled = this.undo.disabled = true;
    delete this.list.dataset.pts;
    this.onChange();
    this.screen.draw();
  }

  /**
   * Offers the ellipses of a frame.
   * @param target       The frame's target, which is chosen at first, or undefined.
   * @param others       Other ellipses.
   * @param keepsDrawn   Whether an ellipse that is being drawn also applies to this frame.
   */
  offer({ pts, target, others, keepsDrawn }) {
    this.#choices = withoutDuplicates([target, ...others].filter(Boolean)).slice(0, kMaxChoices);
    if (!keepsDrawn) this.#points = [];
    if (!keepsDrawn || this.#chosen !== "drawn") this.#chosen = target ? 0 : null;
    this.show(pts);
  }

  /** Enables the controls for the frame of this time. */
  show(pts) {
    this.#isWaiting = false;
    this.list.disabled = false;
    this.list.dataset.pts = pts;
    const choices = this.#choices.map((e, i) => [String(i), `${i + 1}: ${ellipseText(e)}`]);
    const others = [
      ["drawn", "Drawn: click points along its whole edge"],
      ["none", "None: no target in this frame"],
    ];
    const legend = this.list.querySelector("legend");
    this.list.replaceChildren(legend, ...[...choices, ...others].map(([value, text]) => {
      const radio = make("input", { type: "radio", name: this.list.id, value });
      radio.onchange = () => this.#choose(value in kOthers ? value : Number(value));
      return make("label", { className: "check" }, radio, make("span", {}, text));
    }));
    this.#choose(this.#chosen);
  }

  #choose(choice) {
    this.#chosen = choice;
    for (const radio of this.list.querySelectorAll("input")) {
      radio.checked = radio.value === String(choice);
    }
    this.undo.hidden = choice !== "drawn";
    this.undo.disabled = this.#points.length === 0;
    const missing = kMinPoints - this.#points.length;
    this.undo.textContent = missing > 0 ? `Undo a point (${missing} more)` : "Undo a point";
    this.onChange();
    this.screen.draw();
  }

  /** Takes a click on the picture. */
  pick(event) {
    if (this.#isWaiting) return;
    const { x, y } = this.screen.picturePoint(event);
    if (this.#chosen === "drawn") {
      this.#points.push({ x, y });
      this.#choose("drawn");
      return;
    }
    const distances = this.#choices.map((e) => distanceTo(e, x, y));
    const nearest = distances.indexOf(Math.min(...distances));
    if (nearest >= 0) this.#choose(nearest);
  }

  /** Draws the frame with the choices. */
  draw(context, { bitmap }) {
    drawPicture(context, bitmap, bitmap.width, bitmap.height);
    if (this.#isWaiting) return;
    const width = context.lineWidth;
    this.#choices.forEach((e, i) => {
      const isChosen = i === this.#chosen;
      context.lineWidth = isChosen ? 1.5 * width : 0.7 * width;
      drawEllipse(context, e, isChosen ? "tracked" : "candidate", { ellipse: true, centre: isChosen });
      this.#number(context, e, i, isChosen);
    });
    context.lineWidth = width;
    if (this.#chosen === "drawn") this.#drawByHand(context);
  }

  #drawByHand(context) {
    const e = ellipseThrough(this.#points);
    if (e) drawEllipse(context, e, "tracked", { ellipse: true, centre: true });
    context.fillStyle = "#ffffff";
    for (const { x, y } of this.#points) {
      context.beginPath();
      context.arc(x, y, 1.5 * context.lineWidth, 0, 2 * Math.PI);
      context.fill();
    }
  }

  // Draws the choice's number beside its ellipse, on alternating sides because rings are concentric.
  #number(context, e, i, isChosen) {
    const unit = context.lineWidth * (isChosen ? 1 / 1.5 : 1 / 0.7) / 2;
    const wide = Math.hypot(e.semi_major * Math.cos(e.angle_rad), e.semi_minor * Math.sin(e.angle_rad));
    const isLeft = i % 2 === 1;
    const x = isLeft ? e.cx - wide - 6 * unit : e.cx + wide + 6 * unit;
    context.textAlign = isLeft ? "right" : "left";
    context.font = `600 ${13 * unit}px system-ui, "DejaVu Sans", sans-serif`;
    context.lineWidth = 3 * unit;
    context.setLineDash([]);
    context.strokeStyle = "rgb(0 0 0 / .8)";
    context.fillStyle = isChosen ? "#4ade9c" : "#ffc85c";
    context.strokeText(i + 1, x, e.cy + 4 * unit);
    context.fillText(i + 1, x, e.cy + 4 * unit);
  }
}

function withoutDuplicates(ellipses) {
  return ellipses.filter((e, i) => !ellipses.slice(0, i).some((other) => {
    return ["cx", "cy", "semi_major", "semi_minor"].every((key) => Math.abs(e[key] - other[key]) < kSamePx);
  }));
}
