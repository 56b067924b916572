// SPDX-License-Identifier: MIT
// Communication with the program: HTTP requests, and WebSockets that reconnect.

/** Sends a request. Throws an Error with the program's message and the `status` if it fails. */
export async function ask(method, path, body) {
  const init = body === undefined ? {} : {
    body: JSON.stringify(body),
    headers: { "Content-Type": "application/json" },
  };
  const answer = await fetch(path, { method, ...init });
  const text = await answer.text();
  const isJson = answer.headers.get("Content-Type")?.startsWith("application/json");
  const value = isJson && text ? JSON.parse(text) : text;
  if (!answer.ok) {
    const message = value?.error || `${answer.status} ${answer.statusText}`;
    throw Object.assign(new Error(message), { status: answer.status });
  }
  return value;
}

/**
 * Opens a WebSocket that reconnects after 0.5 s, then at doubling intervals up to 5 s.
 * @param onMessage  Called with the data and the socket.
 * @param onChange   Called with whether it is open.
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
 * Wraps an async task so that only one call runs at a time. While it runs, only the newest of the
 * further calls is kept, and runs next.
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
