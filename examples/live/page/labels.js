// SPDX-License-Identifier: MIT
// The Label tab: the user selects the target, and frame and ellipse are added to a data set.
import { analyze, ellipseText } from "./analysis.js";
import { ask, newestOnly } from "./connection.js";
import { make } from "./controls.js";
import { distanceTo, drawEllipse, drawPicture, targetOf } from "./drawing.js";
import { ellipseThrough, kMinPoints } from "./hand.js";

const kMaxChoices = 12;
const kSamePx = 2;
const kStepTimeoutMs = 2000;
const kFields = ["cx", "cy", "semi_major", "semi_minor", "angle_rad"];
const kOthers = { drawn: true, none: true };
const at = (id) => document.getElementById(id);

export class Labels {
  #choices = [];      // ellipses
  #chosen = null;     // an index, "drawn" or "none"
  #points = [];       // clicked on the edge of a target that was not found
  #pts = null;        // timestamp of the frame that the choices belong to
  #line = null;       // JSON line of that frame
  #saved = 0;
  #isOn = false;
  #isWaiting = false; // for the choices of a new frame

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
      at("label-result").textContent = "No folder for labels: start ellipse-live with --labels FOLDER.";
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

  /** Updates the choices for a new frame, or for a new analysis of it, which keeps a drawn ellipse. */
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
      // The target in the frame's line is still available.
    }
    if (!this.#isOn) return;
    this.#choices = withoutDuplicates([target, ...found].filter(Boolean)).slice(0, kMaxChoices);
    const isDrawn = isSame && this.#chosen === "drawn";
    if (!isSame) this.#points = [];
    if (!isDrawn) this.#chosen = target ? 0 : null;
    this.#list();
    this.screen.draw();
  });

  // Disables the controls: a choice made now would apply to the previous frame or be lost.
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
    const choices = this.#choices.map((e, i) => [String(i), `${i + 1}: ${ellipseText(e)}`]);
    const legend = at("label-choices").querySelector("legend");
    const others = [
      ["drawn", "Drawn: click points along its whole edge"],
      ["none", "None: no target in this frame"],
    ];
    at("label-choices").replaceChildren(legend, ...[...choices, ...others].map(([value, text]) => {
      const radio = make("input", { type: "radio", name: "label", value });
      radio.onchange = () => this.#choose(value in kOthers ? value : Number(value));
      return make("label", { className: "check" }, radio, make("span", {}, text));
    }));
    this.#choose(this.#chosen);
  }

  /** The chosen ellipse; null = no target in the frame, undefined = no choice yet. */
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
    const missing = kMinPoints - this.#points.length;
    at("label-undo").textContent = missing > 0 ? `Undo a point (${missing} more)` : "Undo a point";
    this.screen.draw();
  }

  #pick(event) {
    if (this.#isWaiting) return;
    const { x, y } = this.screen.positionOf(event);
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

  // Draws the choice's number at the right end of its ellipse.
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
      at("label-result").textContent = `${++this.#saved} saved, last: ${image}`;
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
    // At the end of a file there is no next frame.
    setTimeout(() => this.#isWaiting && this.screen.frame.pts === pts && this.#list(), kStepTimeoutMs);
  }
}

function withoutDuplicates(ellipses) {
  return ellipses.filter((e, i) => !ellipses.slice(0, i).some((other) => {
    return ["cx", "cy", "semi_major", "semi_minor"].every((key) => Math.abs(e[key] - other[key]) < kSamePx);
  }));
}
