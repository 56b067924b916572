// SPDX-License-Identifier: MIT
// Draws ellipses, axes, centres and regions over a picture, in frame pixels. The centre of the
// top-left pixel is (0, 0).

const style = getComputedStyle(document.documentElement);
const color = (name) => style.getPropertyValue(`--${name}`).trim();

/** Line styles differ too, for users who cannot distinguish the colours. */
const kLooks = {
  tracked: { color: color("tracked"), dash: [] },
  detected: { color: color("detected"), dash: [9, 5] },
  predicted: { color: color("predicted"), dash: [2, 5] },
  candidate: { color: color("candidate"), dash: [] },
  rejected: { color: color("lost"), dash: [] },
  chosen: { color: color("accent"), dash: [] },
  truth: { color: "#ffffff", dash: [1, 4] },
};

/** Sets the canvas to the screen's resolution. @returns its context, scaled to frame pixels. */
export function contextOf(canvas, width, height) {
  const fine = canvas.clientWidth * devicePixelRatio || width;
  const wide = Math.round(fine);
  const high = Math.round(fine * height / width);
  if (canvas.width !== wide || canvas.height !== high) {
    canvas.width = wide;
    canvas.height = high;
  }
  const context = canvas.getContext("2d");
  const scale = canvas.width / width;
  // Clears the canvas, because the picture may not cover its last row.
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, wide, high);
  context.setTransform(scale, 0, 0, scale, 0.5 * scale, 0.5 * scale);
  context.lineWidth = 2 * devicePixelRatio / scale;
  return context;
}

/** @param picture  Any image source; stretched over the whole frame. */
export function drawPicture(context, picture, width, height, showsPixels = false) {
  context.imageSmoothingEnabled = !showsPixels;
  context.imageSmoothingQuality = "high";
  context.drawImage(picture, -0.5, -0.5, width, height);
}

/** Draws the ellipse, axes and centre that are enabled in `layers`. @param look  A key of kLooks. */
export function drawEllipse(context, e, look, layers) {
  const { color: stroke, dash } = kLooks[look];
  const unit = context.lineWidth / 2;
  context.save();
  context.translate(e.cx, e.cy);
  context.rotate(e.angle_rad);
  if (layers.ellipse) {
    context.beginPath();
    context.ellipse(0, 0, e.semi_major, e.semi_minor, 0, 0, 2 * Math.PI);
    outline(context, stroke, dash.map((length) => length * unit));
  }
  if (layers.axes) {
    context.globalAlpha = 0.75;
    context.beginPath();
    context.moveTo(-e.semi_major, 0);
    context.lineTo(e.semi_major, 0);
    context.moveTo(0, -e.semi_minor);
    context.lineTo(0, e.semi_minor);
    context.lineWidth = unit;
    outline(context, stroke, []);
    context.globalAlpha = 1;
  }
  if (layers.centre) {
    const arm = 5 * unit;
    context.rotate(-e.angle_rad);
    context.beginPath();
    context.moveTo(-arm, 0);
    context.lineTo(arm, 0);
    context.moveTo(0, -arm);
    context.lineTo(0, arm);
    context.lineWidth = 2 * unit;
    outline(context, stroke, []);
  }
  context.restore();
}

/** Draws a region [x, y, width, height] in whole pixels. The region set by the user has a solid line. */
export function drawRegion(context, [x, y, width, height], look) {
  const isChosen = look === "chosen";
  const unit = context.lineWidth / 2;
  context.save();
  context.globalAlpha = isChosen ? 1 : 0.7;
  context.lineWidth = isChosen ? 2 * unit : unit;
  context.beginPath();
  context.rect(x - 0.5, y - 0.5, width, height);
  outline(context, kLooks[look].color, isChosen ? [] : [4 * unit, 4 * unit]);
  context.restore();
}

// Strokes the path with a dark outline that keeps it visible on any background.
function outline(context, stroke, dash) {
  const width = context.lineWidth;
  context.setLineDash([]);
  context.strokeStyle = "rgb(0 0 0 / .45)";
  context.lineWidth = 2 * width;
  context.stroke();
  context.setLineDash(dash);
  context.strokeStyle = stroke;
  context.lineWidth = width;
  context.stroke();
}

/** Draws the ellipses and the region of a frame's JSON line. */
export function drawTargets(context, line, layers) {
  for (const target of line?.targets ?? []) {
    if (target.role === "candidate" && layers.candidates) {
      drawEllipse(context, target, "candidate", { ellipse: true });
    }
    if (target.role === "truth" && layers.truth) {
      drawEllipse(context, target, "truth", { ellipse: true });
    }
  }
  const target = targetOf(line);
  const region = line?.roi ?? target?.roi;
  if (layers.region && region) drawRegion(context, region, target?.state ?? "rejected");
  if (target) drawEllipse(context, target, target.state, layers);
}

/** The target of a frame, or undefined. */
export function targetOf(line) {
  return line?.targets.find((each) => each.role === "target");
}

/** Approximate distance from a point to an ellipse's perimeter [px]. */
export function distanceTo(e, x, y) {
  const cos = Math.cos(e.angle_rad);
  const sin = Math.sin(e.angle_rad);
  const u = (cos * (x - e.cx) + sin * (y - e.cy)) / e.semi_major;
  const v = (cos * (y - e.cy) - sin * (x - e.cx)) / e.semi_minor;
  const r = Math.hypot(u, v);
  const slope = Math.hypot(u / e.semi_major, v / e.semi_minor);
  return slope > 0 ? Math.abs(r - 1) * r / slope : e.semi_minor;
}
