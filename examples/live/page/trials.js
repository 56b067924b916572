// SPDX-License-Identifier: MIT
// Derives changes of settings from marked frames. Each change has a reason with figures.
//
// A trial is {changes: {name: value}, why: {name: sentence}}. A sentence can be a function of the
// numbers of right marks with and without the trial. proposal.js judges the trials.

const kGrid = 48;            // samples across both ellipses
const kConcentric = 0.25;    // distance of concentric centres in minor semi-axes
const kRelaxMargin = 1.4;    // factor between a mark and a relaxed limit
const kClearFactor = 2;      // minimum factor between marks and ellipses that a limit rejects
const kRivalFactor = 1.1;    // the same for ellipses that are selected as the target
const kUsualProbability = 0.5;
const kMaxUnit = 1e6;        // six decimals of a probability
const kMaxRegionShare = 0.5; // of the frame; a larger region hardly helps
const kFaintEdges = { "edge-low": 1, "edge-high": 2 };
const kDetectors = ["arcs", "contours"];

/** Minimum intersection over union of a right answer, as in ellipse-evaluate. */
export const kSameOverlap = 0.8;

/** Limits of ellipsetrack, and the quantity of an ellipse that each limits. */
const kLimits = [
  { name: "min-axis", what: "Minor axis", unit: " px", isMin: true, of: (e) => 2 * e.semi_minor, round: Math.round },
  { name: "max-axis", what: "Major axis", unit: " px", isMin: false, of: (e) => 2 * e.semi_major, round: Math.round },
  {
    name: "max-axis-ratio",
    what: "Axis ratio",
    unit: "",
    isMin: false,
    of: (e) => e.semi_major / e.semi_minor,
    round: (value) => Math.round(10 * value) / 10,
  },
];
// Assumes that up to half of the outline is occluded or fragmented.
const kContour = {
  name: "min-contour-size",
  what: "Half the perimeter",
  unit: " px",
  isMin: true,
  minValue: 5,
  of: (e) => Math.PI * Math.hypot(e.semi_major, e.semi_minor) / Math.SQRT2,
  round: Math.round,
};

const contains = (e, x, y) => {
  const [cos, sin] = [Math.cos(e.angle_rad), Math.sin(e.angle_rad)];
  const u = (cos * (x - e.cx) + sin * (y - e.cy)) / e.semi_major;
  const v = (cos * (y - e.cy) - sin * (x - e.cx)) / e.semi_minor;
  return u * u + v * v <= 1;
};

function boxOf(e) {
  const [cos, sin] = [Math.cos(e.angle_rad), Math.sin(e.angle_rad)];
  const wide = Math.hypot(e.semi_major * cos, e.semi_minor * sin);
  const high = Math.hypot(e.semi_major * sin, e.semi_minor * cos);
  return { left: e.cx - wide, top: e.cy - high, right: e.cx + wide, bottom: e.cy + high };
}

const unionOf = (boxes) => ({
  left: Math.min(...boxes.map(({ left }) => left)),
  top: Math.min(...boxes.map(({ top }) => top)),
  right: Math.max(...boxes.map(({ right }) => right)),
  bottom: Math.max(...boxes.map(({ bottom }) => bottom)),
});

/** Intersection over union of two ellipses, by samples on a grid. */
export function overlapOf(a, b) {
  const { left, top, right, bottom } = unionOf([boxOf(a), boxOf(b)]);
  let [both, either] = [0, 0];
  for (let i = 0; i < kGrid * kGrid; ++i) {
    const x = left + ((i % kGrid) + 0.5) / kGrid * (right - left);
    const y = top + (Math.floor(i / kGrid) + 0.5) / kGrid * (bottom - top);
    const [inA, inB] = [contains(a, x, y), contains(b, x, y)];
    if (inA && inB) ++both;
    if (inA || inB) ++either;
  }
  return either > 0 ? both / either : 0;
}

export const isSame = (a, b) => overlapOf(a, b) >= kSameOverlap;

/** Whether an ellipse is the other one or an edge concentric with it. */
export function isPartOf(e, truth) {
  return Math.hypot(e.cx - truth.cx, e.cy - truth.cy) < kConcentric * truth.semi_minor || isSame(e, truth);
}

const short = (value) => String(Number(value.toPrecision(3)));

function rangeText(values, unit) {
  const [low, high] = [Math.min(...values), Math.max(...values)].map(short);
  return low === high ? `${low}${unit}` : `${low} – ${high}${unit}`;
}

