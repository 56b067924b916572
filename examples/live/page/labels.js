// SPDX-License-Identifier: MIT
// A person says which ellipse is the target: the frame and the answer become rows of a data set.
import { analyze, placeText } from "./analysis.js";
import { ask, newestOnly } from "./connection.js";
import { make } from "./controls.js";
import { distanceTo, drawEllipse, drawPicture, targetOf } from "./drawing.js";
import { ellipseThrough, kLeastPoints } from "./hand.js";

const kMostChoices = 12;
const kSamePx = 2;
const kPatienceMs = 2000;
const kFields = ["cx", "cy", "semi_major", "semi_minor", "angle_rad"];
const kOthers = { drawn: true, none: true };
const at = (id) => document.getElementById(id);

export class Labels {
  #choices = [];      // ellipses
  #chosen = null;     // a number, "drawn" or "none"
  #points = [];       // clicked on the edge of what no choice tells
  #pts = null;        // of the frame that they are of
  #line = null;       // what was found in it
  #saved = 0;
  #isOn = false;
  #isWaiting = false; // for the choices of another frame

  constructor(screen, playback) {
    Object.assign(this, { screen, playback });
    at("label-save").onclick = () => this.#save();
    at("label-undo").onclick = () => {
      this.#points.pop();
      this.#choose("drawn");
    };
    screen.canvas.addEventListener("click", (event) => this.#isOn && this.#pick(event));
  }

  async start() {
    this.#isOn = true;
    await this.playback.pause();
    this.screen.canvas.parentElement.classList.add("picks");
    this.screen.view = (context, frame) => this.#draw(context, frame);
    if (!this.playback.source?.can_label) {
      at("label-result").textContent = "There is no folder for labels: start ellipse-live with --labels FOLDER.";
    }
    this.refresh();
  }

  stop() {
    this.#isOn = false;
    if (this.#isWaiting) this.#pts = null;
    this.screen.canvas.parentElement.classList.remove("picks");
    this.screen.view = null;
    this.screen.draw();
  }

  /** The choices of another frame, or of another analysis of this one, which keeps what was drawn. */
  refresh = newestOnly(async () => {
    const { frame } = this.screen;
    const isSame = frame?.pts === this.#pts;
    if (!this.#isOn || !frame || (isSame && frame.line === this.#line)) return;
    this.#pts = frame.pts;
    this.#line = frame.line;
    this.#wait();
    const target = targetOf(frame.line);
    let found = [];
    try {
      const { candidates } = await analyze();
      found = candidates.filter((each) => each.found && each.ellipse).sort((a, b) => b.score - a.score)
        .map(({ ellipse }) => ellipse);
    } catch {
      // What the frame's line tells is there all the same.
    }
    if (!this.#isOn) return;
    this.#choices = withoutDoubles([target, ...found].filter(Boolean)).slice(0, kMostChoices);
    const isDrawn = isSame && this.#chosen === "drawn";
    if (!isSame) this.#points = [];
    if (!isDrawn) this.#chosen = target ? 0 : null;
    this.#list();
    this.screen.draw();
  });

  // What is chosen now would be of the frame before, or lost.
  #wait() {
    this.#isWaiting = true;
    at("label-choices").disabled = at("label-save").disabled = at("label-undo").disabled = true;
    delete at("label-choices").dataset.pts;
    this.screen.draw();
  }

  #list() {
    this.#isWaiting = false;
    at("label-choices").disabled = false;
    at("label-choices").dataset.pts = this.#pts;
    const choices = this.#choices.map((e, i) => [String(i), `${i + 1}: ${placeText(e)}`]);
    const legend = at("label-choices").querySelector("legend");
    const others = [
      ["drawn", "Drawn: click points all along its edge"],
      ["none", "None: no target in this frame"],
    ];
    at("label-choices").replaceChildren(legend, ...[...choices, ...others].map(([value, text]) => {
      const radio = make("input", { type: "radio", name: "label", value });
      radio.onchange = () => this.#choose(value in kOthers ? value : Number(value));
      return make("label", { className: "check" }, radio, make("span", {}, text));
    }));
    this.#choose(this.#chosen);
  }

  /** The ellipse that is chosen; null = none of them, undefined = nothing is chosen yet. */
  #answer() {
    if (this.#chosen === "none") return null;
    if (this.#chosen === "drawn") return ellipseThrough(this.#points) ?? undefined;
    return this.#choices[this.#chosen];
  }

  #choose(choice) {
    this.#chosen = choice;
    for (const radio of at("label-choices").querySelectorAll("input")) {
      radio.checked = radio.value === String(choice);
    }
    at("label-save").disabled = !this.playback.source?.can_label || this.#answer() === undefined;
    at("label-undo").hidden = choice !== "drawn";
    at("label-undo").disabled = this.#points.length === 0;
    const missing = kLeastPoints - this.#points.length;
    at("label-undo").textContent = missing > 0 ? `Undo a point (${missing} more)` : "Undo a point";
    this.screen.draw();
  }

  #pick(event) {
    if (this.#isWaiting) return;
    const { x, y } = this.screen.placeOf(event);
    if (this.#chosen === "drawn") {
      this.#points.push({ x, y });
      this.#choose("drawn");
      return;
    }
    const distances = this.#choices.map((e) => distanceTo(e, x, y));
    const nearest = distances.indexOf(Math.min(...distances));
    if (nearest >= 0) this.#choose(nearest);
  }

  #draw(context, { bitmap }) {
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

  // At the right end of the ellipse.
  #number(context, e, i, isChosen) {
    const unit = context.lineWidth * (isChosen ? 1 / 1.5 : 1 / 0.7) / 2;
    const x = e.cx + Math.hypot(e.semi_major * Math.cos(e.angle_rad), e.semi_minor * Math.sin(e.angle_rad));
    context.font = `600 ${13 * unit}px system-ui, "DejaVu Sans", sans-serif`;
    context.lineWidth = 3 * unit;
    context.setLineDash([]);
    context.strokeStyle = "rgb(0 0 0 / .8)";
    context.fillStyle = isChosen ? "#4ade9c" : "#ffc85c";
    context.strokeText(i + 1, x + 6 * unit, e.cy + 4 * unit);
    context.fillText(i + 1, x + 6 * unit, e.cy + 4 * unit);
  }

  async #save() {
    const e = this.#answer();
    const choice = e === null ? "none"
      : Object.fromEntries(kFields.map((field) => [field, e[field]]));
    try {
      const { image } = await ask("POST", "api/snapshot", { choice, pts_ns: this.#pts });
      at("label-result").textContent = `${++this.#saved} saved, the last as ${image}`;
    } catch (error) {
      at("label-result").textContent = error.message;
      return;
    }
    if (at("label-step").checked) await this.#step();
  }

  async #step() {
    const { pts } = this.screen.frame;
    this.#wait();
    await this.playback.step();
    // At the end of a file there is no other one.
    setTimeout(() => this.#isWaiting && this.screen.frame.pts === pts && this.#list(), kPatienceMs);
  }
}

function withoutDoubles(ellipses) {
  return ellipses.filter((e, i) => !ellipses.slice(0, i).some((other) => {
    return ["cx", "cy", "semi_major", "semi_minor"].every((key) => Math.abs(e[key] - other[key]) < kSamePx);
  }));
}
