// SPDX-License-Identifier: MIT
// The Stages tab: edges, chains, arcs and candidates of the shown frame, and the reason of each
// rejection.
import { analyze, kBest, lookOf, ellipseText } from "./analysis.js";
import { newestOnly } from "./connection.js";
import { make } from "./controls.js";
import { distanceTo, drawEllipse, drawPicture } from "./drawing.js";

const kStages = {
  luma: "Frame",
  edges: "Edges",
  chains: "Chains",
  arcs: "Arcs",
  candidates: "Candidates",
};
// The names of these stages for the detector "contours".
const kStagesOfContours = { chains: "Contours", arcs: "Parts" };
const kMaxRows = 200;
const kIntervalMs = 400;
const kNearPx = 12;
const at = (id) => document.getElementById(id);

export class Stages {
  #stage = "candidates";
  #result = null;
  #marked = null;  // number of the highlighted candidate
  #only = null;    // reason whose candidates are drawn alone
  #open = new Set(["accepted"]);
  #whole = new Set();  // reasons with a complete list
  #showsAll = false;   // all rejected candidates are drawn
  #isOn = false;
  #timer = 0;
  #names = {};     // elements with the stages' names

  constructor(screen, playback, settings, notify) {
    Object.assign(this, { screen, playback, settings, notify });
    for (const [stage, title] of Object.entries(kStages)) {
      const radio = make("input", { type: "radio", name: "stage", value: stage, checked: stage === this.#stage });
      radio.onchange = () => {
        this.#stage = stage;
        this.refresh();
      };
      this.#names[stage] = make("span", {}, title);
      at("stage-choices").append(make("label", { className: "pill" }, radio, this.#names[stage]));
    }
    at("stage-all").onclick = () => {
      this.#showsAll = !this.#showsAll;
      this.#showCount();
      this.screen.draw();
    };
    screen.canvas.addEventListener("click", (event) => this.#isOn && this.#pick(event));
  }

  start() {
    this.#isOn = true;
    this.screen.canvas.parentElement.classList.add("picks");
    this.refresh();
  }

  stop() {
    this.#isOn = false;
    this.#result = null;
    this.screen.canvas.parentElement.classList.remove("picks");
    this.screen.view = null;
    delete this.screen.canvas.dataset.stage;
    this.screen.draw();
  }

  /** Analyses the current frame with the current settings. Repeats while the source plays. */
  refresh = newestOnly(async () => {
    if (!this.#isOn || !this.screen.frame) return;
    try {
      // Candidates are drawn here, over the frame.
      const choice = this.#stage;
      const stage = choice === "candidates" ? "luma" : choice;
      this.#result = { choice, stage, ...await analyze({ stage }) };
    } catch (error) {
      at("stage-summary").textContent = error.message;
      return;
    }
    if (!this.#isOn) return;
    this.screen.view = (context, frame) => this.#draw(context, frame);
    this.screen.draw();
    this.#list();
    clearTimeout(this.#timer);
    if (this.playback.isPlaying) this.#timer = setTimeout(() => this.refresh(), kIntervalMs);
  });

  #draw(context, { bitmap, pts }) {
    const { image, candidates, choice, stage, pts_ns: analysedPts } = this.#result;
    const isSame = String(analysedPts) === pts && stage === "luma";
    drawPicture(context, isSame || !image ? bitmap : image, bitmap.width, bitmap.height, stage !== "luma");
    this.screen.canvas.dataset.stage = choice;
    if (choice === "candidates") {
      context.fillStyle = "rgb(8 10 14 / .55)";
      context.fillRect(-0.5, -0.5, bitmap.width, bitmap.height);
    }
    // Drawing order: rejected, found, target, highlighted.
    const rank = ({ is_target, found, number }) => (number === this.#marked ? 3 : is_target ? 2 : found ? 1 : 0);
    const shown = candidates
      .map((candidate, number) => ({ ...candidate, number }))
      .filter((candidate) => this.#isShown(candidate, candidate.number))
      .sort((a, b) => rank(a) - rank(b));
    const width = context.lineWidth;
    for (const candidate of shown) {
      const isMarked = candidate.number === this.#marked;
      context.globalAlpha = isMarked || candidate.found ? 1 : 0.6;
      context.lineWidth = isMarked ? 1.8 * width : candidate.found ? width : 0.6 * width;
      drawEllipse(context, candidate.ellipse, lookOf(candidate), { ellipse: true, centre: isMarked });
    }
    context.globalAlpha = 1;
    context.lineWidth = width;
  }

  // Draws found candidates and the best rejected ones; if a reason is open, those in its list.
  #isShown(candidate, number) {
    if (!candidate.ellipse) return false;
    if (number === this.#marked) return true;
    const { choice, best, groups } = this.#result;
    if (this.#only !== null) {
      const group = groups.find(({ reason }) => reason === this.#only);
      return group !== undefined && this.#listed(group).some((each) => each.number === number);
    }
    return choice === "candidates" && (candidate.found || this.#showsAll || best.has(number));
  }

  #listed({ reason, members }) {
    const limit = this.#whole.has(reason) ? kMaxRows : kBest;
    return members.filter(({ ellipse }) => ellipse).slice(0, limit);
  }

  #showCount() {
    const { candidates, best, choice } = this.#result;
    const rejected = candidates.filter(({ ellipse, found }) => ellipse && !found).length;
    at("stage-shown").hidden = choice !== "candidates" || this.#only !== null || rejected <= best.size;
    at("stage-shown").firstChild.textContent = this.#showsAll
      ? `Showing all ${rejected} rejected candidates`
      : `Showing the closest ${best.size} of ${rejected} rejected candidates`;
    at("stage-all").textContent = this.#showsAll ? "Show closest" : "Show all";
    at("stage-all").setAttribute("aria-pressed", this.#showsAll);
  }

  #list() {
    this.#showCount();
    const { groups, passes, processing_ns: time, detector } = this.#result;
    for (const stage of Object.keys(kStagesOfContours)) {
      this.#names[stage].textContent = (detector === "contours" ? kStagesOfContours : kStages)[stage];
    }
    const total = groups.reduce((sum, { count }) => sum + count, 0);
    const pass = passes.at(-1);
    const parts = [`<b>${total}</b> candidates`];
    if (pass) {
      parts.push(`scale 1:${pass.scale}`, `edges above ${pass.edge_high.toFixed(1)} grey levels per px`);
    }
    at("stage-summary").innerHTML = `${detector}: ${parts.join(", ")}, ${(time / 1e6).toFixed(2)} ms`;
    const hadFocus = document.activeElement?.dataset?.focus;
    at("reasons").replaceChildren(...groups.map((group) => this.#group(group, total)));
    if (hadFocus) at("reasons").querySelector(`[data-focus="${CSS.escape(hadFocus)}"]`)?.focus();
  }

  #group(group, total) {
    const bar = make("i");
    bar.style.width = `${100 * group.count / total}%`;
    const summary = make("summary", {},
      make("span", {}, group.description),
      make("span", { className: "count" }, String(group.count)),
      make("span", { className: "share" }, bar));
    summary.dataset.focus = group.reason;
    const kind = group.reason === "accepted" ? " accepted" : group.isFound ? " kept" : "";
    const node = make("details", { className: `reason${kind}`, open: this.#open.has(group.reason) }, summary);
    node.dataset.reason = group.reason;
    node.ontoggle = () => {
      if (node.open) this.#open.add(group.reason);
      else this.#open.delete(group.reason);
      this.#only = node.open && group.reason !== "accepted" ? group.reason
        : this.#only === group.reason ? null : this.#only;
      this.#showCount();
      this.screen.draw();
    };
    const rows = this.#listed(group);
    node.append(make("ul", {}, ...rows.map((member) => this.#row(group, member))));
    if (group.count > rows.length) node.append(this.#rest(group, group.count - rows.length));
    const setting = this.#settingOf(group);
    if (setting) {
      const button = make("button", { className: "quiet to-setting" }, `Go to ${setting}`);
      button.onclick = () => this.onSetting(setting);
      node.append(button);
    }
    return node;
  }

  // The number of unlisted candidates, or a button that lists more of them.
  #rest(group, count) {
    const drawable = group.members.filter(({ ellipse }) => ellipse).length;
    if (this.#whole.has(group.reason) || drawable <= kBest) {
      return make("p", { className: "more" }, `and ${count} more`);
    }
    const title = drawable <= kMaxRows ? `Show all ${drawable}` : `Show ${kMaxRows} of ${drawable}`;
    const button = make("button", { className: "quiet rest" }, title);
    button.dataset.focus = `${group.reason} rest`;
    button.onclick = () => {
      this.#whole.add(group.reason);
      this.#list();
      this.screen.draw();
    };
    return button;
  }

  /** Called with the name of the setting to show. */
  onSetting = () => {};

  // Overlap limits exist for detection and for tracking; this analysis only detects.
  #settingOf({ setting }) {
    if (!setting) return null;
    return setting in this.settings.values() ? setting : `detect-${setting}`;
  }

  #row(group, member) {
    const figure = group.quantity
      ? `${group.quantity} ${short(member.measured)}${group.unit ? ` ${group.unit}` : ""}, ` +
        `${member.measured < member.limit ? "at least" : "at most"} ${short(member.limit)}`
      : member.found ? foundText(member) : "";
    const button = make("button", {},
      make("span", {}, (member.is_target ? "Target, " : "") + figure),
      make("span", { className: "where" }, ellipseText(member.ellipse)));
    button.dataset.focus = `${group.reason} ${member.number}`;
    button.dataset.candidate = member.number;
    const mark = (number) => () => {
      this.#marked = number;
      this.screen.draw();
    };
    button.onpointerenter = button.onfocus = button.onclick = mark(member.number);
    button.onpointerleave = button.onblur = mark(null);
    return make("li", {}, button, ...(member.evidence ? [evidenceOf(member.evidence)] : []));
  }

  // Shows the candidate nearest to the pointer in the list.
  #pick(event) {
    if (!this.#result) return;
    const { x, y } = this.screen.picturePoint(event);
    const near = this.#result.candidates
      .map((candidate, number) => ({ candidate, number }))
      .filter(({ candidate }) => candidate.ellipse)
      .map((each) => ({ ...each, distance: distanceTo(each.candidate.ellipse, x, y) }))
      .filter(({ distance }) => distance < kNearPx);
    // Drawn candidates take precedence over hidden ones.
    const shown = near.filter(({ candidate, number }) => this.#isShown(candidate, number));
    const [best] = (shown.length > 0 ? shown : near).sort((a, b) => a.distance - b.distance);
    if (!best) return;
    const group = this.#result.groups.find(({ reason }) => reason === best.candidate.reason);
    if (!this.#listed(group).some(({ number }) => number === best.number)) this.#whole.add(group.reason);
    this.#open.add(best.candidate.reason);
    this.#list();
    const row = at("reasons").querySelector(`[data-candidate="${best.number}"]`);
    row?.focus();
    row?.scrollIntoView({ block: "center" });
    this.notify(best.candidate.text);
  }
}

// Detectors that report a probability use its log odds as the score.
function foundText({ evidence, probability, score }) {
  if (!evidence) return `score ${score.toFixed(0)}`;
  return `probability ${probability < 0.9995 ? probability.toFixed(3) : "above 0.999"}`;
}

// Bars of each feature's contribution to the log odds: evidence for an ellipse points right.
function evidenceOf(evidence) {
  const largest = Math.max(...evidence.map(({ contribution }) => Math.abs(contribution)), 1);
  return make("dl", { className: "evidence" }, ...evidence.flatMap(({ description, contribution }) => {
    const bar = make("i", { className: contribution < 0 ? "against" : "for" });
    bar.style.width = `${(50 * Math.abs(contribution)) / largest}%`;
    const figure = `${contribution < 0 ? "−" : "+"}${Math.abs(contribution).toFixed(1)}`;
    return [make("dt", {}, description), make("dd", {}, make("span", { className: "weight" }, bar), figure)];
  }));
}

function short(value) {
  return String(Number(value.toPrecision(3)));
}
