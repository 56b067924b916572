// SPDX-License-Identifier: MIT
//
// The page in a real browser, with the real program.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, beforeEach, describe, it } from "node:test";
import { setTimeout } from "node:timers/promises";
import { closePages, kTimeoutMs, openPage, shownBy, startBrowser, startProgram, stopPrograms } from "./program.mjs";
import "./guide.test.mjs";
import "./layout.test.mjs";
import { largestDistance } from "./ring.mjs";

process.env.XDG_DATA_HOME = mkdtempSync(join(tmpdir(), "ellipse-live-"));

let browser;
before(async () => { browser = await startBrowser(); });
after(async () => {
  await browser.close();
  await stopPrograms();
  rmSync(process.env.XDG_DATA_HOME, { recursive: true });
});

/** Each test opens its own pages, which are closed after it, and shares the program. */
function withProgram(args, tests) {
  const context = {};
  before(async () => { context.program = await startProgram(...args()); });
  beforeEach(async () => {
    await closePages(browser);
    await context.program.ask("POST", "/api/play");
  });
  after(async () => { await context.program.stop(); });
  tests({
    get program() { return context.program; },
    labels: join(process.env.XDG_DATA_HOME, "labels/gt.csv"),
    open: async (size, frames) => openPage(browser, context.program.url, size, frames),
  });
}

const readRows = (file) => readFileSync(file, "utf8").trim().split("\n");
const setting = (page, name) => page.locator(`[data-setting="${name}"]`);
const stateIs = (page, state) => page.waitForSelector(`#state[data-state=${state}]`);

/** Polls until there is a result; @returns it. */
async function eventually(what, look) {
  for (const end = Date.now() + kTimeoutMs; Date.now() < end;) {
    const found = await look();
    if (found !== undefined) return found;
    await setTimeout(20);
  }
  assert.fail(`not within ${kTimeoutMs} ms: ${what}`);
}

/** The values of all properties once the program has this one: it arrives after the page shows it. */
function propertiesOnce(program, name, isSo) {
  return eventually(name, async () => {
    const all = await program.ask("GET", "/api/properties");
    const values = Object.fromEntries(all.map((property) => [property.name, property.value]));
    return isSo(values[name]) ? values : undefined;
  });
}

/** Waits until it is paused and the screen shows the program's current frame; @returns its time [ns]. */
function standsStill(page, program) {
  return eventually("it stands still", async () => {
    const { state, pts_ns: pts } = await program.ask("GET", "/api/source");
    const shown = await page.evaluate(() => document.querySelector("#screen").dataset.pts);
    return ["paused", "held"].includes(state) && shown === String(pts) ? pts : undefined;
  });
}

/** Drags the scrub bar and waits for the program's answer. */
async function scrubTo(page, position) {
  const isSought = page.waitForResponse((answer) => answer.url().endsWith("/api/seek"));
  await page.locator("#scrub").fill(position);
  await isSought;
}

/** Waits for the choices of the frame on the screen, unless its time is `before`; @returns its time. */
async function choicesAreThere(page, before = null) {
  const shown = await page.waitForFunction((old) => {
    const { pts } = document.querySelector("#label-choices").dataset;
    return pts && pts !== old && pts === document.querySelector("#screen").dataset.pts && pts;
  }, before);
  return shown.jsonValue();
}

