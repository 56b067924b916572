// SPDX-License-Identifier: MIT
// Fits an ellipse to points that the user clicked on its edge.

/** Minimum number of points that determine an ellipse. */
export const kMinPoints = 5;

/**
 * Least-squares fit of the conic a x² + b xy + c y² + d x + e y = 1, relative to the points' mean.
 * A conic of this form cannot pass through the origin; the mean of points around an ellipse is inside.
 * @param points  [{x, y}] in px.
 * @returns the ellipse as in a frame's line, or null if the points do not determine one.
 */
export function ellipseThrough(points) {
  if (points.length < kMinPoints) return null;
  const mean = (key) => points.reduce((sum, point) => sum + point[key], 0) / points.length;
  const [mx, my] = [mean("x"), mean("y")];
  const size = Math.max(...points.map(({ x, y }) => Math.hypot(x - mx, y - my)));
  const rows = points.map(({ x, y }) => {
    const [u, v] = [(x - mx) / size, (y - my) / size];
    return [u * u, u * v, v * v, u, v];
  });
  const conic = leastSquares(rows);
  const e = conic && ellipseOf(conic);
  if (!e) return null;
  return {
    cx: mx + size * e.cx,
    cy: my + size * e.cy,
    semi_major: size * e.semi_major,
    semi_minor: size * e.semi_minor,
    angle_rad: e.angle_rad,
  };
}

// Solves rows * x = 1 by the normal equations and Gaussian elimination.
function leastSquares(rows) {
  const n = rows[0].length;
  const m = Array.from({ length: n }, (_, i) => [
    ...Array.from({ length: n }, (__, k) => rows.reduce((sum, row) => sum + row[i] * row[k], 0)),
    rows.reduce((sum, row) => sum + row[i], 0),
  ]);
  for (let i = 0; i < n; ++i) {
    const pivot = m.slice(i).reduce((best, row, k) => (Math.abs(row[i]) > Math.abs(m[best][i]) ? i + k : best), i);
    [m[i], m[pivot]] = [m[pivot], m[i]];
    if (Math.abs(m[i][i]) < 1e-10) return null;
    for (let k = 0; k < n; ++k) {
      if (k === i) continue;
      const factor = m[k][i] / m[i][i];
      for (let j = i; j <= n; ++j) m[k][j] -= factor * m[i][j];
    }
  }
  return m.map((row, i) => row[n] / row[i]);
}

function ellipseOf([a, b, c, d, e]) {
  const determinant = 4 * a * c - b * b;
  if (determinant <= 0) return null;
  const cx = (b * e - 2 * c * d) / determinant;
  const cy = (b * d - 2 * a * e) / determinant;
  // Relative to the centre: a u² + b uv + c v² = level.
  const level = 1 - (d * cx + e * cy) / 2;
  const middle = (a + c) / 2;
  const spread = Math.hypot((a - c) / 2, b / 2);
  const [long, short] = [level / (middle - spread), level / (middle + spread)];
  if (!(long > 0 && short > 0)) return null;
  let angle = 0.5 * Math.atan2(-b, c - a);
  if (angle <= -Math.PI / 2) angle += Math.PI;
  return { cx, cy, semi_major: Math.sqrt(long), semi_minor: Math.sqrt(short), angle_rad: angle };
}
