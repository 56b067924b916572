// SPDX-License-Identifier: MIT
// The Compare tab: one frame with two sets of settings, side by side.
import { analyze, lookOf } from "./analysis.js";
import { newestOnly } from "./connection.js";
import { make } from "./controls.js";
import { contextOf, drawEllipse, drawPicture } from "./drawing.js";

const kIntervalMs = 500;
const at = (id) => document.getElementById(id);

export class Compare {
  #kept = null;  // settings A
  #results = null;
  #isOn = false;
  #timer = 0;

  constructor(screen, playback, settings) {
    Object.assign(this, { screen, playback, settings });
    at("compare-pin").onclick = () => {
      this.#kept = settings.values();
      at("compare-back").disabled = false;
      this.playback.pause();
      this.refresh();
    };
    at("compare-back").onclick = () => settings.set(this.#differences(this.#kept));
  }

  start() {
    this.#isOn = true;
    if (this.#kept) this.refresh();
    else at("compare-result").replaceChildren();
  }

  stop() {
    this.#isOn = false;
    this.#results = null;
    this.screen.view = null;
    this.#split(false);
    this.screen.draw();
  }

  get isKept() {
    return this.#kept !== null;
  }

  refresh = newestOnly(async () => {
    if (!this.#isOn || !this.#kept || !this.screen.frame) return;
    try {
      const a = await analyze({ properties: this.#differences(this.#kept) });
      const b = await analyze();
      this.#results = { a, b };
    } catch (error) {
      at("compare-result").replaceChildren(make("p", { className: "error", role: "alert" }, error.message));
      return;
    }
    if (!this.#isOn) return;
    this.#split(true);
    this.screen.view = (context, frame) => this.#draw(context, frame);
    this.screen.draw();
    this.#showResult();
    clearTimeout(this.#timer);
    if (this.playback.isPlaying) this.#timer = setTimeout(() => this.refresh(), kIntervalMs);
  });

  // The given settings that differ from the current ones.
  #differences(wanted) {
    const now = this.settings.values();
    return Object.fromEntries(Object.entries(wanted).filter(([name, value]) => {
      return JSON.stringify(now[name]) !== JSON.stringify(value);
    }));
  }

  #split(isSplit) {
    at("screen-b").hidden = at("tag-a").hidden = at("tag-b").hidden = !isSplit;
    at("frame").closest("main").classList.toggle("compares", isSplit);
  }

  #draw(context, { bitmap }) {
    const second = contextOf(at("screen-b"), bitmap.width, bitmap.height);
    for (const [each, result] of [[context, this.#results.a], [second, this.#results.b]]) {
      drawPicture(each, bitmap, bitmap.width, bitmap.height);
      const found = result.candidates.filter((candidate) => candidate.found);
      found.sort((a, b) => a.is_target - b.is_target);
      for (const candidate of found) {
        drawEllipse(each, candidate.ellipse, lookOf(candidate), {
          ellipse: true,
          axes: candidate.is_target,
          centre: candidate.is_target,
        });
      }
    }
  }

  #showResult() {
    const { a, b } = this.#results;
    const targetOf = (result) => result.candidates.find(({ is_target: isTarget }) => isTarget);
    const [ta, tb] = [targetOf(a), targetOf(b)];
    const found = (result) => String(result.candidates.filter((each) => each.found).length);
    const figure = (candidate, valueOf, digits) => (candidate ? valueOf(candidate).toFixed(digits) : "–");
    const rows = [
      ["Target", ta ? "found" : "none", tb ? "found" : "none"],
      ["Centre x [px]", ...[ta, tb].map((t) => figure(t, ({ ellipse }) => ellipse.cx, 1))],
      ["Centre y [px]", ...[ta, tb].map((t) => figure(t, ({ ellipse }) => ellipse.cy, 1))],
      ["Major axis [px]", ...[ta, tb].map((t) => figure(t, ({ ellipse }) => 2 * ellipse.semi_major, 1))],
      ["Minor axis [px]", ...[ta, tb].map((t) => figure(t, ({ ellipse }) => 2 * ellipse.semi_minor, 1))],
      ["ContourOverlap", ...[ta, tb].map((t) => figure(t, (c) => c.contour_overlap, 3))],
      ["EllipseOverlap", ...[ta, tb].map((t) => figure(t, (c) => c.ellipse_overlap, 3))],
      ["Probability", ...[ta, tb].map((t) => figure(t, (c) => c.probability, 3))],
      ["Ellipses found", found(a), found(b)],
      ["Candidates", String(a.candidates.length), String(b.candidates.length)],
      ["Analysis [ms]", ...[a, b].map(({ processing_ns: time }) => (time / 1e6).toFixed(2))],
    ];
    const changes = Object.entries(this.#differences(this.#kept)).map(([name, value]) => {
      return [name, String(value), String(this.settings.values()[name])];
    });
    at("compare-result").replaceChildren(
      tableOf("Settings", changes.length > 0 ? changes : [["no differences", "", ""]]),
      tableOf("Result", rows));
  }
}

/** A table with a row per entry: [name, ...cells]. */
export function tableOf(title, rows, columns = ["A", "B"]) {
  const head = make("tr", {}, ...["", ...columns].map((text) => make("th", { scope: "col" }, text)));
  return make("table", {},
    make("caption", {}, title),
    make("thead", {}, head),
    make("tbody", {}, ...rows.map(([name, ...cells]) => make("tr", {},
      make("th", { scope: "row" }, name),
      ...cells.map((cell) => make("td", {}, cell))))));
}
