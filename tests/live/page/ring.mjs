// SPDX-License-Identifier: MIT
// Distance of the drawn ellipse from the displayed ring, both measured in the screen's pixels.

/** Measures along 120 rays from the ellipse's centre. @returns {largest_px, rays} in px of the screen. */
export async function largestDistance(page) {
  const others = ["axes", "centre", "region"];
  for (const layer of others) await page.click(`[data-layer=${layer}]`);
  const drawn = await page.evaluateHandle(pixels);
  await page.focus("#screen");
  await page.keyboard.press("o");
  const plain = await page.evaluateHandle(pixels);
  const result = await page.evaluate(measure, { drawn, plain });
  await page.keyboard.press("o");
  for (const layer of others) await page.click(`[data-layer=${layer}]`);
  return result;
}

function pixels() {
  const screen = document.querySelector("#screen");
  return screen.getContext("2d").getImageData(0, 0, screen.width, screen.height);
}

// Runs in the page.
function measure({ drawn, plain }) {
  const { width, height } = drawn;
  const green = ({ data }, x, y) => data[4 * (Math.round(y) * width + Math.round(x)) + 1];
  const isLine = (x, y) => Math.abs(green(drawn, x, y) - green(plain, x, y)) > 24;

  const points = [];
  for (let y = 1; y < height - 1; ++y) {
    for (let x = 1; x < width - 1; ++x) if (isLine(x, y)) points.push([x, y]);
  }
  const middle = (k) => (Math.min(...points.map((p) => p[k])) + Math.max(...points.map((p) => p[k]))) / 2;
  const centre = [middle(0), middle(1)];

  // The green line has dark borders; its position is the midpoint of the changed pixels.
  const lineOn = (angle) => {
    const on = [];
    for (let r = 10; r < width; r += 0.25) {
      const [x, y] = [centre[0] + r * Math.cos(angle), centre[1] + r * Math.sin(angle)];
      if (x > 1 && y > 1 && x < width - 2 && y < height - 2 && isLine(x, y)) on.push(r);
    }
    return on.length > 0 ? (on[0] + on.at(-1)) / 2 : null;
  };
  // The radius at which the brightness is halfway between the ring's paint and its surroundings.
  const edgeNear = (angle, line) => {
    const level = (r) => green(plain, centre[0] + r * Math.cos(angle), centre[1] + r * Math.sin(angle));
    const [inside, outside] = [level(line - 8), level(line + 8)];
    if (!(Math.abs(inside - outside) > 60)) return null;
    for (let r = line - 8; r < line + 8; r += 0.1) {
      if ((level(r) - (inside + outside) / 2) * (inside - outside) <= 0) return r;
    }
    return null;
  };

  const distances = [];
  for (let i = 0; i < 120; ++i) {
    const angle = i / 120 * 2 * Math.PI;
    const line = lineOn(angle);
    const edge = line === null ? null : edgeNear(angle, line);
    if (edge !== null) distances.push(Math.abs(edge - line));
  }
  return { largest_px: Math.max(0, ...distances), rays: distances.length };
}
