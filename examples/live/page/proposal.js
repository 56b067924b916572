// SPDX-License-Identifier: MIT
// Proposes settings for marked frames. Judges each trial by a new analysis of these frames.
import { analyze, ellipseText } from "./analysis.js";
import { replay } from "./history.js";
import { admittingTrial, isPartOf, isSame, overlapOf, ringRatioOf, trialsFor } from "./trials.js";

const kPasses = 2;
const kNearOverlap = 0.6;  // minimum overlap of a candidate near a mark
const kBadRequest = 400;

/** "right", "wrong" (another ellipse), "missed", or "false" (an ellipse in a frame without a target). */
function outcomeOf(truth, target) {
  if (!truth) return target ? "false" : "right";
  if (!target) return "missed";
  return isSame(truth, target) ? "right" : "wrong";
}

/** Judges settings by the marked frames, each as a single frame. */
async function judge(marks, changes) {
  const frames = await replay(changes, marks.map(({ frame }) => frame));
  const outcomes = frames.map(({ target }, i) => outcomeOf(marks[i].truth, target));
  const wrong = frames.flatMap(({ found }, i) => {
    const { truth } = marks[i];
    return found.filter((e) => !truth || !isPartOf(e, truth));
  });
  const targets = frames.map(({ target }) => target);
  return {
    outcomes,
    right: outcomes.filter((each) => each === "right").length,
    wrong,
    targets,
    rivals: targets.filter((_, i) => outcomes[i] === "wrong" || outcomes[i] === "false"),
  };
}

const isBetter = (a, b) => a.right > b.right || (a.right === b.right && a.wrong.length < b.wrong.length);
const isAsGood = (a, b) => !isBetter(b, a);

// Adds a trial's changes to the best ones so far and judges the sum. @returns the better of the two.
async function attempt(marks, best, trial) {
  const changes = { ...best.changes, ...trial.changes };
  try {
    const verdict = await judge(marks, changes);
    if (!isBetter(verdict, best.verdict)) return best;
    const sentences = Object.entries(trial.why).map(([name, sentence]) => {
      return [name, sentence instanceof Function ? sentence(verdict.right, best.verdict.right) : sentence];
    });
    return { changes, why: { ...best.why, ...Object.fromEntries(sentences) }, verdict };
  } catch (error) {
    if (error.status === kBadRequest) return best;  // an invalid combination
    throw error;
  }
}

async function search(marks, values, defaults, start) {
  let best = start;
  for (let pass = 0; pass < kPasses; ++pass) {
    const trials = trialsFor({
      marks,
      values: { ...values, ...best.changes },
      defaults,
      wrong: best.verdict.wrong,
      rivals: best.verdict.rivals,
      isRight: best.verdict.right === marks.length,
    });
    for (const trial of trials) best = await attempt(marks, best, trial);
  }
  return best;
}

// Removes changes that do not improve the verdict. Paired settings are removed together.
async function pruned(marks, best) {
  let result = best;
  const groups = [["edge-low", "edge-high"], ["roi", "roi-source"]];
  for (const name of Object.keys(best.changes)) {
    const group = groups.find((each) => each.includes(name)) ?? [name];
    const changes = Object.fromEntries(Object.entries(result.changes).filter(([each]) => !group.includes(each)));
    if (Object.keys(changes).length === Object.keys(result.changes).length) continue;
    const verdict = await judge(marks, changes).catch((error) => {
      if (error.status === kBadRequest) return null;
      throw error;
    });
    if (verdict && isAsGood(verdict, result.verdict)) result = { ...result, changes, verdict };
  }
  return result;
}

const isVisible = (target) => target !== null && target.state !== "predicted";

/** Replays the stored frames as one stream. @returns {targets, found, right}; `right` counts marked frames. */
async function streamOf(marks, changes) {
  const frames = await replay(changes);
  const targets = new Map(frames.map(({ frame, target }) => [frame, isVisible(target) ? target : null]));
  return {
    targets,
    found: [...targets.values()].filter(Boolean).length,
    right: marks.filter(({ frame, truth }) => outcomeOf(truth, targets.get(frame) ?? null) === "right").length,
  };
}

// Judges ring-ratio by the stream, because it has an effect only while tracking.
async function withRingRatio(marks, values, best, stream) {
  const ratio = ringRatioOf(marks);
  const isIdle = values.tracking !== "edges" || values["ring-ratio"] !== 0;
  if (isIdle || ratio === null || stream.right === marks.length) return { best, stream };
  const changes = { ...best.changes, "ring-ratio": ratio };
  const other = await streamOf(marks, changes);
  if (other.right <= stream.right) return { best, stream };
  const why = `Your marks have an inner edge at ${ratio} of their size; ${other.right} instead of ${stream.right} ` +
    "marks are right while tracking.";
  return { best: { ...best, changes, why: { ...best.why, "ring-ratio": why } }, stream: other };
}

