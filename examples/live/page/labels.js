// SPDX-License-Identifier: MIT
// A person says which ellipse is the target: the frame and the answer become rows of a data set.
import { analyze, placeText } from "./analysis.js";
import { ask, newestOnly } from "./connection.js";
import { make } from "./controls.js";
import { distanceTo, drawEllipse, drawPicture, targetOf } from "./drawing.js";

const kMostChoices = 12;
const kSamePx = 2;
const at = (id) => document.getElementById(id);

export class Labels {
  #choices = [];      // ellipses
  #chosen = null;     // a number, or "none"
  #pts = null;        // of the frame that they are of
  #saved = 0;
  #isOn = false;

  constructor(screen, playback) {
    Object.assign(this, { screen, playback });
    at("label-save").onclick = () => this.#save();
    screen.canvas.addEventListener("pointerdown", (event) => this.#isOn && this.#pick(event));
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
    this.screen.canvas.parentElement.classList.remove("picks");
    this.screen.view = null;
    this.screen.draw();
  }

  /** The choices of another frame. */
  refresh = newestOnly(async () => {
    const { frame } = this.screen;
    if (!this.#isOn || !frame || frame.pts === this.#pts) return;
    this.#pts = frame.pts;
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
    this.#chosen = target ? 0 : null;
    this.#list();
    this.screen.draw();
  });

  #list() {
    const choices = this.#choices.map((e, i) => [String(i), `${i + 1}: ${placeText(e)}`]);
    const legend = at("label-choices").querySelector("legend");
    at("label-choices").replaceChildren(legend, ...[...choices, ["none", "None: no target in this frame"]]
      .map(([value, text]) => {
        const radio = make("input", { type: "radio", name: "label", value, checked: value === String(this.#chosen) });
        radio.onchange = () => this.#choose(value === "none" ? value : Number(value));
        return make("label", { className: "check" }, radio, make("span", {}, text));
      }));
    at("label-save").disabled = this.#chosen === null || !this.playback.source?.can_label;
  }

  #choose(choice) {
    this.#chosen = choice;
    for (const radio of at("label-choices").querySelectorAll("input")) {
      radio.checked = radio.value === String(choice);
    }
    at("label-save").disabled = !this.playback.source?.can_label;
    this.screen.draw();
  }

  #pick(event) {
    const { x, y } = this.screen.placeOf(event);
    const distances = this.#choices.map((e) => distanceTo(e, x, y));
    const nearest = distances.indexOf(Math.min(...distances));
    if (nearest >= 0) this.#choose(nearest);
  }

  #draw(context, { bitmap }) {
    drawPicture(context, bitmap, bitmap.width, bitmap.height);
    const width = context.lineWidth;
    this.#choices.forEach((e, i) => {
      const isChosen = i === this.#chosen;
      context.lineWidth = isChosen ? 1.5 * width : 0.7 * width;
      drawEllipse(context, e, isChosen ? "tracked" : "candidate", { ellipse: true, centre: isChosen });
      this.#number(context, e, i, isChosen);
    });
    context.lineWidth = width;
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
    const { frame } = this.screen;
    const isNone = this.#chosen === "none";
    const { cx, cy, semi_major, semi_minor, angle_rad } = isNone ? {} : this.#choices[this.#chosen];
    const choice = isNone ? "none" : { cx, cy, semi_major, semi_minor, angle_rad };
    try {
      const { image } = await ask("POST", "api/snapshot", { choice, pts_ns: Number(frame.pts) });
      at("label-result").textContent = `${++this.#saved} saved, the last as ${image}`;
    } catch (error) {
      at("label-result").textContent = error.message;
      return;
    }
    if (at("label-step").checked) await this.playback.step();
  }
}

function withoutDoubles(ellipses) {
  return ellipses.filter((e, i) => !ellipses.slice(0, i).some((other) => {
    return ["cx", "cy", "semi_major", "semi_minor"].every((key) => Math.abs(e[key] - other[key]) < kSamePx);
  }));
}
