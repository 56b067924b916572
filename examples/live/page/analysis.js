// SPDX-License-Identifier: MIT
// What the detector makes of the frame on the screen, apart from the pipeline.
import { ask } from "./connection.js";

/** So many refused candidates are shown until a person asks for all. */
export const kBest = 8;

/**
 * @param properties  {name: value} that differ from the settings of now.
 * @param stage       The stage whose picture is wanted, or undefined.
 * @returns what the program tells, with `image` (ImageBitmap or null) of the stage, and `groups`:
 *          one for each reason, the target's first, then by how many; `best`: a Set of
 *          the numbers of the kBest refused that missed their limits by the least.
 */
export async function analyze({ properties, stage } = {}) {
  const result = await ask("POST", "api/analyze", { properties, stage });
  result.image = result.picture ? await bitmapOf(result.picture) : null;
  result.groups = groupsOf(result);
  result.best = bestOf(result.groups);
  return result;
}

async function bitmapOf(dataUrl) {
  const bytes = Uint8Array.from(atob(dataUrl.slice(dataUrl.indexOf(",") + 1)), (c) => c.charCodeAt(0));
  return createImageBitmap(new Blob([bytes], { type: "image/png" }));
}

/** How close a candidate came: 0 = at the limit. What has no figure comes last. */
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
  const refused = groups.flatMap(({ members }) => members).filter(({ ellipse, found }) => ellipse && !found);
  const measured = refused.filter((candidate) => Number.isFinite(missOf(candidate)));
  return new Set(measured.sort((a, b) => missOf(a) - missOf(b)).slice(0, kBest).map(({ number }) => number));
}

/** The look of a candidate, for drawing. */
export function lookOf({ is_target: isTarget, found }) {
  return isTarget ? "tracked" : found ? "candidate" : "refused";
}

/** "72 × 51 px at (312, 180)" */
export function placeText({ semi_major: a, semi_minor: b, cx, cy }) {
  return `${(2 * a).toFixed(0)} × ${(2 * b).toFixed(0)} px at (${cx.toFixed(0)}, ${cy.toFixed(0)})`;
}