// Its pad is always fully in the picture, at a constant size.
describe("a live source", () => withProgram(() => ["--source", "test:orbit"], (live) => {
  // Resets the properties that the last test changed.
  beforeEach(async () => {
    const properties = await live.program.ask("GET", "/api/properties");
    const others = properties.filter(({ type }) => type !== "flags");
    await live.program.ask("PUT", "/api/properties", Object.fromEntries(others.map((p) => [p.name, p.default])));
  });

  it("is shown with its figures", async () => {
    const page = await live.open();
    const first = await shownBy(page);
    await page.waitForFunction((n) => document.querySelector("#screen").dataset.shown > n + 10, first);
    await stateIs(page, "tracked");
    assert.match(await page.textContent("#figure-time"), /^\d+\.\d\d ms$/);
    assert.equal(await page.textContent("#figure-tracker"), "following");
    await page.waitForFunction(() => document.querySelector("#source-name").textContent === "test:orbit");
    assert.deepEqual(page.troubles, []);
  });

  it("shows its frame to clients that connect while it is paused", async () => {
    await live.program.ask("POST", "/api/pause");
    const page = await live.open(undefined, 1);
    await stateIs(page, "tracked");
    assert.equal(await shownBy(page), 1);
    const isShown = await page.evaluate(() => new Promise((resolve) => {
      const image = new Image();
      image.onload = () => resolve(image.naturalWidth > 0);
      image.src = "video.mjpeg";
    }));
    assert.ok(isShown);
  });

  it("shows no rate if the clock stands still", async () => {
    const page = await browser.newPage();
    page.setDefaultTimeout(kTimeoutMs);
    await page.addInitScript(() => { performance.now = () => 5; });
    await page.goto(live.program.url);
    await page.waitForFunction(() => Number(document.querySelector("#screen").dataset.shown) >= 3);
    assert.equal(await page.textContent("#figure-shown"), "–");
    assert.equal(await page.textContent("#figure-rate"), "–");
  });

  it("applies a slider to the property and the result", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await setting(page, "tracking").getByText("none", { exact: true }).click();
    const slider = setting(page, "max-axis").locator("input[type=range]");
    await slider.fill("200");
    await stateIs(page, "lost");
    assert.equal(await page.textContent("#figure-tracker"), "searching");
    const properties = await live.program.ask("GET", "/api/properties");
    const { value } = properties.find(({ name }) => name === "max-axis");
    assert.ok(value > 5 && value < 10, `max-axis is ${value}`);
    await slider.focus();
    await slider.press("ArrowRight");
    await page.waitForFunction((before) => {
      return document.querySelector("[data-setting=max-axis] input[type=number]").value > before;
    }, value);
    await setting(page, "max-axis").getByRole("button", { name: "Reset max-axis" }).click();
    await setting(page, "tracking").getByRole("button", { name: "Reset tracking" }).click();
    await stateIs(page, "tracked");
    await page.waitForSelector("#reset-all:disabled");
  });

  it("shows why a value is rejected, and the value in force", async () => {
    const page = await live.open();
    const field = setting(page, "max-axis").locator("input[type=number]");
    const before = await field.inputValue();
    await field.fill("3");  // below min-axis
    await field.press("Enter");
    await page.waitForFunction(() => /axis/.test(document.querySelector("[data-setting=max-axis] .error").textContent));
    await field.blur();
    await page.waitForFunction((value) => {
      return document.querySelector("[data-setting=max-axis] input[type=number]").value === value;
    }, before);
  });

  it("is searched only inside a dragged region", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    const drag = async (from, to, beforeEnd = () => {}) => {
      const { x, y, width } = await page.locator("#screen").boundingBox();
      const at = ([u, v]) => [x + (u + 0.5) * width / 640, y + (v + 0.5) * width / 640];
      await page.mouse.move(...at(from));
      await page.mouse.down();
      await page.mouse.move(...at(to), { steps: 4 });
      await beforeEnd();
      await page.mouse.up();
    };
    const regionIs = (wanted) => propertiesOnce(live.program, "roi-source", (source) => source === wanted);
    await drag([120, 90], [20, 30]);  // away from the pad
    await stateIs(page, "lost");
    let { roi } = await regionIs("property");
    [20, 30, 100, 60].forEach((wanted, i) => assert.ok(Math.abs(roi[i] - wanted) <= 2, `${roi}`));
    const fields = setting(page, "roi").locator("input");
    assert.equal(await fields.nth(2).inputValue(), String(roi[2]));
    await page.keyboard.press("Escape");
    await stateIs(page, "tracked");
    await regionIs("none");

    const sent = [];
    page.on("request", (request) => request.method() === "PUT" && sent.push(request.postData()));
    await drag([120, 90], [20, 30], () => page.keyboard.press("Escape"));  // cancelled
    await page.locator("#screen").click();
    await page.locator("#screen").hover();
    assert.deepEqual(sent, []);

    await drag([300, 100], [900, 900]);  // ends at the frame's border
    ({ roi } = await regionIs("property"));
    assert.deepEqual([roi[0] + roi[2], roi[1] + roi[3]], [640, 360]);
    await page.locator("#screen").dblclick();
    await regionIs("none");
    await page.waitForSelector("[data-setting=roi]:not(.changed)", { state: "attached" });
    assert.deepEqual(page.troubles, []);
  });

  it("is searched only inside a region set by keyboard", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await page.evaluate(() => document.querySelector("[data-setting=roi]").closest("details").open = true);
    await setting(page, "roi").locator("input").first().focus();
    for (const number of ["10", "20", "80", "60"]) {
      await page.keyboard.type(number);
      await page.keyboard.press("Tab");
    }
    await setting(page, "roi-source").locator("input[value=none]").focus();
    await page.keyboard.press("ArrowRight");
    await stateIs(page, "lost");
    await page.focus("#screen");
    await page.keyboard.press("Escape");
    await stateIs(page, "tracked");
  });

  it("shows what another client sets", async () => {
    const page = await live.open();
    await live.program.ask("PUT", "/api/properties", { "edge-high": 12.5 });
    await page.waitForSelector("[data-setting=edge-high].changed");
    assert.equal(await setting(page, "edge-high").locator("input[type=number]").inputValue(), "12.5");
    await live.program.ask("PUT", "/api/properties", { "edge-high": 0 });
  });

  it("has a control with help for each property", async () => {
    const page = await live.open();
    const properties = await live.program.ask("GET", "/api/properties");
    for (const { name, blurb } of properties) {
      assert.equal(await setting(page, name).locator(".help").textContent(), blurb, name);
      assert.ok(await setting(page, name).locator("input").count() > 0, name);
    }
  });

  it("greys settings without effect and shows the reason", async () => {
    const page = await live.open();
    const idle = (name) => setting(page, name).locator(".idle").textContent();
    const once = (name, text) => page.waitForFunction(([each, wanted]) => {
      return document.querySelector(`[data-setting=${each}] .idle`).textContent === wanted;
    }, [name, text]);
    await once("roi-expansion", "No effect with tracking=edges");
    const greyed = await page.$$eval(".setting.idle", (nodes) => nodes.map((node) => node.dataset.setting));
    assert.deepEqual(greyed.sort(), ["detect-contour-overlap", "max-scale", "max-target-size", "min-target-size",
      "roi-expansion", "track-contour-overlap", "track-ellipse-overlap"]);
    assert.equal(await idle("detect-contour-overlap"), "No effect with detector=arcs up to 0.65");
    assert.equal(await idle("track-contour-overlap"), "No effect with detector=arcs and tracking=edges");
    assert.equal(await idle("max-scale"), "No effect with tracking=edges unless max-processing-time is set");
    assert.equal(await idle("ring-ratio"), "");

    await setting(page, "tracking").getByText("redetect", { exact: true }).click();
    await once("roi-expansion", "");
    await once("ring-ratio", "No effect with tracking=redetect");
    assert.equal(await idle("max-scale"), "");
    await live.program.ask("PUT", "/api/properties", { detector: "contours", tracking: "none" });  // by another client
    await once("track-contour-overlap", "No effect with tracking=none");
    assert.equal(await idle("detect-contour-overlap"), "");
    await live.program.ask("PUT", "/api/properties", { "max-processing-time": 1e9 });
    await once("max-scale", "");
  });

  it("shows the value in force in the field of a setting that is 0", async () => {
    const page = await live.open();
    const box = setting(page, "detect-ellipse-overlap").locator("input[type=number]");
    const holds = (value, placeholder) => page.waitForFunction(([content, behind]) => {
      const field = document.querySelector("[data-setting=detect-ellipse-overlap] input[type=number]");
      return field.value === content && field.placeholder === behind;
    }, [value, placeholder]);
    await holds("0", "");
    await setting(page, "detector").getByText("contours", { exact: true }).click();
    await holds("", "0 = 0.95");
    await box.fill("0.66");
    await box.press("Enter");
    await box.blur();
    await holds("0.66", "");
    await box.fill("0");
    await box.press("Enter");
    await box.blur();
    await holds("", "0 = 0.95");
    await propertiesOnce(live.program, "detect-ellipse-overlap", (value) => value === 0);
  });

  it("names the reason of each rejection and links to the setting", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await setting(page, "max-axis-ratio").locator("input[type=number]").fill("1.0001");
    await setting(page, "max-axis-ratio").locator("input[type=number]").press("Enter");
    await page.click("#tab-stages");
    const reason = page.locator("[data-reason=too-flat]");
    await reason.waitFor();
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Play]");
    await standsStill(page, live.program);
    // If the page rebuilds the list at this moment, the new one is closed.
    await eventually("the reason is open", async () => {
      if (await reason.getByText("Go to max-axis-ratio").isVisible()) return true;
      await reason.locator("summary").click();
    });
    assert.match(await reason.locator("li button").first().textContent(), /axis ratio [\d.]+, at most 1/);
    await reason.getByText("Go to max-axis-ratio").click();
    await page.waitForFunction(() => document.activeElement.closest("[data-setting=max-axis-ratio]"));
    await page.click("#reset-all");
    await page.click("#play");
  });

  it("shows each stage on the screen", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await page.click("#play");
    await standsStill(page, live.program);
    await page.click("#tab-stages");
    const pictures = new Set();
    for (const stage of ["luma", "edges", "chains", "arcs", "candidates", "luma"]) {
      await page.locator(`input[name=stage][value=${stage}]`).check({ force: true });
      await page.waitForSelector(`#screen[data-stage=${stage}]`);
      pictures.add(await page.evaluate(() => document.querySelector("#screen").toDataURL("image/png")));
    }
    assert.equal(pictures.size, 5);
    const target = page.locator("[data-reason=accepted]");
    if (!await target.evaluate((node) => node.open)) await target.locator("summary").click();
    await target.locator("li button").first().focus();
    await target.locator("li .evidence").first().waitFor();
    assert.equal(await target.locator("li").first().locator(".evidence dd").count(), 8);
    assert.match(await target.locator("li button").first().textContent(), /probability (above )?0\.\d{3}/);
    assert.deepEqual(page.troubles, []);
  });

  it("resumes the analysis of the stages with playback", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await page.click("#tab-stages");
    await page.waitForSelector("#stage-summary b");
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Play]");
    // Requests that were pending at the pause have been answered.
    await page.waitForTimeout(1500);
    await page.click("#play");
    for (let i = 0; i < 3; ++i) await page.waitForResponse(/api\/analyze/);
  });

  it("lists the choices of the paused frame", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await page.click("#tab-label");
    await choicesAreThere(page);
    for (let i = 0; i < 5; ++i) {
      await page.click("#play");
      await page.waitForSelector("#play[aria-label=Pause]");
      const before = await shownBy(page);
      await page.waitForFunction((n) => Number(document.querySelector("#screen").dataset.shown) > n + 5, before);
      await page.click("#play");
      await page.waitForSelector("#play[aria-label=Play]");
      await page.waitForFunction(() => {
        return document.querySelector("#label-choices").dataset.pts === document.querySelector("#screen").dataset.pts;
      });
    }
    await page.click("#play");
  });

  it("focuses the clicked candidate in the list", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Play]");
    await standsStill(page, live.program);
    await page.click("#tab-stages");
    await page.waitForSelector("#stage-summary b");
    const { candidates, width } = await live.program.ask("POST", "/api/analyze", {});
    const { ellipse: e } = candidates.find(({ is_target: isTarget }) => isTarget);
    const box = await page.locator("#screen").boundingBox();
    const scale = box.width / width;
    const [x, y] = [e.cx + e.semi_major * Math.cos(e.angle_rad), e.cy + e.semi_major * Math.sin(e.angle_rad)];
    await page.mouse.click(box.x + (x + 0.5) * scale, box.y + (y + 0.5) * scale);
    await page.waitForFunction(() => /^Target, /.test(document.activeElement.textContent));
  });

  it("is usable by keyboard alone", async () => {
    const page = await live.open();
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.className), "skip");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.activeElement.id === "screen");
    await page.keyboard.press("Space");
    await page.waitForSelector("#play[aria-label=Play]");
    await page.keyboard.press("Space");
    await page.waitForSelector("#play[aria-label=Pause]");
    await page.focus("#tab-tune");
    for (const tab of ["stages", "compare", "label", "tune"]) {
      await page.keyboard.press("ArrowRight");
      assert.equal(await page.getAttribute(`#tab-${tab}`, "aria-selected"), "true");
      assert.ok(await page.isVisible(`#panel-${tab}`));
      if (tab === "label") await page.waitForSelector("#play[aria-label=Play]");
    }
    await live.program.ask("POST", "/api/play");
  });

  it("names every control for screen readers", async () => {
    const page = await live.open();
    await page.evaluate(() => document.querySelectorAll("details").forEach((each) => { each.open = true; }));
    const session = await page.context().newCDPSession(page);
    const { nodes } = await session.send("Accessibility.getFullAXTree");
    const kWorked = ["button", "slider", "spinbutton", "checkbox", "radio", "tab", "textbox", "searchbox", "combobox", "image"];
    const worked = nodes.filter(({ ignored, role }) => !ignored && kWorked.includes(role?.value));
    const nameless = worked.filter(({ name }) => !name?.value);
    assert.ok(worked.length > 60);
    assert.deepEqual(nameless.map(({ role, backendDOMNodeId }) => `${role.value} ${backendDOMNodeId}`), []);
  });

  it("announces state changes to screen readers", async () => {
    const page = await live.open();
    await page.waitForFunction(() => document.querySelector("#announcer").textContent === "Target: tracked");
  });

  it("fits a phone", async () => {
    const page = await live.open({ width: 360, height: 740 });
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.equal(overflow, 0);
    for (const tab of ["stages", "compare", "label", "tune"]) {
      await page.click(`#tab-${tab}`);
      await page.waitForTimeout(300);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0, tab);
    }
    const small = await page.$$eval("button, select", (nodes) => nodes
      .filter((node) => node.offsetParent && node.offsetHeight < 28).map((node) => node.textContent));
    assert.deepEqual(small, []);
    await live.program.ask("POST", "/api/play");
  });

  it("compares two settings on one frame", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    await page.click("#tab-compare");
    await page.click("#compare-pin");
    await page.waitForSelector("#screen-b:not([hidden])");
    await page.click("#tab-tune");
    const field = setting(page, "max-axis").locator("input[type=number]");
    await field.fill("6");
    await field.press("Enter");
    await page.click("#tab-compare");
    const cells = page.locator("#compare-result tr", { hasText: "Target" }).locator("td");
    await page.waitForFunction(() => /max-axis/.test(document.querySelector("#compare-result").textContent));
    await page.waitForFunction(() => [...document.querySelectorAll("#compare-result tr")]
      .some((row) => /Targetfoundnone/.test(row.textContent)));
    assert.deepEqual(await cells.allTextContents(), ["found", "none"]);
    await page.click("#compare-back");
    await page.waitForFunction(() => /no differences/.test(document.querySelector("#compare-result").textContent));
    await live.program.ask("POST", "/api/play");
  });
}));

