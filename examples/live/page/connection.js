// SPDX-License-Identifier: MIT
// How the page talks with the program: requests, and sockets that come back by themselves.

/** Asks for something. Throws an Error with the program's own words where it refuses. */
export async function ask(method, path, body) {
  const wants = body === undefined ? {} : {
    body: JSON.stringify(body),
    headers: { "Content-Type": "application/json" },
  };
  const answer = await fetch(path, { method, ...wants });
  const text = await answer.text();
  const isJson = answer.headers.get("Content-Type")?.startsWith("application/json");
  const value = isJson && text ? JSON.parse(text) : text;
  if (!answer.ok) throw new Error(value?.error || `${answer.status} ${answer.statusText}`);
  return value;
}

/**
 * A WebSocket that is opened again when it is lost: after half a second, at most after five.
 * @param onMessage  Gets the data and the socket it came by.
 * @param onChange   Gets whether it is open.
 */
export function openSocket(path, onMessage, onChange = () => {}) {
  let wait = 500;
  const open = () => {
    const socket = new WebSocket(new URL(path, location.href.replace(/^http/, "ws")));
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      wait = 500;
      onChange(true);
    };
    socket.onmessage = (event) => onMessage(event.data, socket);
    socket.onclose = () => {
      onChange(false);
      setTimeout(open, wait);
      wait = Math.min(2 * wait, 5000);
    };
  };
  open();
}

/**
 * Runs a task over and over, never twice at a time: while one runs, the newest request waits.
 * @returns a function that asks for a run with these arguments.
 */
export function newestOnly(task) {
  let isBusy = false;
  let next = null;
  return async function run(...args) {
    if (isBusy) {
      next = args;
      return;
    }
    isBusy = true;
    try {
      await task(...args);
    } finally {
      isBusy = false;
      if (next) {
        const waiting = next;
        next = null;
        run(...waiting);
      }
    }
  };
}
