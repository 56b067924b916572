// SPDX-License-Identifier: MIT
// The status bar, the notice over the picture, and announcements for screen readers.
import { targetOf } from "./drawing.js";

const kNoticeMs = 3500;
const kTexts = {
  tracked: "tracked",
  detected: "detected",
  predicted: "predicted",
  lost: "lost",
  none: "no target",
};
const at = (id) => document.getElementById(id);

export class Status {
  #state = null;
  #hadTarget = false;
  #times = [];   // arrival times of lines
  #shown = [];   // times of painted pictures
  #trouble = "";
  #timer = 0;

  /** Shows a notice for a few seconds. */
  notify = (text) => {
    clearTimeout(this.#timer);
    this.#notice(text, false);
    this.#timer = setTimeout(() => this.#notice(this.#trouble, true), kNoticeMs);
  };

  /** Shows an error until it is set to "". */
  setTrouble(text) {
    if (text === this.#trouble) return;
    this.#trouble = text;
    clearTimeout(this.#timer);
    this.#notice(text, true);
  }

  takeLine(line) {
    rate(this.#times);
    const target = targetOf(line);
    this.#setState(target?.state ?? (this.#hadTarget ? "lost" : "none"));
    if (target) this.#hadTarget = true;
    if (line.processing_ns !== undefined) {
      at("figure-time").textContent = `${(line.processing_ns / 1e6).toFixed(2)} ms`;
    }
    at("figure-rate").textContent = rateText(this.#times);
    at("figure-tracker").textContent = line.tracker ?? "–";
  }

  /** Counts a painted picture. */
  takeFrame() {
    rate(this.#shown);
    at("figure-shown").textContent = rateText(this.#shown);
  }

  #setState(state) {
    if (state === this.#state) return;
    this.#state = state;
    at("state").dataset.state = state;
    at("state-text").textContent = kTexts[state];
    at("announcer").textContent = `Target: ${kTexts[state]}`;
  }

  #notice(text, isTrouble) {
    const notice = at("notice");
    notice.textContent = text;
    notice.classList.toggle("trouble", isTrouble && text !== "");
  }
}

// Adds an event and drops those older than a second.
function rate(times) {
  const now = performance.now();
  times.push(now);
  while (times.length > 2 && times[0] < now - 1000) times.shift();
}

function rateText(times) {
  const span = times.at(-1) - times[0];
  // Some browsers limit the clock's resolution to 100 ms.
  return span > 0 ? (1000 * (times.length - 1) / span).toFixed(0) : "–";
}
