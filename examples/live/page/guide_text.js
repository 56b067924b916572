// SPDX-License-Identifier: MIT
// Texts of the guide: the state of the source, errors, and the proposal with its figures.
import { ellipseText } from "./analysis.js";
import { tableOf } from "./compare.js";
import { make } from "./controls.js";
import { targetOf } from "./drawing.js";
import { differencesOf } from "./proposal.js";

const kMaxGroups = 8;
const kStates = {
  starting: "is starting",
  playing: "is playing",
  pausing: "is being paused",
  paused: "is paused",
  held: "is paused",
  ended: "has ended",
  reconnecting: "is being reconnected",
  failed: "has failed",
};
const kOutcomes = { right: "right", wrong: "another ellipse", missed: "not found", false: "a false target" };

/** The state of the source, and the target in the shown frame. */
export function sourceText(source, frame) {
  if (!source) return "Waiting for the program.";
  const state = `The source ${source.spec} ${kStates[source.state] ?? source.state}.`;
  if (source.error) return `${state} It reports: ${source.error}.`;
  if (!frame || source.width === 0) return `${state} There is no frame yet.`;
  const target = targetOf(frame.line);
  return `${state} ${target ? `A target is ${target.state}: ${ellipseText(target)}.` : "No target is found."}`;
}

/** The number of stored frames. */
export function storedText(count, max, isFull, isPlaying) {
  if (isFull) return `The last ${count} frames are stored.`;
  if (isPlaying) return `${count} of ${max} frames are stored.`;
  return `${count} of ${max} frames are stored; play the source to store more.`;
}

/** The text of a failed request's error. */
export function troubleText(error, isGone) {
  if (isGone) return "The frames are no longer stored: the source has changed, or another page has discarded them.";
  if (error instanceof TypeError) return "No connection to ellipse-live. Your marks are kept.";
  return error.message;
}

const isEmpty = (changes) => Object.keys(changes).length === 0;

function titleOf({ changes, before, after }, marks) {
  const count = `${marks.length} ${marks.length === 1 ? "mark" : "marks"}`;
  const { right } = before.verdict;
  if (!isEmpty(changes)) return "Proposed settings";
  if (right === marks.length) return `The current settings are right on your ${count}.`;
  if (marks.every(({ truth }) => truth === null)) return "Mark the target in at least one frame to get a proposal.";
  return `None of the tried settings is right on more than ${after.verdict.right} of your ${count}.`;
}

function changesOf({ changes, why }, values) {
  return make("dl", { className: "proposed" }, ...Object.entries(changes).flatMap(([name, value]) => {
    const item = make("dt", {}, `${name}: ${values[name]} → ${value}`);
    item.dataset.proposed = name;
    return why[name] ? [item, make("dd", {}, why[name])] : [item];
  }));
}

function effectTable({ changes, before, after }, marks) {
  const frames = before.stream.targets.size;
  const columns = isEmpty(changes) ? [before] : [before, after];
  const row = (name, valueOf) => [name, ...columns.map((each) => String(valueOf(each)))];
  return tableOf(`Effect on the last ${frames} frames`, [
    row("Marks right, single frames", ({ verdict }) => `${verdict.right} of ${marks.length}`),
    row("Marks right, tracked", ({ stream }) => `${stream.right} of ${marks.length}`),
    row("Wrong ellipses in marked frames", ({ verdict }) => verdict.wrong.length),
    row("Frames with a target", ({ stream }) => `${stream.found} of ${frames}`),
  ], isEmpty(changes) ? ["now"] : ["now", "proposed"]);
}

function frameList(title, rows, onShow) {
  const list = make("ul", { className: "frames" });
  for (const { position, name, text } of rows) {
    const button = make("button", { "aria-pressed": "false" }, make("span", {}, name), make("span", {}, text));
    button.dataset.position = position;
    button.onclick = () => onShow(position);
    list.append(make("li", {}, button));
  }
  return [make("h4", {}, title), list];
}

function markRows({ changes, before, after }, marks) {
  return marks.map(({ position }, i) => {
    const [was, is] = [before, after].map(({ verdict }) => kOutcomes[verdict.outcomes[i]]);
    const text = isEmpty(changes) || was === is ? is : `${was} → ${is}`;
    return { position, name: `Mark ${i + 1}`, text };
  });
}

function differences({ changes, before, after }, onShow) {
  if (isEmpty(changes)) return [];
  const groups = differencesOf(before.stream, after.stream);
  const count = groups.reduce((sum, { from, to }) => sum + to - from + 1, 0);
  if (count === 0) return [make("h4", {}, "No frame differs while tracking")];
  const rows = groups.slice(0, kMaxGroups).map(({ from, to, kind }) => ({
    position: Math.floor((from + to) / 2),
    name: from === to ? `Frame ${from + 1}` : `Frames ${from + 1} – ${to + 1}`,
    text: kind,
  }));
  const rest = groups.length - rows.length;
  return [
    ...frameList(count === 1 ? "1 frame differs" : `${count} frames differ`, rows, onShow),
    ...(rest > 0 ? [make("p", { className: "help" }, `and ${rest} more groups`)] : []),
  ];
}

function reasonsOf({ reasons }) {
  const texts = reasons.flatMap((reason, i) => (reason ? [`Mark ${i + 1}: ${reason}`] : []));
  if (texts.length === 0) return [];
  const link = make("a", { href: "troubleshooting.md", target: "_blank", rel: "noopener" }, "Troubleshooting");
  return [
    ...texts.map((text) => make("p", { className: "reason-text" }, text)),
    make("p", {}, link, " lists further settings by symptom."),
  ];
}

/**
 * The proposal as nodes.
 * @param values  The current settings by name.
 * @param onShow  Called with the position of the stored frame to show.
 */
export function showProposal({ proposal, marks, values, onShow }) {
  return [
    make("h3", {}, titleOf(proposal, marks)),
    ...(isEmpty(proposal.changes) ? [] : [changesOf(proposal, values)]),
    ...reasonsOf(proposal),
    effectTable(proposal, marks),
    ...frameList("Marked frames", markRows(proposal, marks), onShow),
    ...differences(proposal, onShow),
    make("p", { className: "help" }, isEmpty(proposal.changes)
      ? "In the picture: dotted white, your mark; green, found while tracking."
      : "In the picture: dotted white, your mark; amber, found now; green, found with the proposed settings."),
  ];
}
