// SPDX-License-Identifier: MIT
// Matches pictures with their JSON lines by timestamp.
import { openSocket } from "./connection.js";

const kMaxLines = 256;
const kLineTimeoutMs = 250;

/**
 * Calls onFrame({pts, bitmap, line}) for each picture when the browser is about to paint. `line` is
 * the line of the same frame, or null if none arrived. A picture is acknowledged when onFrame
 * returns, and the program sends more only then. A hidden page paints nothing and receives no more.
 */
export function watchFrames({ onFrame, onLine, onConnection }) {
  const lines = new Map();  // by timestamp, in order of arrival
  let waiting = null;       // picture that arrived before its line
  let next = null;          // picture to paint next
  let arrived = 0;          // number of pictures
  let decoded = 0;          // number of the last decoded picture
  const isOpen = { video: false, meta: false };

  const show = ({ pts, bitmap, socket }) => {
    clearTimeout(waiting?.timer);
    waiting = null;
    const line = lines.get(pts) ?? null;
    // Older lines belong to skipped pictures.
    if (line) {
      for (const old of lines.keys()) {
        lines.delete(old);
        if (old === pts) break;
      }
    }
    if (next) next.bitmap.close();
    else requestAnimationFrame(paint);
    next = { pts, bitmap, line, socket };
  };

  // An acknowledgement covers all earlier pictures.
  const paint = () => {
    const { socket, ...frame } = next;
    next = null;
    onFrame(frame);
    if (socket.readyState === WebSocket.OPEN) socket.send(`{"ack":${frame.pts}}`);
  };

  const takePicture = async (data, socket) => {
    const pts = String(new DataView(data).getBigUint64(0, true));
    const number = ++arrived;
    let bitmap;
    try {
      bitmap = await createImageBitmap(new Blob([new Uint8Array(data, 8)], { type: "image/jpeg" }));
    } catch {
      socket.send(`{"ack":${pts}}`);
      return;
    }
    if (number < decoded) return bitmap.close();  // a newer one was decoded first
    decoded = number;
    if (waiting) show(waiting);
    const picture = { pts, bitmap, socket };
    if (lines.has(pts)) {
      show(picture);
      return;
    }
    waiting = { ...picture, timer: setTimeout(() => show(picture), kLineTimeoutMs) };
  };

  const takeLine = (text) => {
    const line = JSON.parse(text);
    const pts = exactPts(text);
    lines.delete(pts);
    lines.set(pts, line);
    if (lines.size > kMaxLines) lines.delete(lines.keys().next().value);
    onLine(line);
    if (waiting?.pts === pts) show(waiting);
  };

  const notifyOpen = (which) => (open) => {
    isOpen[which] = open;
    onConnection(isOpen.video && isOpen.meta);
  };
  openSocket("ws/video", takePicture, notifyOpen("video"));
  openSocket("ws/meta", takeLine, notifyOpen("meta"));
}

// JSON.parse() reads numbers as doubles, which cannot represent nanoseconds since 1970 exactly.
function exactPts(text) {
  return /"pts_ns":(\d+)/.exec(text)?.[1] ?? "";
}
