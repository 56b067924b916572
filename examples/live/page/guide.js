// SPDX-License-Identifier: MIT
// The guide: shows what is found, lets the user mark the target in three stored frames, and proposes
// settings that find it.
import { analyze } from "./analysis.js";
import { TargetChoice } from "./choice.js";
import { newestOnly } from "./connection.js";
import { drawEllipse, drawPicture } from "./drawing.js";
import { hideTrouble, showStep, showTrouble } from "./guide_panel.js";
import { showProposal, sourceText, storedText, troubleText } from "./guide_text.js";
import { discardFrames, showStored, storedFrames, storeFrames } from "./history.js";
import { saveLabel } from "./labels.js";
import { propose } from "./proposal.js";

const kSeenKey = "ellipse-live-guide";
const kMarks = 3;
const kMinStored = 60;    // for distinct marked frames; fewer if the memory is full or the source is paused
const kPollMs = 700;
const kKeepMs = 60_000;   // the program discards frames that are unused for ten minutes
const kGone = 410;
// Relaxed settings, which also find ellipses that the current ones reject.
const kWide = {
  "min-axis": 5,
  "max-axis": 32768,
  "max-axis-ratio": 10,
  "min-contour-size": 20,
  "edge-low": 0,
  "edge-high": 0,
};
const kWideSearches = [
  { ...kWide, detector: "arcs", "min-probability": 0.05 },
  { ...kWide, detector: "contours", "detect-contour-overlap": 0.8, "detect-ellipse-overlap": 0.7 },
];
const kLooks = { before: "candidate", after: "tracked", mark: "truth" };
const at = (id) => document.getElementById(id);

/** Whether the page is visited for the first time; false from the second call on. */
export function isFirstVisit() {
  try {
    const isFirst = localStorage.getItem(kSeenKey) === null;
    localStorage.setItem(kSeenKey, "seen");
    return isFirst;
  } catch {
    return false;  // the browser stores nothing, so a visit cannot be remembered
  }
}

// Best first. Scores are comparable within one search only.
function foundIn({ candidates, detector }) {
  return candidates.filter(({ found, ellipse }) => found && ellipse).sort((a, b) => b.score - a.score)
    .map(({ ellipse, probability }) => ({ ellipse, probability, detector }));
}

export class Guide {
  #isOn = false;
  #step = "see";
  #stored = [];        // [{frame, pts_ns, has_target}], oldest first
  #marks = [];         // [{frame, pts, position, truth, candidates, width, height}]
  #wanted = null;      // stored frame that is being marked or shown
  #candidates = [];    // of the frame that is being marked
  #proposal = null;
  #wasPlaying = false;
  #timer = 0;
  #storage = null;     // identifies the stored frames; null until the program has begun to store them
  #discarding = null;  // request that discards the frames of the previous visit
  #isShowing = false;  // a frame is being requested
  #choice;