// Merges several trials into one; null if there are none.
function together(trials) {
  if (trials.length === 0) return null;
  return {
    changes: Object.assign({}, ...trials.map(({ changes }) => changes)),
    why: Object.assign({}, ...trials.map(({ why }) => why)),
  };
}

// Relaxes limits that reject marked ellipses, until they accept all of them: to the default, which suits other
// frames too, or beyond the marks.
function wideLimits(truths, values, defaults) {
  return [...kLimits, kContour].flatMap(({ name, what, unit, isMin, minValue = 1, of, round }) => {
    const sizes = truths.map(of);
    const limit = values[name];
    const rejectedBy = (bound) => sizes.filter((size) => (isMin ? size < bound : size > bound)).length;
    const rejected = rejectedBy(limit);
    if (rejected === 0) return [];
    const to = rejectedBy(defaults[name]) === 0 ? defaults[name] : isMin ? Math.max(minValue, round(Math.min(...sizes) / kRelaxMargin))
      : round(Math.max(...sizes) * kRelaxMargin);
    const why = `${what} of your marks: ${rangeText(sizes, unit)}. ${short(limit)}${unit} rejects ${rejected} of ` +
      `${truths.length}.`;
    return [{ changes: { [name]: to }, why: { [name]: why } }];
  });
}

// Removes a region that does not contain all marked ellipses.
function wholeFrame(truths, { roi, "roi-source": source }) {
  if (source !== "property" || !roi[2]) return [];
  const [x, y, width, height] = roi;
  const outside = truths.map(boxOf).filter(({ left, top, right, bottom }) => {
    return left < x || top < y || right > x + width || bottom > y + height;
  });
  if (outside.length === 0) return [];
  const why = `${outside.length} of ${truths.length} marks extend beyond the region of ${width} × ${height} px.`;
  return [{ changes: { "roi-source": "none" }, why: { "roi-source": why } }];
}

function adaptedEdges({ "edge-low": low, "edge-high": high }) {
  if (low === 0 && high === 0) return [];
  const why = `Edge thresholds are fixed at ${low} and ${high} grey levels per px; with 0 they adapt to the frame.`;
  return [{ changes: { "edge-low": 0, "edge-high": 0 }, why: { "edge-low": why } }];
}

function faintEdges({ "edge-low": low, "edge-high": high }) {
  if (low !== 0 || high !== 0) return [];
  const why = (right, before) => `Lower thresholds than the adaptive ones: ${right} instead of ${before} marks ` +
    "are right.";
  return [{ changes: kFaintEdges, why: { "edge-low": why } }];
}

function otherDetector(values) {
  const other = kDetectors.find((each) => each !== values.detector);
  const why = (right, before) => `${right} marks are right with ${other}, ${before} with ${values.detector}.`;
  return [{ changes: { detector: other }, why: { detector: why } }];
}

const logOdds = (p) => Math.log(p / (1 - p));
const inOdds = (p) => Math.min(1 - 1e-6, Math.max(1e-6, p));

// Rounds down to as few decimals as possible, at least two, so that the result stays above a bound.
function roundedAbove(bound, value) {
  let unit = 100;
  while (Math.floor(value * unit) / unit <= bound && unit < kMaxUnit) unit *= 10;
  return Math.floor(value * unit) / unit;
}

// A threshold that separates the marked ellipses from all others, if one exists: the default, or the mean
// of the log odds.
function separatingProbability(marks, values) {
  if (values.detector !== "arcs") return [];
  const probabilities = ({ candidates }, isWanted) => candidates
    .filter(({ ellipse, detector }) => detector === "arcs" && isWanted(ellipse)).map(({ probability }) => probability);
  const ofMarks = marks.filter(({ truth }) => truth)
    .map((mark) => Math.max(0, ...probabilities(mark, (e) => isSame(e, mark.truth))));
  const ofOthers = marks.flatMap((mark) => probabilities(mark, (e) => !mark.truth || !isPartOf(e, mark.truth)));
  const low = Math.min(...ofMarks);
  const high = Math.max(0, ...ofOthers);
  if (!(low > high) || low === 1) return [];
  const middle = (logOdds(inOdds(low)) + logOdds(inOdds(Math.max(high, low / 4)))) / 2;
  const isUsual = low >= kUsualProbability && high < kUsualProbability;
  const to = isUsual ? kUsualProbability : roundedAbove(high, 1 / (1 + Math.exp(-middle)));
  if (to <= high || to > low || to === values["min-probability"]) return [];
  const why = `Probability of your marks: at least ${low.toFixed(2)}; of other ellipses: ` +
    `${high > 0 ? `at most ${high.toFixed(2)}` : "none found"}.`;
  return [{ changes: { "min-probability": to }, why: { "min-probability": why } }];
}

