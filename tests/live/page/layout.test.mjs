// SPDX-License-Identifier: MIT
//
// The page's layout for windows and videos of all shapes.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { openPage, startBrowser, startProgram } from "./program.mjs";

const kPhone = { width: 390, height: 844 };
const kSizes = [
  { width: 1280, height: 800 },
  { width: 1920, height: 940 },
  { width: 1920, height: 1080 },
  kPhone,
  { width: 844, height: 390 },
  { width: 1024, height: 1366 },
];
const kVideos = [[640, 360], [640, 480]];

/** Positions of the visible canvases [px of the window]. */
function picturesOf(page) {
  return page.evaluate(() => [...document.querySelectorAll("#frame canvas")].filter((canvas) => canvas.checkVisibility())
    .map((canvas) => {
      const { left, top, right, bottom, width, height } = canvas.getBoundingClientRect();
      const fit = getComputedStyle(canvas).objectFit;
      return { left, top, right, bottom, width, height, fit, columns: canvas.width, rows: canvas.height };
    }));
}

/** Checks their aspect ratios, and that they are entirely in view. */
function check(pictures, aspect, { width, height }) {
  for (const each of pictures) {
    const shown = `${each.width} × ${each.height} px`;
    assert.equal(each.fit, "fill");
    assert.ok(Math.abs(each.width - each.height * aspect) <= 1, shown);
    assert.ok(Math.abs(each.columns - each.width) <= 1 && Math.abs(each.rows - each.height) <= 1,
      `${each.columns} × ${each.rows} pixels in ${shown}`);
    const isInView = each.left >= 0 && each.top >= 0 && each.right <= width && each.bottom <= height;
    assert.ok(isInView, `from (${each.left}, ${each.top}) to (${each.right}, ${each.bottom})`);
  }
}

/** Checks the minimum size: as wide as its column, or more than half as high as the window. */
function checkSize([picture], { width, height }) {
  const column = width > 1000 ? width - 380 - 28 : width > 640 ? width - 28 : width;
  assert.ok(picture.width >= column - 1 || picture.height >= 0.5 * height,
    `${picture.width} × ${picture.height} px`);
}

// Waits until the browser has redrawn a changed layout.
const settle = (page) => page.evaluate(() => new Promise((resolve) => {
  requestAnimationFrame(() => requestAnimationFrame(resolve));
}));

for (const [columns, rows] of kVideos) {
  describe(`a video of ${columns} × ${rows}`, () => {
    let browser;
    let program;
    before(async () => {
      browser = await startBrowser();
      const caps = `video/x-raw,width=${columns},height=${rows},framerate=15/1`;
      program = await startProgram("--source", `[ellipsetestsrc scene=orbit is-live=true ! ${caps}]`);
    });
    after(async () => {
      await browser.close();
      await program.stop();
    });

    for (const size of kSizes) {
      it(`is in proportion and in view at ${size.width} × ${size.height}`, async () => {
        const page = await openPage(browser, program.url, size);
        await settle(page);
        const pictures = await picturesOf(page);
        assert.equal(pictures.length, 1);
        check(pictures, columns / rows, size);
        checkSize(pictures, size);
        await page.close();
      });
    }

    it("keeps its proportions when the window changes", async () => {
      const page = await openPage(browser, program.url, kSizes[0]);
      for (const size of kSizes) {
        await page.setViewportSize(size);
        await settle(page);
        check(await picturesOf(page), columns / rows, size);
      }
      await page.close();
    });

    for (const size of [kSizes[0], kPhone]) {
      it(`is compared in proportion at ${size.width} × ${size.height}`, async () => {
        const page = await openPage(browser, program.url, size);
        await page.click("#tab-compare");
        await page.click("#compare-pin");
        await page.waitForSelector("#screen-b:not([hidden])");
        await settle(page);
        const pictures = await picturesOf(page);
        assert.equal(pictures.length, 2);
        check(pictures, columns / rows, size);
        const [a, b] = pictures;
        assert.ok(a.right <= b.left || a.bottom <= b.top, "one lies over the other");
        for (const [tag, picture] of [["#tag-a", a], ["#tag-b", b]]) {
          const { x, y } = await page.locator(tag).boundingBox();
          assert.ok(x >= picture.left && x < picture.right && y >= picture.top && y < picture.bottom, tag);
        }
        await program.ask("POST", "/api/play");
        await page.close();
      });
    }
  });
}

describe("a phone", () => {
  let browser;
  let program;
  before(async () => {
    browser = await startBrowser();
    program = await startProgram("--source", "test:orbit");
  });
  after(async () => {
    await browser.close();
    await program.stop();
  });

  it("keeps the video and the tabs in view while the settings scroll", async () => {
    const page = await openPage(browser, program.url, kPhone);
    await page.locator("[data-setting=line-width]").evaluate((node) => {
      node.closest("details").open = true;
      node.scrollIntoView({ block: "center" });
    });
    await settle(page);
    check(await picturesOf(page), 640 / 360, kPhone);
    const tabs = await page.locator(".tabs").boundingBox();
    const frame = await page.locator("#frame").boundingBox();
    assert.ok(Math.abs(tabs.y - (frame.y + frame.height)) <= 1, `tabs at ${tabs.y}, video up to ${frame.y + frame.height}`);
    const setting = await page.locator("[data-setting=line-width]").boundingBox();
    assert.ok(setting.y >= tabs.y + tabs.height && setting.y + setting.height <= kPhone.height);
    await page.close();
  });

  it("scrolls to the top of a newly opened tab", async () => {
    const page = await openPage(browser, program.url, kPhone);
    await page.evaluate(() => scrollTo(0, 1e6));
    await page.click("#tab-stages");
    await settle(page);
    const tabs = await page.locator(".tabs").boundingBox();
    const lead = await page.locator("#panel-stages .lead").boundingBox();
    assert.ok(lead.y >= tabs.y + tabs.height, `begins at ${lead.y}, below ${tabs.y + tabs.height}`);
    assert.ok(lead.y < kPhone.height);
    await page.close();
  });
});