// The candidate with the largest overlap with a mark, or undefined if none is near it.
async function candidateAt(mark, properties) {
  const { candidates } = await analyze({ frame: mark.frame, properties });
  return candidates.filter(({ ellipse }) => ellipse)
    .map((each) => ({ ...each, overlap: overlapOf(each.ellipse, mark.truth) }))
    .filter(({ overlap }) => overlap >= kNearOverlap)
    .sort((a, b) => b.overlap - a.overlap)[0];
}

// Describes the missing evidence of an unlikely candidate. The evidence is complete only for accepted
// candidates, so the candidate is analysed again without a minimum probability.
async function lackOf(mark, properties) {
  const { evidence } = await candidateAt(mark, { ...properties, "min-probability": 0 }) ?? {};
  if (!evidence) return "";
  const support = evidence.find(({ name }) => name === "turn-support").value;
  const [worst] = evidence.sort((a, b) => a.contribution - b.contribution);
  return `; ${Math.round(100 * support)} % of its outline has edges; strongest evidence against it: ${worst.description}`;
}

// Explains why a mark is not right although the limits that rejected it are relaxed.
async function reasonFor(mark, outcome, target, { changes, admitted }) {
  if (outcome === "false") return `An ellipse of ${ellipseText(target)} is reported in a frame without a target.`;
  const properties = { ...changes, ...admitted };
  const near = await candidateAt(mark, properties);
  const relaxed = Object.entries(admitted).map(([name, value]) => `${name}=${value}`).join(", ");
  const alternative = outcome === "wrong" ? ` Instead, ${ellipseText(target)} is selected.` : "";
  if (!near) return `No candidate is near your mark: its edges are too faint or too short.${alternative}`;
  const text = relaxed ? `Even with ${relaxed}: ${near.text}` : near.text[0].toUpperCase() + near.text.slice(1);
  const detail = near.reason === "unlikely" ? await lackOf(mark, properties) : "";
  return `${text}${detail}.${alternative}`;
}

/**
 * Proposes settings under which more of the marked frames are right, or as many with fewer wrong
 * ellipses.
 * @param marks   [{frame, truth, candidates, width, height}], see trialsFor().
 * @param values  The current settings by name.
 * @param defaults  Their defaults.
 * @returns {changes, why, before, after, reasons}. `before` and `after` have `verdict`, for single
 *          frames, and `stream`. `reasons[i]`: why mark i is not right afterwards, or "".
 */
export async function propose(marks, values, defaults) {
  const start = { changes: {}, why: {}, verdict: await judge(marks, {}) };
  const now = await streamOf(marks, {});
  let best = await pruned(marks, await search(marks, values, defaults, start));
  let stream = best.changes === start.changes ? now : await streamOf(marks, best.changes);
  ({ best, stream } = await withRingRatio(marks, values, best, stream));
  // Fewer wrong ellipses in the marked frames do not outweigh targets lost in other frames.
  const isNeeded = best.verdict.right > start.verdict.right || stream.right > now.right;
  if (!isNeeded && stream.found < now.found) [best, stream] = [start, now];
  const { verdict } = best;
  const admitted = admittingTrial(marks, { ...values, ...best.changes }, defaults)?.changes ?? {};
  const reasons = [];
  for (const [i, mark] of marks.entries()) {
    const [outcome, target] = [verdict.outcomes[i], verdict.targets[i]];
    reasons.push(outcome === "right" ? "" : await reasonFor(mark, outcome, target, { ...best, admitted }));
  }
  return {
    changes: best.changes,
    why: best.why,
    before: { verdict: start.verdict, stream: now },
    after: { verdict, stream },
    reasons,
  };
}

/**
 * Frames in which the target differs between two streams, in groups of neighbours.
 * @returns [{from, to, kind}]: positions in the stream; "found", "not found" or "another ellipse".
 */
export function differencesOf(before, after) {
  const groups = [];
  [...before.targets.keys()].forEach((frame, i) => {
    const [a, b] = [before.targets.get(frame), after.targets.get(frame) ?? null];
    if ((!a && !b) || (a && b && isSame(a, b))) return;
    const kind = a && b ? "another ellipse" : b ? "found" : "not found";
    const last = groups.at(-1);
    if (last?.kind === kind && last.to === i - 1) last.to = i;
    else groups.push({ from: i, to: i, kind });
  });
  return groups;
}
