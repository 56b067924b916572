// SPDX-License-Identifier: MIT
// Plots of the last twenty seconds: centre, axes, overlaps, processing time and state.
import { make } from "./controls.js";
import { targetOf } from "./drawing.js";

const kSpanMs = 20000;
const kMaxSamples = 2400;
const style = getComputedStyle(document.documentElement);
const color = (name) => style.getPropertyValue(`--${name}`).trim();

const kFirst = "#86b7ff";
const kSecond = "#ffb37a";
const kThird = "#9be28f";
const kPlots = [
  { title: "Centre", unit: "px", curves: [["x", kFirst, (s) => s.target?.cx], ["y", kSecond, (s) => s.target?.cy]], digits: 1 },
  { title: "Axes", unit: "px", curves: [["major", kFirst, (s) => s.target && 2 * s.target.semi_major], ["minor", kSecond, (s) => s.target && 2 * s.target.semi_minor]], digits: 1, from: 0 },
  { title: "Overlaps", unit: "", curves: [["contour", kFirst, (s) => s.target?.contour_overlap], ["ellipse", kSecond, (s) => s.target?.ellipse_overlap], ["probability", kThird, (s) => s.target?.probability]], digits: 2, from: 0, to: 1 },
  { title: "Analysis", unit: "ms", curves: [["time", kFirst, (s) => s.time_ms]], digits: 2, from: 0 },
];

export class Plots {
  #samples = [];
  #plots;
  #cursor = null;  // pointer position as a fraction of the width

  constructor(container) {
    this.#plots = kPlots.map((plot) => this.#build(plot, container));
    this.#tick();
  }

  add(line) {
    this.#samples.push({
      at: performance.now(),
      target: targetOf(line),
      time_ms: line.processing_ns === undefined ? undefined : line.processing_ns / 1e6,
    });
    if (this.#samples.length > kMaxSamples) this.#samples.shift();
  }

  #build(plot, container) {
    const canvas = make("canvas", { role: "img" });
    const keys = plot.curves.map(([name, stroke]) => {
      const key = make("span", { className: "key" }, name);
      key.style.setProperty("--of-line", stroke);
      return key;
    });
    container.append(make("figure", { className: "plot" },
      make("figcaption", {}, make("b", {}, `${plot.title} `, make("small", {}, plot.unit)), ...keys), canvas));
    canvas.onpointermove = (event) => {
      this.#cursor = event.offsetX / canvas.clientWidth;
    };
    canvas.onpointerleave = () => {
      this.#cursor = null;
    };
    return { ...plot, canvas, keys, spoken: -Infinity };
  }

  // 10 Hz is fast enough to read and costs little.
  #tick() {
    setTimeout(() => requestAnimationFrame(() => this.#tick()), 100);
    if (document.hidden) return;
    const now = performance.now();
    const samples = this.#samples;
    while (samples.length > 0 && samples[0].at < now - kSpanMs) samples.shift();
    for (const plot of this.#plots) this.#draw(plot, now);
  }

  #draw(plot, now) {
    const { canvas } = plot;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    const fine = devicePixelRatio;
    if (width === 0) return;
    if (canvas.width !== Math.round(width * fine)) {
      canvas.width = Math.round(width * fine);
      canvas.height = Math.round(height * fine);
    }
    const context = canvas.getContext("2d");
    context.setTransform(fine, 0, 0, fine, 0, 0);
    context.clearRect(0, 0, width, height);
    const toX = (time) => width * (1 - (now - time) / kSpanMs);
    const ribbon = height - 5;
    const [low, high] = rangeOf(plot, this.#samples);
    const toY = (value) => 4 + (ribbon - 10) * (1 - (value - low) / (high - low));
    drawGrid(context, width, [low, high], toY, plot.digits);
    for (const [, stroke, valueOf] of plot.curves) {
      drawCurve(context, this.#samples, stroke, toX, toY, valueOf);
    }
    drawStates(context, this.#samples, toX, ribbon);
    this.#showValues(plot, context, { now, toX, height });
  }

  // Shows the values at the pointer, or the latest ones.
  #showValues(plot, context, { now, toX, height }) {
    let sample = this.#samples.at(-1);
    if (this.#cursor !== null && sample) {
      const time = now - (1 - this.#cursor) * kSpanMs;
      sample = this.#samples.reduce((a, b) => Math.abs(b.at - time) < Math.abs(a.at - time) ? b : a);
      context.fillStyle = "rgb(232 236 242 / .5)";
      context.fillRect(toX(sample.at), 0, 1, height - 5);
    }
    const texts = plot.curves.map(([name, , valueOf], i) => {
      const value = sample && valueOf(sample);
      const text = `${name} ${value === undefined ? "–" : value.toFixed(plot.digits)}`;
      plot.keys[i].textContent = text;
      return text;
    });
    if (now - plot.spoken < 2000) return;
    plot.spoken = now;
    plot.canvas.setAttribute("aria-label", `${plot.title} ${plot.unit}: ${texts.join(", ")}`);
  }
}

function rangeOf({ curves, from, to }, samples) {
  const values = samples.flatMap((sample) => curves.map(([, , valueOf]) => valueOf(sample)))
    .filter((value) => value !== undefined);
  if (values.length === 0) return [from ?? 0, to ?? 1];
  const low = from ?? Math.min(...values);
  const high = to ?? Math.max(...values);
  const margin = Math.max(0.08 * (high - low), 1e-3 * Math.abs(high), 1e-3);
  return [from ?? low - margin, to ?? high + margin];
}

function drawGrid(context, width, values, toY, digits) {
  context.font = '10px system-ui, "DejaVu Sans", sans-serif';
  context.fillStyle = color("soft");
  for (const value of values) {
    const y = Math.round(toY(value)) + 0.5;
    context.globalAlpha = 0.22;
    context.fillRect(0, y, width, 1);
    context.globalAlpha = 0.85;
    const isTop = value === values[1];
    context.fillText(value.toFixed(Math.min(digits, 2)), 0, isTop ? y + 11 : y - 3);
  }
  context.globalAlpha = 1;
}

function drawCurve(context, samples, stroke, toX, toY, valueOf) {
  context.beginPath();
  let isDown = false;
  for (const sample of samples) {
    const value = valueOf(sample);
    if (value === undefined) {
      isDown = false;
      continue;
    }
    const [x, y] = [toX(sample.at), toY(value)];
    isDown ? context.lineTo(x, y) : context.moveTo(x, y);
    isDown = true;
  }
  context.strokeStyle = stroke;
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.stroke();
}

// The target's state over time, as a coloured strip at the bottom of the plot.
function drawStates(context, samples, toX, y) {
  for (let i = 0; i < samples.length; ++i) {
    const x = toX(samples[i].at);
    const end = i + 1 < samples.length ? toX(samples[i + 1].at) : x + 1;
    context.fillStyle = color(samples[i].target?.state ?? "lost");
    context.globalAlpha = samples[i].target ? 1 : 0.55;
    context.fillRect(x, y, Math.max(0, end - x) + 0.7, 3);
  }
  context.globalAlpha = 1;
}
