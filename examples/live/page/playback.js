// SPDX-License-Identifier: MIT
// Playback controls, and the state of the source.
import { ask, newestOnly } from "./connection.js";

const kPollMs = 1000;
const kSecondNs = 1e9;
const at = (id) => document.getElementById(id);

function timeText(ns) {
  if (ns === null || ns === undefined) return "–";
  const seconds = ns / kSecondNs;
  const minutes = Math.floor(seconds / 60);
  return `${minutes}:${(seconds - 60 * minutes).toFixed(2).padStart(5, "0")}`;
}

export class Playback {
  source = null;
  /** Called with the source when it may have changed. */
  onChange = () => {};

  constructor(canvas, notify) {
    this.notify = notify;
    at("play").onclick = () => this.toggle();
    at("step").onclick = () => this.step();
    at("scrub").oninput = () => this.#seek(at("scrub").value / 1000 * this.source.duration_ns);
    at("source-change").onclick = () => {
      at("source-spec").value = this.source.spec;
      at("source-fps").value = this.source.kind === "folder" ? this.source.fps : "";
      at("source-error").textContent = "";
      at("source-dialog").showModal();
    };
    at("source-cancel").onclick = () => at("source-dialog").close();
    at("source-form").onsubmit = (event) => this.#changeSource(event);
    canvas.addEventListener("keydown", (event) => this.#takeKey(event));
    setInterval(() => this.refresh(), kPollMs);
  }

  get isPlaying() {
    return this.source?.playing ?? true;
  }

  refresh = newestOnly(async () => {
    try {
      this.source = await ask("GET", "api/source");
    } catch {
      return;  // the WebSockets report a lost connection
    }
    this.#show();
    this.onChange(this.source);
  });

  async toggle() {
    await this.#do(this.isPlaying ? "api/pause" : "api/play");
  }

  async pause() {
    if (this.isPlaying) await this.#do("api/pause");
  }

  async step() {
    if (this.isPlaying) await this.#do("api/pause");
    await this.#do("api/step");
  }

  #seek = newestOnly(async (position) => {
    await this.#do("api/seek", { position_ns: Math.max(0, Math.round(position)) });
  });

  async #do(path, body) {
    try {
      await ask("POST", path, body);
    } catch (error) {
      this.notify(error.message);
    }
    await this.refresh();
  }

  async #changeSource(event) {
    event.preventDefault();
    const spec = at("source-spec").value.trim();
    const fps = at("source-fps").value.trim();
    try {
      await ask("PUT", "api/source", fps ? { spec, fps } : { spec });
      at("source-dialog").close();
    } catch (error) {
      at("source-error").textContent = error.message;
    }
    await this.refresh();
  }

  #takeKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const jump = { ArrowLeft: -kSecondNs, ArrowRight: kSecondNs }[event.key];
    if (event.key === " ") this.toggle();
    else if (event.key === ".") this.step();
    else if (jump && this.source?.seekable) this.#seek(this.source.position_ns + jump);
    else return;
    event.preventDefault();
  }

  #show() {
    const { source } = this;
    const name = at("source-name");
    name.textContent = name.title = source.spec;
    at("source-change").hidden = !source.can_change;
    at("play").setAttribute("aria-label", source.playing ? "Pause" : "Play");
    at("play").title = source.playing ? "Pause" : "Play";
    at("play-icon").setAttribute("href", source.playing ? "#i-pause" : "#i-play");
    const scrub = at("scrub");
    scrub.hidden = !source.seekable || !source.duration_ns;
    if (!scrub.hidden && document.activeElement !== scrub) this.#showPosition(source.position_ns);
    const total = source.duration_ns ? ` / ${timeText(source.duration_ns)}` : "";
    at("time").textContent = timeText(source.pts_ns ?? source.position_ns) + total;
    scrub.setAttribute("aria-valuetext", timeText(source.position_ns));
  }

  /** Shows the position of the shown frame. */
  showFrame(pts) {
    if (!this.source) return;
    const total = this.source.duration_ns ? ` / ${timeText(this.source.duration_ns)}` : "";
    at("time").textContent = timeText(Number(pts)) + total;
    if (this.source.duration_ns) this.#showPosition(Number(pts));
  }

  #showPosition(position) {
    const scrub = at("scrub");
    const share = Math.min(1, position / this.source.duration_ns);
    if (!scrub.matches(":active")) scrub.value = 1000 * share;
    scrub.style.setProperty("--at", `${100 * share}%`);
  }
}
