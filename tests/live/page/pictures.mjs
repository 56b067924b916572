// SPDX-License-Identifier: MIT
//
// node pictures.mjs FOLDER: makes the pictures of docs/live.md with the programs ELLIPSE_LIVE and CHROMIUM.
import { join } from "node:path";
import { openPage, startBrowser, startProgram } from "./program.mjs";

const kWide = { width: 1280, height: 760 };
const kPhone = { width: 375, height: 720 };
const folder = process.argv[2];
const program = await startProgram("--source", "test:occluded");
const browser = await startBrowser();

/** Takes a screenshot of the page after preparing it. */
async function picture(name, size, prepare) {
  await program.ask("PUT", "/api/properties", { detector: "arcs" });
  await program.ask("POST", "/api/play");
  const page = await openPage(browser, program.url, size);
  await page.waitForSelector("#state[data-state=tracked]");
  await prepare(page);
  await page.waitForTimeout(1500);
  await page.screenshot({ path: join(folder, name), type: "jpeg", quality: 78 });
  await page.close();
}

const choose = (page, name, value) => page.check(`[data-setting=${name}] input[value=${value}]`, { force: true });

await picture("live.jpg", kWide, (page) => page.waitForTimeout(12000));
await picture("live-stages.jpg", kWide, async (page) => {
  await choose(page, "detector", "contours");
  await page.click("#tab-stages");
  await page.check("input[name=stage][value=chains]", { force: true });
  await page.waitForSelector("[data-reason=contour-overlap]");
  await page.click("#play");
  await page.waitForTimeout(1500);
  await page.click("[data-reason=accepted] summary");
  await page.click("[data-reason=contour-overlap] summary");
});
await picture("live-compare.jpg", kWide, async (page) => {
  await page.click("#tab-compare");
  await page.click("#compare-pin");
  await page.waitForSelector("#screen-b:not([hidden])");
  await page.click("#tab-tune");
  await choose(page, "detector", "contours");
  await page.click("#tab-compare");
  await page.waitForFunction(() => /detector/.test(document.querySelector("#compare-result").textContent));
});
await picture("live-guide.jpg", kWide, async (page) => {
  await program.ask("PUT", "/api/properties", { "min-axis": 300 });
  await page.click("#guide-button");
  await page.waitForTimeout(7000);
  await page.click("#guide-begin:enabled");
  for (let i = 1; i <= 3; ++i) {
    await page.waitForFunction((n) => {
      const { pts } = document.querySelector("#guide-choices").dataset;
      return pts && document.querySelector("#guide-frame").textContent.startsWith(`Frame ${n} of`);
    }, i);
    // The outer edge of the pad's ring: the largest ellipse.
    const sizes = await page.locator("#guide-choices label").allTextContents();
    const area = (text) => (/: (\d+) × (\d+) px/.exec(text) ?? [0, 0, 0]).slice(1).reduce((a, b) => a * b);
    const largest = sizes.map(area).indexOf(Math.max(...sizes.map(area)));
    await page.check(`#guide-choices input[value="${largest}"]`);
    await page.click("#guide-mark");
  }
  await page.waitForSelector("#guide-result h3");
});
await program.ask("PUT", "/api/properties", { "min-axis": 5 });
await picture("live-phone.jpg", kPhone, async (page) => {
  await page.mouse.wheel(0, 420);
});
await browser.close();
await program.stop();