// Squares, flowers and arcs: many rejected candidates.
describe("a picture with many rejected candidates", () => withProgram(() => ["--source", "test:negative"], (live) => {
  const countRed = (page) => page.evaluate(() => {
    const screen = document.querySelector("#screen");
    const { data } = screen.getContext("2d").getImageData(0, 0, screen.width, screen.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > data[i + 1] + 60 && data[i] > data[i + 2] + 60) ++count;
    return count;
  });

  it("shows the closest candidates, and all on request", async () => {
    const page = await live.open();
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Play]");
    await standsStill(page, live.program);
    await page.click("#tab-stages");
    await page.waitForSelector("#stage-shown:not([hidden])");
    const [, few, rejected] = /closest (\d+) of (\d+) rejected/.exec(await page.textContent("#stage-shown"));
    assert.equal(few, "8");
    const { candidates } = await live.program.ask("POST", "/api/analyze", {});
    assert.equal(Number(rejected), candidates.filter(({ ellipse, found }) => ellipse && !found).length);
    assert.ok(rejected > 20, `${rejected} rejected`);
    const redOfFew = await countRed(page);
    await page.click("#stage-all");
    await page.waitForSelector("#stage-all[aria-pressed=true]");
    const redOfAll = await countRed(page);
    assert.ok(redOfAll > 1.5 * redOfFew && redOfFew > 0, `${redOfFew}, then ${redOfAll} red pixels`);
    await page.click("#stage-all");
    assert.equal(await countRed(page), redOfFew);

    const reason = page.locator(".reason").filter({ has: page.locator(".rest") }).first();
    await reason.locator("summary").click();
    assert.equal(await reason.locator("li").count(), 8);
    const redOfReason = await countRed(page);
    await reason.locator(".rest").click();
    await page.waitForFunction(() => document.querySelector(".reason[open]:not(.accepted)").querySelectorAll("li").length > 8);
    assert.ok(await countRed(page) > redOfReason);
  });
}));