  /** @param onClose  Called when the user leaves the guide. */
  constructor(screen, playback, settings, onClose) {
    Object.assign(this, { screen, playback, settings });
    this.#choice = new TargetChoice(screen, at("guide-choices"), at("guide-undo"), () => {
      at("guide-mark").disabled = this.#choice.answer() === undefined;
    });
    at("guide-skip").onclick = at("guide-discard").onclick = onClose;
    at("guide-play").onclick = () => playback.toggle();
    at("guide-begin").onclick = () => this.#attempt(() => this.#beginMarks());
    at("guide-mark").onclick = () => this.#attempt(() => this.#mark());
    at("guide-apply").onclick = () => this.#attempt(() => this.#apply());
    screen.canvas.addEventListener("click", (event) => {
      if (this.#isOn && this.#step === "mark" && this.#isShown) this.#choice.pick(event);
    });
    document.addEventListener("keydown", ({ key }) => {
      if (key === "Escape" && this.#isOn && !document.querySelector("dialog[open]")) onClose();
    });
  }

  start() {
    this.#isOn = true;
    this.#wasPlaying = false;
    at("guide").hidden = false;
    at("guide-button").setAttribute("aria-expanded", "true");
    this.#restart();
  }

  stop() {
    this.#isOn = false;
    clearTimeout(this.#timer);
    at("guide").hidden = true;
    at("guide-button").setAttribute("aria-expanded", "false");
    this.#setStep("see");
    this.#discarding = discardFrames().catch(() => {});  // the program discards unused frames by itself
    if (this.#wasPlaying && !this.playback.isPlaying) this.playback.toggle();
  }

  // Starts over: stores new frames.
  async #restart() {
    this.#marks = [];
    this.#proposal = null;
    this.#setStep("see");
    this.#storage = null;
    at("guide-begin").disabled = true;
    await this.#attempt(async () => {
      await this.#discarding;
      await storeFrames(true);
      this.#storage = Symbol("stored frames");
    });
    this.#poll();
  }

  #setStep(step) {
    this.#step = step;
    this.#wanted = null;
    showStep(step);
    // Playback would replace the frame that is being marked.
    at("frame").closest("main").classList.toggle("marks", step !== "see");
    this.screen.canvas.parentElement.classList.toggle("picks", step === "mark");
    this.screen.view = step === "see" ? null : (context, frame) => this.#draw(context, frame);
    this.screen.draw();
  }

  // Runs a task. On an error, shows it with a button that repeats the task, or that starts over if frames
  // are no longer stored.
  async #attempt(task) {
    hideTrouble();
    try {
      await task();
    } catch (error) {
      if (!this.#isOn) return;
      const isGone = error.status === kGone;
      const retry = isGone ? () => this.#playOn() : () => this.#attempt(task);
      showTrouble(troubleText(error, isGone), isGone ? "Store new frames" : "Try again", retry);
    }
  }

  async #playOn() {
    if (!this.playback.isPlaying) await this.playback.toggle();
    this.#restart();
  }

  /* Step "see" */

  #poll = newestOnly(async () => {
    clearTimeout(this.#timer);
    const storage = this.#storage;
    try {
      const stored = await storedFrames();
      const isOfNow = storage !== null && storage === this.#storage;
      if (this.#isOn && this.#step === "see" && isOfNow) this.#see(stored);
    } catch {
      // The status bar reports a lost connection.
    }
    if (this.#isOn) this.#timer = setTimeout(() => this.#poll(), this.#step === "see" ? kPollMs : kKeepMs);
  });

  #see({ storing, full, max_frames: max, frames }) {
    const { source } = this.playback;
    // A change of the source discards the frames and stops the storing. Another client's guide only stops it.
    if (!storing && frames.length === 0) this.#attempt(() => storeFrames(true));
    const isGrowing = storing && this.playback.isPlaying;
    const isEnough = full || frames.length >= kMinStored || (!isGrowing && frames.length > 0);
    at("guide-state").textContent = sourceText(source, this.screen.frame);
    at("guide-stored").textContent = storedText(frames.length, max, full, this.playback.isPlaying);
    at("guide-progress").max = max;
    at("guide-progress").value = full ? max : frames.length;
    at("guide-begin").disabled = !isEnough;
    at("guide-play").hidden = !source || source.playing || source.error !== "";
  }

  /* Step "mark" */

  async #beginMarks() {
    this.#wasPlaying ||= this.playback.isPlaying;
    const { frames } = await storeFrames(false);
    if (frames.length === 0) throw Object.assign(new Error(), { status: kGone });
    this.#stored = frames;
    this.#marks = [];
    this.#setStep("mark");
    await this.#showNext();
  }

  get #count() {
    return Math.min(kMarks, this.#stored.length);
  }

  // Position of the next frame to mark. Each has an equal part of the stored ones: from it, the frame without a target
  // that is closest to its middle, or else its middle.
  #nextPosition() {
    const part = this.#stored.length / this.#count;
    const [begin, middle, end] = [0, 0.5, 1].map((share) => Math.floor((this.#marks.length + share) * part));
    const distance = (position) => Math.abs(position - middle);
    const missed = [...this.#stored.keys()].slice(begin, end).filter((position) => !this.#stored[position].has_target);
    return missed.sort((a, b) => distance(a) - distance(b))[0] ?? middle;
  }

  // Shows the next frame to mark.
  async #showNext() {
    const number = this.#marks.length;
    const position = this.#nextPosition();
    this.#choice.wait();
    at("guide-mark").textContent = number + 1 < this.#count ? "Mark, next frame" : "Mark, propose settings";
    at("guide-frame").innerHTML = `<b>Frame ${number + 1} of ${this.#count}</b>, number ${position + 1} of the ` +
      `${this.#stored.length} stored ones.`;
    await this.#show(position);
  }

  async #show(position) {
    this.#wanted = { ...this.#stored[position], position };
    for (const button of at("guide-result").querySelectorAll("[data-position]")) {
      button.setAttribute("aria-pressed", button.dataset.position === String(position));
    }
    this.#isShowing = true;
    try {
      await showStored(this.#wanted.frame);
      await this.playback.refresh();
    } finally {
      this.#isShowing = false;
    }
    await this.refresh();
  }

  get #isShown() {
    return this.#wanted !== null && this.screen.frame?.pts === this.#wanted.pts_ns;
  }

  /** Offers the candidates of a frame when it is on the screen. */
  refresh = newestOnly(async () => {
    if (!this.#isOn || !this.#wanted || this.#isShowing) return;
    const { position } = this.#wanted;
    if (this.playback.isPlaying) {
      showTrouble("The source is playing.", "Show the frame", () => this.#attempt(() => this.#show(position)));
      return;
    }
    if (this.#step !== "mark" || !this.#isShown || !this.#choice.isWaiting) return;
    await this.#attempt(async () => {
      const { frame, pts_ns: pts } = this.#wanted;
      const now = await analyze({ frame });
      const searches = [now];
      for (const properties of kWideSearches) searches.push(await analyze({ frame, properties }));
      if (!this.#isOn || this.#wanted?.frame !== frame) return;
      this.#candidates = searches.flatMap((each) => foundIn(each));
      const others = this.#candidates.map(({ ellipse }) => ellipse);
      const target = now.candidates.find((each) => each.is_target)?.ellipse;
      this.#choice.offer({ pts, target, others, keepsDrawn: false });
    });
  });

  async #mark() {
    const { frame, pts_ns: pts, position } = this.#wanted;
    if (!this.#isShown) return this.#show(position);  // another client shows another frame
    const truth = this.#choice.answer();
    at("guide-mark").disabled = true;
    const { width, height } = this.screen.frame.bitmap;
    const label = this.playback.source?.can_label ? `Saved as ${await saveLabel(truth, pts)}.`
      : "Marks are not saved: start ellipse-live with --labels FOLDER to keep them.";
    at("guide-label").textContent = label;
    this.#marks.push({ frame, pts, position, truth, candidates: this.#candidates, width, height });
    await this.#attempt(() => (this.#marks.length < this.#count ? this.#showNext() : this.#propose()));
  }

  /* Step "result" */

  async #propose() {
    this.#setStep("result");
    at("guide-apply").hidden = true;
    at("guide-result").textContent = "Trying settings on your marks and the stored frames…";
    const proposal = await propose(this.#marks, this.settings.values(), this.settings.defaults());
    if (!this.#isOn) return;
    this.#proposal = proposal;
    this.#showResult();
    await this.#show(this.#marks[0].position);
  }

  #showResult() {
    const hasChanges = Object.keys(this.#proposal.changes).length > 0;
    at("guide-result").replaceChildren(...showProposal({
      proposal: this.#proposal,
      marks: this.#marks,
      values: this.settings.values(),
      onShow: (position) => this.#attempt(() => this.#show(position)),
    }));
    at("announcer").textContent = at("guide-result").querySelector("h3").textContent;
    at("guide-apply").hidden = !hasChanges;
    at("guide-discard").textContent = hasChanges ? "Discard" : "Done";
  }

  async #apply() {
    const trouble = await this.settings.set(this.#proposal.changes);
    if (trouble) throw new Error(trouble);
    at("guide-apply").hidden = true;
    at("guide-discard").textContent = "Done";
    at("guide-discard").focus();
    at("guide-result").querySelector("h3").textContent = "Applied. You can save the settings as a preset in Tune.";
  }

  #draw(context, frame) {
    if (this.#step === "mark" && this.#isShown) return this.#choice.draw(context, frame);
    const { bitmap } = frame;
    drawPicture(context, bitmap, bitmap.width, bitmap.height);
    if (!this.#proposal || !this.#isShown) return;
    const { before, after } = this.#proposal;
    const { frame: number } = this.#wanted;
    const shown = {
      mark: this.#marks.find((mark) => mark.frame === number)?.truth,
      before: before.stream.targets.get(number),
      after: after.stream.targets.get(number),
    };
    const width = context.lineWidth;
    for (const [name, look] of Object.entries(kLooks)) {
      context.lineWidth = name === "before" ? 2 * width : width;
      if (shown[name]) drawEllipse(context, shown[name], look, { ellipse: true, centre: name === "after" });
    }
    context.lineWidth = width;
  }
}
