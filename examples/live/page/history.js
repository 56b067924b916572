// SPDX-License-Identifier: MIT
// Requests for the stored frames, on which settings are compared.
import { ask } from "./connection.js";

/** Starts or stops storing frames. @returns as storedFrames(). */
export const storeFrames = (storing) => ask("PUT", "api/history", { storing });

/** @returns {storing, full, max_frames, frames: [{frame, pts_ns, has_target}]}, the oldest frame first. */
export const storedFrames = () => ask("GET", "api/history");

/** Discards the stored frames. */
export const discardFrames = () => ask("DELETE", "api/history");

/** Pauses and shows a stored frame. */
export const showStored = (frame) => ask("POST", "api/history/show", { frame });

/**
 * Analyses stored frames with other settings.
 * @param properties  {name: value} that replace current settings.
 * @param frames      Numbers of frames to analyse as single frames; undefined = all, as one stream.
 * @returns [{frame, target}]; for single frames also `found`, all ellipses that were found.
 */
export async function replay(properties, frames) {
  return (await ask("POST", "api/history/replay", { properties, frames })).frames;
}