// Seen from straight above, so that its whole edge is sharp.
describe("a pad that stays in the middle", () => withProgram(() => ["--source", "test:hover"], (live) => {
  it("is drawn within 2 px of the ring", async () => {
    const page = await live.open();
    await stateIs(page, "tracked");
    for (let i = 0; i < 3; ++i) {
      await page.click("#play");
      await page.waitForSelector("#play[aria-label=Play]");
      await standsStill(page, live.program);
      const distance = await largestDistance(page);
      assert.ok(distance.rays > 80, `the ring was found on ${distance.rays} rays`);
      assert.ok(distance.largest_px <= 2, `${distance.largest_px} px apart`);
      await page.click("#play");
      await page.waitForSelector("#play[aria-label=Pause]");
      await page.waitForTimeout(700);
    }
  });
}));

describe("presets", () => {
  it("are shown as in force after loading", async () => {
    const program = await startProgram("--source", "test:approach");
    const page = await openPage(browser, program.url);
    const once = (text) => page.waitForFunction((wanted) => {
      return document.querySelector("#preset-state").textContent === wanted;
    }, text);
    assert.equal(await page.inputValue("#preset"), "");
    assert.ok(await page.isDisabled("#preset-load"));
    await once("");
    await page.selectOption("#preset", "Keipour 2021");
    await once("Keipour 2021 is selected, not loaded");
    await page.click("#preset-load");
    await once("Active preset: Keipour 2021");
    const field = setting(page, "max-axis").locator("input[type=number]");
    await field.fill("650");
    await field.press("Enter");
    await once("Active preset: Keipour 2021; 1 setting changed since");
    await field.fill("700");  // the preset's
    await field.press("Enter");
    await once("Active preset: Keipour 2021");
    await page.close();
    await program.stop();
  });

  it("persist across restarts", async () => {
    const first = await startProgram("--source", "test:approach");
    let page = await openPage(browser, first.url);
    await setting(page, "min-axis").locator("input[type=number]").fill("17");
    await setting(page, "min-axis").locator("input[type=number]").press("Enter");
    await propertiesOnce(first, "min-axis", (value) => value === 17);
    await page.click("#preset-save");
    await page.fill("#save-name", "Dusk, grass");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector("#preset").value === "Dusk, grass");
    await page.close();
    await first.stop();

    const second = await startProgram("--source", "test:approach");
    page = await openPage(browser, second.url);
    await page.selectOption("#preset", "Dusk, grass");
    await page.click("#preset-load");
    await page.waitForSelector("[data-setting=min-axis].changed");
    assert.equal(await setting(page, "min-axis").locator("input[type=number]").inputValue(), "17");
    await page.click("#launch-copy");
    await page.waitForFunction(() => /ellipsetrack .*min-axis=17/.test(document.querySelector("#launch-line").textContent));
    await page.click("#preset-delete");
    await page.locator("#preset option", { hasText: "Dusk, grass" }).waitFor({ state: "detached" });
    await page.close();
    await second.stop();
  });
});

