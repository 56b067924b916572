// SPDX-License-Identifier: MIT
// The last frames that the program stores, for settings to be compared on them.
import { ask } from "./connection.js";

/** Begins or ends to store frames. @returns as storedFrames(). */
export const storeFrames = (storing) => ask("PUT", "api/history", { storing });

/** @returns {storing, full, max_frames, frames: [{frame, pts_ns}]}, the oldest frame first. */
export const storedFrames = () => ask("GET", "api/history");

/** Discards the stored frames. */
export const discardFrames = () => ask("DELETE", "api/history");

/** Pauses and shows a stored frame. */
export const showStored = (frame) => ask("POST", "api/history/show", { frame });

/**
 * Analyses stored frames with other settings.
 * @param properties  {name: value} that replace current settings.
 * @param frames      Numbers of frames that are analysed each by itself; undefined = all, as one stream.
 * @returns [{frame, target}]; for single frames also `found`, all ellipses that were found.
 */
export async function replay(properties, frames) {
  return (await ask("POST", "api/history/replay", { properties, frames })).frames;
}
