// SPDX-License-Identifier: MIT
// Pictures and the lines about them, brought together by their time stamps.
import { openSocket } from "./connection.js";

const kMostLines = 256;
const kPatienceMs = 250;

/**
 * Calls onFrame({pts, bitmap, line}) for each picture when the browser is about to paint: the line is
 * that of the very frame, or null where none came. The picture is acknowledged when onFrame returns,
 * so that the program sends the next one only when this one is painted; a page that nobody sees
 * paints nothing, and gets no more.
 */
export function watchFrames({ onFrame, onLine, onConnection }) {
  const lines = new Map();  // by time stamp, in the order of their arrival
  let waiting = null;       // a picture that came before its line
  let next = null;          // the picture that is painted next
  let arrived = 0;          // pictures
  let decoded = 0;          // the last one that was
  const isOpen = { video: false, meta: false };

  const show = ({ pts, bitmap, socket }) => {
    clearTimeout(waiting?.timer);
    waiting = null;
    const line = lines.get(pts) ?? null;
    // What is older belongs to pictures that were passed over.
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

  // One acknowledgement is one for all before it.
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
    if (number < decoded) return bitmap.close();  // a newer one was faster
    decoded = number;
    if (waiting) show(waiting);
    const picture = { pts, bitmap, socket };
    if (lines.has(pts)) {
      show(picture);
      return;
    }
    waiting = { ...picture, timer: setTimeout(() => show(picture), kPatienceMs) };
  };

  const takeLine = (text) => {
    const line = JSON.parse(text);
    const pts = exactPts(text);
    lines.delete(pts);
    lines.set(pts, line);
    if (lines.size > kMostLines) lines.delete(lines.keys().next().value);
    onLine(line);
    if (waiting?.pts === pts) show(waiting);
  };

  const tell = (which) => (open) => {
    isOpen[which] = open;
    onConnection(isOpen.video && isOpen.meta);
  };
  openSocket("ws/video", takePicture, tell("video"));
  openSocket("ws/meta", takeLine, tell("meta"));
}

// A number in JSON is a double here; nanoseconds since 1970 need more digits than it has.
function exactPts(text) {
  return /"pts_ns":(\d+)/.exec(text)?.[1] ?? "";
}