describe("a file", () => withProgram(() => {
  return ["--source", process.env.ELLIPSE_TEST_VIDEO, "--loop", "--labels", join(process.env.XDG_DATA_HOME, "labels")];
}, (live) => {
  it("can be paused, stepped and sought", async () => {
    const page = await live.open();
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Play]");
    // Not at the end, where playback starts over.
    await scrubTo(page, "250");
    await page.waitForFunction(() => Math.abs(Number(document.querySelector("#screen").dataset.pts) - 5e8) < 1e8);
    const start = await standsStill(page, live.program);
    await page.click("#step");
    await page.waitForFunction((n) => Number(document.querySelector("#screen").dataset.pts) !== n, start);
    const step = await standsStill(page, live.program) - start;
    assert.ok(Math.abs(step - 1e9 / 30) < 2e6, `${step} ns`);
    await scrubTo(page, "500");
    await page.waitForFunction(() => Math.abs(Number(document.querySelector("#screen").dataset.pts) - 1e9) < 1e8);
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Pause]");
  });

  it("shows the effect of a setting while it is paused", async () => {
    const page = await live.open();
    await page.click("#play");
    await page.waitForSelector("#play[aria-label=Play]");
    await scrubTo(page, "500");
    await page.waitForFunction(() => Math.abs(Number(document.querySelector("#screen").dataset.pts) - 1e9) < 1e8);
    const pts = await standsStill(page, live.program);
    const isFound = () => page.waitForSelector("#state:is([data-state=tracked], [data-state=detected])");
    await isFound();
    const slider = setting(page, "max-axis").locator("input[type=range]");
    await slider.fill("200");
    await stateIs(page, "lost");
    await page.click("#tab-label");
    const choices = page.locator("#label-choices input");
    await eventually("no choice but those of a person", async () => (await choices.count() === 2) || undefined);
    await page.click("#tab-tune");
    await setting(page, "max-axis").getByRole("button", { name: "Reset max-axis" }).click();
    await isFound();
    await page.click("#tab-label");
    await eventually("the choice is back", async () => (await choices.count() > 2) || undefined);
    assert.equal(await standsStill(page, live.program), pts);
  });

  it("is labelled frame by frame", async () => {
    const page = await live.open();
    await page.click("#tab-label");
    await standsStill(page, live.program);
    const first = await choicesAreThere(page);
    await page.waitForSelector("#label-save:enabled");
    await page.click("#label-save");
    await page.waitForFunction(() => /^1 saved/.test(document.querySelector("#label-result").textContent));
    await choicesAreThere(page, first);
    await page.getByLabel("None: no target in this frame").check();
    await page.click("#label-save");
    await page.waitForFunction(() => /^2 saved/.test(document.querySelector("#label-result").textContent));
    const rows = readRows(live.labels);
    assert.equal(rows.length, 3);
    assert.match(rows[1], /^images\/labelled\/000001\.png,\d+/);
    assert.match(rows[2], /^images\/labelled\/000002\.png,,,,,,,\d+/);
  });

  it("disables choices while the frame changes", async () => {
    const page = await live.open();
    await page.click("#tab-label");
    await standsStill(page, live.program);
    const first = await choicesAreThere(page);
    let goOn;
    const isHeld = new Promise((resolve) => { goOn = resolve; });
    await page.route("**/api/analyze", async (route) => {
      await isHeld;
      await route.continue();
    });
    await page.click("#label-save");
    await page.waitForFunction((old) => document.querySelector("#screen").dataset.pts !== old, first);
    assert.ok(await page.isDisabled("#label-save"));
    assert.ok(await page.getByLabel("None: no target in this frame").isDisabled());
    await page.locator("#screen").click();
    assert.ok(await page.isDisabled("#label-save"));
    goOn();
    await choicesAreThere(page, first);
    assert.ok(await page.getByLabel("None: no target in this frame").isEnabled());
    await page.unrouteAll({ behavior: "ignoreErrors" });
  });

  it("saves an ellipse drawn by hand", async () => {
    const page = await live.open();
    await page.click("#tab-label");
    await standsStill(page, live.program);
    await choicesAreThere(page);
    await page.getByLabel("Drawn: click points along its whole edge").check();
    const { x, y, width } = await page.locator("#screen").boundingBox();
    const scale = width / 640;
    for (let i = 0; i < 6; ++i) {
      assert.equal(await page.isEnabled("#label-save"), i >= 5);
      const angle = i;
      await page.mouse.click(x + (200.5 + 60 * Math.cos(angle)) * scale, y + (120.5 + 30 * Math.sin(angle)) * scale);
    }
    const before = readRows(live.labels).length;
    await page.click("#label-save");
    await page.waitForFunction(() => /^1 saved/.test(document.querySelector("#label-result").textContent));
    const [, cx, cy, major, minor] = readRows(live.labels)[before].split(",").map(Number);
    for (const [value, wanted] of [[cx, 200], [cy, 120], [major, 60], [minor, 30]]) {
      assert.ok(Math.abs(value - wanted) < 1.5, `${value} instead of ${wanted}`);
    }
  });
}));

