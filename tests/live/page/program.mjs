// SPDX-License-Identifier: MIT
// ellipse-live as a process, and a browser that shows its page.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { setTimeout } from "node:timers/promises";
import { chromium } from "playwright-core";

/** Timeout. An idle machine answers at once, a busy one late. */
export const kTimeoutMs = 120_000;
const kTooOften = 429;

/** Programs started and not yet stopped. */
const running = new Set();

/** Stops programs that failed tests left running; the test process would wait for them. */
export async function stopPrograms() {
  await Promise.all([...running].map((program) => program.stop()));
}

/**
 * Starts the program at a free port. The kernel ends it together with this process, so killed tests leave none
 * behind.
 * @returns {url, stop, ask}: ask talks to its API.
 */
export async function startProgram(...args) {
  const command = ["--pdeathsig", "KILL", process.env.ELLIPSE_LIVE, "--port", "0", ...args];
  const env = { ...process.env, G_DEBUG: "fatal-criticals" };
  const child = spawn("setpriv", command, { env });
  let output = "";
  child.stderr.on("data", (data) => { output += data; });
  const url = await new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => {
      output += data;
      const found = /(http:\/\/\S+)/.exec(output);
      if (found) resolve(found[1]);
    });
    child.once("error", (error) => reject(new Error(`ellipse-live cannot be started: ${error.message}`)));
    child.once("exit", () => reject(new Error(`ellipse-live has ended: ${output}`)));
  });
  // Repeats a request that the rate limit rejected, as polling clients do.
  const ask = async (method, path, body) => {
    const askOnce = () => fetch(new URL(path, url), { method, body: body && JSON.stringify(body) });
    let answer = await askOnce();
    while (answer.status === kTooOften) {
      await answer.text();
      await setTimeout(100);
      answer = await askOnce();
    }
    const text = await answer.text();
    if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${text}`);
    try {
      return JSON.parse(text);
    } catch {
      return text;
    }
  };
  const stop = async () => {
    if (child.exitCode !== null || child.signalCode !== null) return;
    child.kill("SIGINT");
    await once(child, "exit");
  };
  const program = { url, ask, stop };
  running.add(program);
  child.once("exit", () => running.delete(program));
  return program;
}

/** A headless browser. */
export function startBrowser() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--disable-dev-shm-usage"],
    timeout: kTimeoutMs,
  });
}

/**
 * Opens the page and waits for this number of frames. The page's storage marks the guide as seen, so it stays closed.
 * Errors on the page are collected in `page.troubles`.
 */
export async function openPage(browser, url, size = { width: 1440, height: 900 }, frames = 3) {
  const page = await browser.newPage({ viewport: size });
  await page.addInitScript(() => localStorage.setItem("ellipse-live-guide", "seen"));
  page.setDefaultTimeout(kTimeoutMs);
  page.troubles = [];
  page.on("pageerror", (error) => page.troubles.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") page.troubles.push(message.text());
  });
  page.on("request", (request) => {
    const { protocol, host } = new URL(request.url());
    if (protocol.startsWith("http") && host !== new URL(url).host) page.troubles.push(request.url());
  });
  await page.goto(url);
  await page.waitForFunction((min) => Number(document.querySelector("#screen").dataset.shown) >= min, frames);
  await page.waitForSelector("[data-setting=max-axis]");
  return page;
}

/** Closes a test's pages; they would act on the program in the next test. */
export async function closePages(browser) {
  await Promise.all(browser.contexts().map((context) => context.close()));
}

/** Number of frames that the page has painted. */
export function shownBy(page) {
  return page.evaluate(() => Number(document.querySelector("#screen").dataset.shown));
}
