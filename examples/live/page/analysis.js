// SPDX-License-Identifier: MIT
// Analyses the shown frame outside the pipeline.
import { ask } from "./connection.js";

/** Number of rejected candidates that are shown by default. */
export const kBest = 8;

/**
 * @param properties  {name: value} that replace current settings, or undefined.
 * @param stage       The stage to draw, or undefined.
 * @param frame       Number of a stored frame; undefined = the shown one.
 * @returns the program's reply with three additions. `image`: the stage's picture (ImageBitmap or
 *          null). `groups`: the candidates by reason, found ones first, then by decreasing count.
 *          `best`: a Set of the numbers of the kBest rejected candidates closest to their limits.
 */
export async function analyze({ properties, stage, frame } = {}) {
  const result = await ask("POST", "api/analyze", { properties, stage, frame });
  result.image = result.picture ? await bitmapOf(result.picture) : null;
  result.groups = groupsOf(result);
  result.best = bestOf(result.groups);
  return result;
}

async function bitmapOf(dataUrl) {
  const bytes = Uint8Array.from(atob(dataUrl.slice(dataUrl.indexOf(",") + 1)), (c) => c.charCodeAt(0));
  return createImageBitmap(new Blob([bytes], { type: "image/png" }));
}

/** Relative distance to the limit: 0 = at the limit, Infinity = no measured value. */
function missOf({ measured, limit }) {
  return limit ? Math.abs(measured - limit) / Math.abs(limit) : Infinity;
}

function groupsOf({ candidates, reasons, counts }) {
  const groups = new Map(Object.keys(reasons).map((reason) => [reason, {
    reason,
    ...reasons[reason],
    members: [],
    count: counts[reason] ?? 0,
  }]));
  candidates.forEach((candidate, number) => {
    groups.get(candidate.reason).members.push({ ...candidate, number });
  });
  for (const group of groups.values()) {
    group.members.sort((a, b) => missOf(a) - missOf(b));
    group.isFound = group.members.some(({ found }) => found);
  }
  const rank = (group) => (group.reason === "accepted" ? 2 : group.isFound ? 1 : 0);
  return [...groups.values()].sort((a, b) => rank(b) - rank(a) || b.count - a.count);
}

function bestOf(groups) {
  const rejected = groups.flatMap(({ members }) => members).filter(({ ellipse, found }) => ellipse && !found);
  const measured = rejected.filter((candidate) => Number.isFinite(missOf(candidate)));
  return new Set(measured.sort((a, b) => missOf(a) - missOf(b)).slice(0, kBest).map(({ number }) => number));
}

/** Line style of a candidate: a key of kLooks. */
export function lookOf({ is_target: isTarget, found }) {
  return isTarget ? "tracked" : found ? "candidate" : "rejected";
}

/** "72 × 51 px at (312, 180)" */
export function ellipseText({ semi_major: a, semi_minor: b, cx, cy }) {
  return `${(2 * a).toFixed(0)} × ${(2 * b).toFixed(0)} px at (${cx.toFixed(0)}, ${cy.toFixed(0)})`;
}