it("changes the source if allowed", async () => {
  const program = await startProgram("--source", "test:approach", "--allow-source-change");
  const page = await openPage(browser, program.url);
  await page.click("#source-change");
  await page.fill("#source-spec", "test:moon");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /no such scene/.test(document.querySelector("#source-error").textContent));
  await page.fill("#source-spec", "test:orbit");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#source-name").textContent === "test:orbit");
  await stateIs(page, "tracked");
  await page.close();
  await program.stop();
});

it("plays a folder at the requested rate", async () => {
  const folder = join(process.env.XDG_DATA_HOME, "pictures");
  mkdirSync(folder);
  const made = spawnSync("gst-launch-1.0", ["-q", "ellipsetestsrc", "num-buffers=20", "!", "videoconvert", "!",
    "jpegenc", "!", "multifilesink", `location=${folder}/%d.jpg`]);
  assert.equal(made.status, 0);
  const program = await startProgram("--source", folder, "--fps", "10", "--loop", "--allow-source-change");
  const page = await openPage(browser, program.url);
  await page.click("#source-change");
  assert.equal(await page.inputValue("#source-fps"), "10");
  await page.fill("#source-fps", "fast");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /fast/.test(document.querySelector("#source-error").textContent));
  await page.fill("#source-fps", "12.5");
  await page.keyboard.press("Enter");
  await eventually("12.5 frames a second", async () => {
    return (await program.ask("GET", "/api/source")).fps === 12.5 || undefined;
  });
  await page.close();
  await program.stop();
});

it("leaves no program running when the tests are killed", { timeout: kTimeoutMs }, async () => {
  const script = `import { startProgram } from "./program.mjs";
    console.log((await startProgram("--source", "test:approach")).url);
    process.kill(process.pid, "SIGKILL");`;
  const { stdout, signal } = spawnSync(process.execPath, ["--input-type=module", "-e", script], { encoding: "utf8" });
  assert.equal(signal, "SIGKILL");
  const isUp = () => fetch(new URL("api/target", stdout.trim())).then(() => true, () => false);
  while (await isUp()) await setTimeout(50);
});

it("reports a lost connection", async () => {
  const program = await startProgram("--source", "test:approach");
  const page = await openPage(browser, program.url);
  await program.stop();
  await page.waitForFunction(() => /No connection/.test(document.querySelector("#notice").textContent));
  await page.close();
});