// Limits that reject wrong ellipses which are smaller, larger or flatter than all marks by a factor.
function tightLimits(truths, wrong, factor) {
  return kLimits.flatMap(({ name, what, unit, isMin, of, round }) => {
    const sizes = truths.map(of);
    const bound = isMin ? Math.min(...sizes) : Math.max(...sizes);
    const apart = wrong.map(of).filter((size) => {
      return isMin ? size * factor < bound : size > bound * factor;
    });
    if (apart.length === 0) return [];
    const nearest = isMin ? Math.max(...apart) : Math.min(...apart);
    const why = `${what} of your marks: ${rangeText(sizes, unit)}; of ${apart.length} wrong ` +
      `${apart.length === 1 ? "ellipse" : "ellipses"}: ${rangeText(apart, unit)}.`;
    return [{ changes: { [name]: round(Math.sqrt(bound * nearest)) }, why: { [name]: why } }];
  });
}

// A region around all marks, with a margin of the largest one, if wrong ellipses lie outside.
function regionOfMarks(truths, wrong, { width, height }, { "roi-source": source }) {
  if (source !== "none") return [];
  const { left, top, right, bottom } = unionOf(truths.map(boxOf));
  const margin = 2 * Math.max(...truths.map((e) => e.semi_major));
  const [x, y] = [left - margin, top - margin].map((each) => Math.max(0, Math.floor(each)));
  const wide = Math.min(width, Math.ceil(right + margin)) - x;
  const high = Math.min(height, Math.ceil(bottom + margin)) - y;
  const share = wide * high / (width * height);
  const outside = wrong.filter(({ cx, cy }) => cx < x || cy < y || cx > x + wide || cy > y + high).length;
  if (share > kMaxRegionShare || outside === 0) return [];
  const why = `All marks lie in ${Math.round(100 * share)} % of the picture; ${outside} wrong ` +
    `${outside === 1 ? "ellipse lies" : "ellipses lie"} outside.`;
  return [{ changes: { roi: [x, y, wide, high], "roi-source": "property" }, why: { roi: why } }];
}

const truthsOf = (marks) => marks.filter(({ truth }) => truth).map(({ truth }) => truth);

/** The trial whose limits and region accept all marked ellipses; null if the current ones do. */
export function admittingTrial(marks, values, defaults) {
  const truths = truthsOf(marks);
  return together([...wideLimits(truths, values, defaults), ...wholeFrame(truths, values)]);
}

/**
 * The trials for marked frames, the most likely one first.
 * @param marks   [{truth, candidates: [{ellipse, probability, detector}], width, height}]; a null truth
 *                = no target.
 * @param values  All settings by name.
 * @param defaults  Their defaults.
 * @param wrong   Ellipses that these settings find in the marked frames and that are not marked.
 * @param rivals  Ellipses that these settings select as the target instead.
 * @param isRight Whether these settings are right on all marked frames.
 */
export function trialsFor({ marks, values, defaults, wrong, rivals, isRight }) {
  const truths = truthsOf(marks);
  if (truths.length === 0) return [];
  const keepOut = [
    ...tightLimits(truths, rivals, kRivalFactor),
    ...tightLimits(truths, wrong, kClearFactor),
    ...regionOfMarks(truths, [...rivals, ...wrong], marks[0], values),
  ];
  if (isRight) return keepOut;
  const admit = admittingTrial(marks, values, defaults);
  const others = [
    ...separatingProbability(marks, values),
    ...adaptedEdges(values),
    ...otherDetector(values),
    ...faintEdges(values),
  ];
  if (!admit) return [...others, ...keepOut];
  return [admit, ...others, ...others.map((each) => together([admit, each])), ...keepOut];
}

/**
 * The ratio of inner to outer radius, if the marked ellipses are the outer edges of rings of one
 * ratio; else null.
 */
export function ringRatioOf(marks) {
  const ratios = marks.filter(({ truth }) => truth).map(({ truth, candidates }) => {
    const inner = candidates.map(({ ellipse }) => ellipse)
      .filter((e) => isPartOf(e, truth) && !isSame(e, truth) && e.semi_major < truth.semi_major);
    return Math.max(0, ...inner.map((e) => e.semi_major / truth.semi_major));
  });
  if (ratios.length === 0 || Math.min(...ratios) === 0) return null;
  const spread = Math.max(...ratios) - Math.min(...ratios);
  return spread < 0.03 ? Math.round(1000 * ratios.reduce((a, b) => a + b) / ratios.length) / 1000 : null;
}
