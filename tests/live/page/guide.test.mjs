// SPDX-License-Identifier: MIT
//
// The guide: from the first visit to settings that find the marked target.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, describe, it } from "node:test";
import { closePages, openPage, startBrowser, startProgram } from "./program.mjs";

const kPhone = { width: 390, height: 844 };
const kTooStrict = { "min-axis": 300, "max-axis": 600, "max-axis-ratio": 1.02 };
const kStart = { "min-axis": 5, "max-axis": 32768, "max-axis-ratio": 5, "min-probability": 0.5 };
const kPoints = 10;

const textOf = (page, id) => page.textContent(`#guide-${id}`);
const isAtStep = (page, step) => page.waitForSelector(`#guide-steps [data-step=${step}][aria-current]`);

async function openGuide(browser, program, size) {
  const page = await openPage(browser, program.url, size, 1);
  await page.click("#guide-button");
  return page;
}

/** Waits for the choices of this mark, counted from 1. */
async function choicesOf(page, number) {
  await page.waitForFunction((n) => {
    const { pts } = document.querySelector("#guide-choices").dataset;
    const isOfMark = document.querySelector("#guide-frame").textContent.startsWith(`Frame ${n} of`);
    return isOfMark && pts && pts === document.querySelector("#screen").dataset.pts;
  }, number);
}

async function beginMarks(page) {
  await page.waitForSelector("#guide-begin:enabled");
  await page.click("#guide-begin");
  await choicesOf(page, 1);
}

/** The target in the program's current frame with the initial settings. */
async function targetOf(program) {
  const { candidates, width, height } = await program.ask("POST", "/api/analyze", { properties: kStart });
  return { ...candidates.find((each) => each.is_target).ellipse, width, height };
}

/** Clicks a point of the outline, given by its angle from the major axis. */
async function clickOutline(page, e, angle) {
  const [u, v] = [e.semi_major * Math.cos(angle), e.semi_minor * Math.sin(angle)];
  const x = e.cx + u * Math.cos(e.angle_rad) - v * Math.sin(e.angle_rad);
  const y = e.cy + u * Math.sin(e.angle_rad) + v * Math.cos(e.angle_rad);
  const box = await page.locator("#screen").boundingBox();
  await page.click("#screen", {
    position: { x: (x + 0.5) / e.width * box.width, y: (y + 0.5) / e.height * box.height },
  });
}

async function markByClick(page, program, number) {
  await choicesOf(page, number);
  await clickOutline(page, await targetOf(program), 0);
  await page.click("#guide-mark:enabled");
}

async function markByHand(page, e, number) {
  await choicesOf(page, number);
  await page.check("#guide-choices input[value=drawn]");
  for (let i = 0; i < kPoints; ++i) await clickOutline(page, e, 2 * Math.PI * i / kPoints);
  await page.click("#guide-mark:enabled");
}

async function markNone(page, number) {
  await choicesOf(page, number);
  await page.check("#guide-choices input[value=none]");
  await page.click("#guide-mark:enabled");
}

async function resultOf(page) {
  await page.waitForSelector("#guide-result h3");
  return page.innerText("#guide-result");
}

/** A number in the table of effects. @param column  0 = now, 1 = proposed. */
function cellOf(page, row, column) {
  return page.locator("#guide-result tr", { hasText: row }).locator("td").nth(column).textContent();
}

