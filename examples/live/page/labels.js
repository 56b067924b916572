// SPDX-License-Identifier: MIT
// The Label tab: adds the shown frame, with the target that the user selects, to a data set.
import { analyze } from "./analysis.js";
import { TargetChoice } from "./choice.js";
import { ask, newestOnly } from "./connection.js";
import { targetOf } from "./drawing.js";

const kStepTimeoutMs = 2000;
const kFields = ["cx", "cy", "semi_major", "semi_minor", "angle_rad"];
const at = (id) => document.getElementById(id);

/**
 * Adds the shown frame to the data set.
 * @param target  Its ellipse, or null if it shows no target.
 * @param pts     The frame's time; the program rejects the label if it shows another frame.
 * @returns the picture's path in the data set.
 */
export async function saveLabel(target, pts) {
  const choice = target === null ? "none" : Object.fromEntries(kFields.map((field) => [field, target[field]]));
  const { image } = await ask("POST", "api/snapshot", { choice, pts_ns: pts });
  return image;
}

export class Labels {
  #choice;
  #pts = null;   // timestamp of the frame that the choices belong to
  #line = null;  // JSON line of that frame
  #saved = 0;
  #isOn = false;

  constructor(screen, playback) {
    Object.assign(this, { screen, playback });
    this.#choice = new TargetChoice(screen, at("label-choices"), at("label-undo"), () => {
      at("label-save").disabled = !playback.source?.can_label || this.#choice.answer() === undefined;
    });
    at("label-save").onclick = () => this.#save();
    screen.canvas.addEventListener("click", (event) => this.#isOn && this.#choice.pick(event));
  }

  async start() {
    this.#isOn = true;
    await this.playback.pause();
    this.screen.canvas.parentElement.classList.add("picks");
    this.screen.view = (context, frame) => this.#choice.draw(context, frame);
    if (!this.playback.source?.can_label) {
      at("label-result").textContent = "No folder for labels: start ellipse-live with --labels FOLDER.";
    }
    this.refresh();
  }

  stop() {
    this.#isOn = false;
    if (this.#choice.isWaiting) this.#pts = null;
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
    this.#choice.wait();
    let others = [];
    try {
      const { candidates } = await analyze();
      others = candidates.filter((each) => each.found && each.ellipse).sort((x, y) => y.score - x.score)
        .map(({ ellipse }) => ellipse);
    } catch {
      // The target in the frame's line is still available.
    }
    if (!this.#isOn) return;
    this.#choice.offer({ pts: frame.pts, target: targetOf(frame.line), others, keepsDrawn: isSame });
  });

  async #save() {
    try {
      const image = await saveLabel(this.#choice.answer(), this.#pts);
      at("label-result").textContent = `${++this.#saved} saved, last: ${image}`;
    } catch (error) {
      at("label-result").textContent = error.message;
      return;
    }
    if (at("label-step").checked) await this.#step();
  }

  async #step() {
    const { pts } = this.screen.frame;
    this.#choice.wait();
    await this.playback.step();
    // At the end of a file there is no next frame.
    setTimeout(() => {
      if (this.#choice.isWaiting && this.screen.frame.pts === pts) this.#choice.show(pts);
    }, kStepTimeoutMs);
  }
}