describe("the guide", () => {
  const labels = mkdtempSync(join(tmpdir(), "ellipse-guide-"));
  let browser;
  let program;
  before(async () => {
    browser = await startBrowser();
    program = await startProgram("--source", "test:orbit", "--labels", labels);
  });
  afterEach(async () => {
    await closePages(browser);
    await program.ask("PUT", "/api/properties", { ...kStart, "roi-source": "none" });
    await program.ask("POST", "/api/play");
  });
  after(async () => {
    await browser.close();
    await program.stop();
    rmSync(labels, { recursive: true });
  });

  it("opens at the first visit only", async () => {
    const context = await browser.newContext();
    for (const isFirst of [true, false]) {
      const page = await context.newPage();
      await page.goto(program.url);
      await page.waitForSelector(isFirst ? "#guide" : "#panel-tune");
      assert.equal(await page.isVisible("#guide"), isFirst);
      assert.equal(await page.isVisible("#panel-tune"), !isFirst);
      await page.close();
    }
    await context.close();
  });

  it("reports the target", async () => {
    const page = await openGuide(browser, program);
    await page.waitForFunction(() => /test:orbit is playing. A target is tracked: \d+ × \d+ px/
      .test(document.querySelector("#guide-state").textContent));
    await program.ask("PUT", "/api/properties", kTooStrict);
    await program.ask("PUT", "/api/properties", { tracking: "none" });
    await page.waitForFunction(() => /No target is found/.test(document.querySelector("#guide-state").textContent));
    await program.ask("PUT", "/api/properties", { tracking: "edges" });
  });

  it("closes by Escape and Skip at any step and resumes playback", async () => {
    const page = await openGuide(browser, program);
    await isAtStep(page, "see");
    assert.ok(await page.evaluate(() => document.activeElement.id === "guide"));
    await page.keyboard.press("Escape");
    await page.waitForSelector("#guide", { state: "hidden" });
    assert.ok(await page.evaluate(() => document.activeElement.id === "guide-button"));
    await page.keyboard.press("Enter");
    await beginMarks(page);
    assert.equal((await program.ask("GET", "/api/source")).playing, false);
    await page.click("#guide-skip");
    await page.waitForSelector("#panel-tune");
    await page.waitForSelector("#play[aria-label=Pause]");
    assert.equal((await program.ask("GET", "/api/source")).playing, true);
    assert.equal((await program.ask("GET", "/api/history")).frames.length, 0);
    assert.deepEqual(page.troubles, []);
  });

  it("proposes limits that admit the marked target, and applies them", async () => {
    await program.ask("PUT", "/api/properties", kTooStrict);
    const page = await openGuide(browser, program);
    await beginMarks(page);
    for (let i = 1; i <= 3; ++i) await markByClick(page, program, i);
    const text = await resultOf(page);
    assert.match(text, /Proposed settings/);
    assert.match(text, /Minor axis of your marks: .* px. 300 px rejects 3 of 3/);
    assert.match(text, /Axis ratio of your marks: .* 1.02 rejects 3 of 3/);
    // A limit may follow that rejects another ellipse; which frames are marked depends on time.
    for (const name of ["min-axis", "max-axis-ratio"]) assert.ok(await page.isVisible(`[data-proposed=${name}]`), name);
    assert.equal(await cellOf(page, "Marks right, single frames", 0), "0 of 3");
    assert.equal(await cellOf(page, "Marks right, single frames", 1), "3 of 3");
    assert.match(await cellOf(page, "Frames with a target", 0), /^0 of/);
    const [found, all] = (await cellOf(page, "Frames with a target", 1)).split(" of ").map(Number);
    assert.ok(found >= 0.9 * all, `${found} of ${all}`);
    const before = await page.getAttribute("#screen", "data-pts");
    await page.locator(".frames button", { hasText: "Mark 3" }).click();
    await page.waitForFunction((old) => document.querySelector("#screen").dataset.pts !== old, before);
    await page.click("#guide-apply");
    await page.getByText("Applied.").waitFor();
    await page.click("#guide-discard");
    await page.waitForSelector("#state[data-state=tracked]");
    assert.equal(await page.locator("[data-setting=min-axis].changed").count(), 0);
    assert.deepEqual(page.troubles, []);
  });

  it("proposes a limit that rejects the wrong target", async () => {
    const page = await openGuide(browser, program);
    await beginMarks(page);
    for (let i = 1; i <= 3; ++i) {
      await choicesOf(page, i);
      // The inner edge of the ring.
      const e = await targetOf(program);
      const limits = { "max-axis": 1.8 * e.semi_major };
      const { candidates } = await program.ask("POST", "/api/analyze", { properties: limits });
      const inner = candidates.find((each) => each.is_target).ellipse;
      await clickOutline(page, { ...e, ...inner }, Math.PI / 2);
      await page.click("#guide-mark:enabled");
    }
    const text = await resultOf(page);
    assert.match(text, /max-axis: 32768 → \d+/);
    assert.match(text, /Major axis of your marks: .* px; of 3 wrong ellipses: .* px/);
    assert.equal(await cellOf(page, "Marks right, single frames", 0), "0 of 3");
    assert.equal(await cellOf(page, "Marks right, single frames", 1), "3 of 3");
  });

  it("proposes a probability between the marks and other ellipses", async () => {
    await program.ask("PUT", "/api/properties", { "min-probability": 0.999999 });
    const page = await openGuide(browser, program);
    await beginMarks(page);
    for (let i = 1; i <= 3; ++i) await markByClick(page, program, i);
    const text = await resultOf(page);
    // Which frames are marked depends on time, and so does what else is found in them.
    assert.match(text, /min-probability: 0.999999 → 0\.\d+/);
    const [, proposed] = text.match(/min-probability: 0.999999 → (0\.\d+)/);
    const [, ofMarks, , ofOthers = "0"] =
      text.match(/Probability of your marks: at least (\d\.\d\d); of other ellipses: (none found|at most (\d\.\d\d))/);
    assert.ok(Number(ofMarks) >= Number(proposed) && Number(proposed) >= Number(ofOthers), text);
    assert.equal(await cellOf(page, "Marks right, single frames", 1), "3 of 3");
    await page.click("#guide-apply");
    await page.getByText("Applied.").waitFor();
  });

  it("changes nothing when the settings are right", async () => {
    const page = await openGuide(browser, program);
    await beginMarks(page);
    for (let i = 1; i <= 3; ++i) await markByClick(page, program, i);
    assert.match(await resultOf(page), /The current settings are right on your 3 marks/);
    assert.equal(await page.locator("#guide-apply").isVisible(), false);
    assert.equal(await textOf(page, "discard"), "Done");
  });

  it("saves hand-drawn marks and frames without a target as labels", async () => {
    await program.ask("PUT", "/api/properties", kTooStrict);
    const page = await openGuide(browser, program);
    await beginMarks(page);
    await markByHand(page, await targetOf(program), 1);
    await markNone(page, 2);
    await choicesOf(page, 3);
    await markByHand(page, await targetOf(program), 3);
    const text = await resultOf(page);
    assert.match(text, /Mark 2: An ellipse of .* is reported in a frame without a target/);
    assert.equal(await cellOf(page, "Marks right, single frames", 1), "2 of 3");
    const rows = readFileSync(join(labels, "gt.csv"), "utf8").trim().split("\n");
    assert.ok(rows.length > 3, rows.join("\n"));
    await page.click("#guide-discard");
    const properties = await program.ask("GET", "/api/properties");
    assert.equal(properties.find(({ name }) => name === "min-axis").value, 300);
  });

  it("explains why a mark is not found and links to the documentation", async () => {
    const page = await openGuide(browser, program);
    await beginMarks(page);
    const nowhere = { cx: 60, cy: 50, semi_major: 40, semi_minor: 30, angle_rad: 0.3, width: 640, height: 360 };
    for (let i = 1; i <= 3; ++i) await markByHand(page, nowhere, i);
    const text = await resultOf(page);
    assert.match(text, /None of the tried settings is right on more than 0 of your 3 marks/);
    assert.match(text, /Mark 1: (No candidate is near your mark|Its edges do not support an ellipse)/);
    const help = await page.locator("#guide-result a").getAttribute("href");
    assert.match(await program.ask("GET", `/${help}`), /^# Troubleshooting/);
  });

  it("restarts when the frames are no longer stored", async () => {
    const page = await openGuide(browser, program);
    await beginMarks(page);
    await program.ask("DELETE", "/api/history");
    await markNone(page, 1);
    await page.getByText("The frames are no longer stored").waitFor();
    await page.click("#guide-again");
    await isAtStep(page, "see");
    await beginMarks(page);
  });

  it("waits for frames of this visit", async () => {
    const page = await openGuide(browser, program);
    await page.waitForSelector("#guide-begin:enabled");
    let answer;
    const isAnswered = new Promise((resolve) => { answer = resolve; });
    await page.route("**/api/history", async (route) => {
      await isAnswered;
      await route.continue();
    });
    await page.keyboard.press("Escape");
    await page.keyboard.press("Enter");
    await isAtStep(page, "see");
    assert.ok(await page.isDisabled("#guide-begin"));
    answer();
    await beginMarks(page);
    assert.deepEqual(page.troubles, []);
  });

  it("marks frames without a target first", async () => {
    await program.ask("PUT", "/api/properties", { ...kTooStrict, tracking: "none" });
    const page = await openGuide(browser, program);
    const storedFrames = async () => (await program.ask("GET", "/api/history")).frames;
    while ((await storedFrames()).length < 3);
    await program.ask("PUT", "/api/properties", { ...kStart, tracking: "edges" });
    await beginMarks(page);
    const frames = await storedFrames();
    assert.ok(frames[Math.floor(frames.length / 6)].has_target, "the middle of the first third");
    const shown = await page.getAttribute("#screen", "data-pts");
    assert.equal(frames.find((frame) => frame.pts_ns === shown).has_target, false);
    await markNone(page, 1);
    await choicesOf(page, 2);
    assert.equal(await page.getAttribute("#screen", "data-pts"), frames[Math.floor(frames.length / 2)].pts_ns);
  });

  it("leaves frames that another client marks", async () => {
    const waiting = await openGuide(browser, program);
    await waiting.waitForSelector("#guide-begin:enabled");
    const marking = await openGuide(browser, program);
    await beginMarks(marking);
    const { storing, frames } = await program.ask("GET", "/api/history");
    assert.equal(storing, false);
    for (const _ of [1, 2]) await waiting.waitForResponse("**/api/history");  // after a whole poll
    assert.deepEqual(await program.ask("GET", "/api/history").then((now) => now.frames), frames);
    await markNone(marking, 1);
    await choicesOf(marking, 2);
    assert.ok(await waiting.isEnabled("#guide-begin"));
  });

  it("continues after a lost connection and when another client plays", async () => {
    const page = await openGuide(browser, program);
    await beginMarks(page);
    await page.route("**/api/history/show", (route) => route.abort(), { times: 1 });
    await markNone(page, 1);
    await page.getByText("No connection to ellipse-live").waitFor();
    await page.click("#guide-again");
    await choicesOf(page, 2);
    await program.ask("POST", "/api/play");
    await page.getByText("The source is playing").waitFor();
    await page.click("#guide-again");
    await choicesOf(page, 2);
    await markNone(page, 2);
    await choicesOf(page, 3);
  });

  it("derives trials from the marks", async () => {
    const page = await openPage(browser, program.url, undefined, 1);
    const { ratio, none, region, probability, close, smallest, largest } = await page.evaluate(async () => {
      const { ringRatioOf, trialsFor } = await import("/trials.js");
      const circle = (cx, radius) => ({ cx, cy: 100, semi_major: radius, semi_minor: radius, angle_rad: 0 });
      const arcs = (ellipse, chance) => ({ ellipse, probability: chance, detector: "arcs" });
      const mark = (...candidates) => ({ truth: circle(100, 50), candidates, width: 1000, height: 500 });
      const ring = mark(arcs(circle(100, 40), 0.9), arcs(circle(100, 50), 0.2), arcs(circle(800, 20), 0.1));
      const values = {
        "min-axis": 5, "max-axis": 32768, "max-axis-ratio": 5, "min-contour-size": 50, "min-probability": 0.5,
        "edge-low": 0, "edge-high": 0, "roi-source": "none", roi: [], detector: "arcs",
      };
      const wrong = [circle(800, 50)];
      const defaults = { ...values, "max-axis": 90 };
      const trialOf = (name, marks, strict = {}) => {
        const settings = { ...values, ...strict };
        return trialsFor({ marks, values: settings, defaults, wrong, rivals: [], isRight: false })
          .find(({ changes }) => name in changes)?.changes;
      };
      return {
        ratio: ringRatioOf([ring, ring]),
        none: ringRatioOf([ring, mark(arcs(circle(100, 50), 0.9))]),
        region: trialOf("roi", [ring]),
        probability: trialOf("min-probability", [ring]),
        close: trialOf("min-probability", [mark(arcs(circle(100, 50), 0.9991), arcs(circle(800, 20), 0.9952))],
          { "min-probability": 0.9999 }),
        // The default admits the mark of 100 px in one case only.
        smallest: trialOf("min-axis", [ring], { "min-axis": 300 }),
        largest: trialOf("max-axis", [ring], { "max-axis": 50 }),
      };
    });
    assert.equal(ratio, 0.8);
    assert.equal(none, null);
    assert.deepEqual(region, { roi: [0, 0, 250, 250], "roi-source": "property" });
    assert.equal(smallest["min-axis"], 5);
    assert.equal(largest["max-axis"], 140);
    const limit = probability["min-probability"];
    assert.ok(limit > 0.1 && limit < 0.2, String(limit));
    assert.equal(close["min-probability"], 0.997);
  });

  it("keeps the video and its buttons in view on a phone", async () => {
    const page = await openGuide(browser, program, kPhone);
    const isInView = async (selector) => {
      const { x, y, width, height } = await page.locator(selector).boundingBox();
      assert.ok(x >= 0 && y >= 0 && x + width <= kPhone.width && y + height <= kPhone.height,
        `${selector}: ${x}, ${y}, ${width} × ${height}`);
    };
    const check = async (...selectors) => {
      for (const selector of ["#screen", ...selectors]) await isInView(selector);
      const video = await page.locator("#screen").boundingBox();
      const steps = await page.locator("#guide-steps").boundingBox();
      assert.ok(steps.y >= video.y + video.height, "the guide covers the video");
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "too wide");
    };
    await page.waitForSelector("#guide-begin:enabled");
    await check("#guide-begin", "#guide-skip");
    await beginMarks(page);
    for (let i = 1; i <= 3; ++i) {
      await choicesOf(page, i);
      await check("#guide-mark", "#guide-skip");
      await markByClick(page, program, i);
    }
    await resultOf(page);
    await check("#guide-discard", "#guide-skip");
  });
});

describe("the guide with a file", () => {
  let browser;
  let program;
  before(async () => {
    browser = await startBrowser();
    program = await startProgram("--source", process.env.ELLIPSE_TEST_VIDEO);
  });
  after(async () => {
    await browser.close();
    await program.stop();
  });

  it("replays a file that has ended", async () => {
    const page = await openPage(browser, program.url, undefined, 1);
    await page.waitForSelector("#play[aria-label=Play]");
    await page.click("#guide-button");
    await page.waitForFunction(() => /has ended/.test(document.querySelector("#guide-state").textContent));
    await page.click("#guide-play");
    await beginMarks(page);
    for (let i = 1; i <= 3; ++i) await markByClick(page, program, i);
    assert.match(await resultOf(page), /right on your 3 marks/);
    assert.deepEqual(page.troubles, []);
  });
});
