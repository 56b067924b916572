// SPDX-License-Identifier: MIT
// One control per property type. Each returns {head, body, set}. `set(value, inForce)` shows a value;
// `inForce` is the value in force where 0 selects another one. `change` is called with the user's value.

const kSteps = 1000;
const kFarMax = 1e6;   // above this maximum, a slider ends at a practical value
const kFarTime = 1e8;  // [ns]
const kRectParts = ["x", "y", "width", "height"];
const kVectorParts = ["x", "y", "z"];

function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in node) node[name] = value;
    else node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

export { make };

// Does not overwrite a field while the user types; it shows the new value when it loses focus.
function showWhenLeft(fields, show) {
  let shown = null;
  for (const field of fields) field.onblur = () => shown !== null && show(shown);
  return (value) => {
    shown = value;
    if (!fields.includes(document.activeElement)) show(value);
  };
}

/** Slider scale: linear, or logarithmic if the range spans more than two decades. */
export function scaleOf({ type, min, max, unit, default: usual }) {
  const isWhole = type !== "double";
  const far = unit === "ns" ? kFarTime : Math.max(1000, 100 * usual);
  const end = max > kFarMax ? far : max;
  const isEven = end - min <= 100 || (min > 0 && end / min <= 100);
  const shift = min > 0 ? 0 : 1;
  const low = Math.log(min + shift);
  const high = Math.log(end + shift);
  const round = (value) => {
    if (isWhole) return Math.round(value);
    return isEven ? Math.round(100 * value) / 100 : Number(value.toPrecision(3));
  };
  return {
    toShare: (value) => {
      const share = isEven ? (value - min) / (end - min)
                           : (Math.log(value + shift) - low) / (high - low);
      return Math.min(1, Math.max(0, share));
    },
    toValue: (share) => {
      const value = isEven ? min + share * (end - min)
                           : Math.exp(low + share * (high - low)) - shift;
      return Math.min(max, Math.max(min, round(value)));
    },
  };
}

function numberControl(property, change) {
  const { toShare, toValue } = scaleOf(property);
  const label = property.name;
  const slider = make("input", { type: "range", min: 0, max: kSteps, "aria-label": label });
  const field = make("input", {
    type: "number",
    min: property.min,
    max: property.max,
    step: property.type === "double" ? "any" : 1,
    "aria-label": `${label}, number`,
  });
  const mark = make("i", { className: "default", title: `default ${property.default}` });
  // The centre of the 16 px wide thumb stays 8 px away from the ends.
  const share = toShare(property.default);
  mark.style.left = `calc(${100 * share}% + ${8 - 16 * share}px)`;
  // Whether the value is 0 and selects another value, which the placeholder shows.
  let isOwn = false;
  const showInField = showWhenLeft([field], (value) => {
    field.value = isOwn ? "" : Number(value.toPrecision(12));
  });
  const set = (value, inForce = null) => {
    isOwn = value === 0 && Boolean(inForce);
    field.placeholder = isOwn ? `0 = ${Number(inForce.toPrecision(6))}` : "";
    slider.value = Math.round(kSteps * toShare(value));
    slider.style.setProperty("--at", `${100 * toShare(value)}%`);
    const shown = isOwn ? `0, in force: ${inForce}` : value;
    slider.setAttribute("aria-valuetext", `${shown}${property.unit ? ` ${property.unit}` : ""}`);
    showInField(value);
  };
  slider.oninput = () => {
    const value = toValue(slider.value / kSteps);
    set(value);
    change(value);
  };
  // Arrow keys move to the next different value, because one slider step can be too small to change it.
  slider.onkeydown = (event) => {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const now = Number(field.value);
    let position = Math.round(kSteps * toShare(now));
    let value = now;
    while (value === now && position + way >= 0 && position + way <= kSteps) {
      position += way;
      value = toValue(position / kSteps);
    }
    if (value === now) return;
    set(value);
    field.value = value;
    change(value);
  };
  field.onchange = () => {
    if (field.value !== "" && !Number.isNaN(field.valueAsNumber)) change(field.valueAsNumber);
  };
  return { head: [field], body: [make("div", { className: "slider" }, slider, mark)], set };
}

function boolControl(property, change) {
  const box = make("input", { type: "checkbox", "aria-label": property.name });
  box.onchange = () => change(box.checked);
  return { head: [box], body: [], set: (value) => { box.checked = value; } };
}

function enumControl(property, change) {
  const group = make("div", { className: "choices", role: "radiogroup", "aria-label": property.name });
  const radios = property.values.map(({ nick, name }) => {
    const radio = make("input", { type: "radio", name: `of-${property.name}`, value: nick });
    radio.onchange = () => change(nick);
    group.append(make("label", { className: "pill", title: name }, radio, make("span", {}, nick)));
    return radio;
  });
  const set = (value) => {
    for (const radio of radios) radio.checked = radio.value === value;
  };
  return { head: [], body: [group], set };
}

// Sends nicks; accepts nicks or names.
function flagsControl(property, change) {
  const flags = property.values.filter(({ nick }) => nick !== "none");
  const group = make("div", { className: "choices", role: "group", "aria-label": property.name });
  const boxes = flags.map(({ nick, name }) => {
    const box = make("input", { type: "checkbox", value: nick });
    box.onchange = () => {
      const chosen = boxes.filter((each) => each.checked).map((each) => each.value);
      change(chosen.join("+") || "none");
    };
    group.append(make("label", { className: "pill", title: name }, box, make("span", {}, nick)));
    return box;
  });
  const set = (value) => {
    const parts = value.split("+");
    flags.forEach(({ nick, name }, i) => {
      boxes[i].checked = parts.includes(nick) || parts.includes(name);
    });
  };
  return { head: [], body: [group], set };
}

// One field per array element. An empty array shows zeros.
const arrayControl = (parts, step, read) => (property, change) => {
  const fields = parts.map((part) => make("input", {
    type: "number", step, title: part, placeholder: part, "aria-label": `${property.name}, ${part}`,
  }));
  for (const field of fields) {
    field.onchange = () => change(fields.map((each) => read(each.valueAsNumber || 0)));
  }
  const set = showWhenLeft(fields, (value) => fields.forEach((field, i) => {
    field.value = value[i] ?? 0;
  }));
  return { head: [], body: [make("div", { className: "numbers" }, ...fields)], set };
};

// 0xAARRGGBB. The picker does not change alpha.
function colorControl(property, change) {
  let alpha = 0xff;
  const picker = make("input", { type: "color", "aria-label": property.name });
  picker.onchange = () => change(alpha * 2 ** 24 + parseInt(picker.value.slice(1), 16));
  const set = (value) => {
    alpha = Math.floor(value / 2 ** 24);
    picker.value = `#${(value % 2 ** 24).toString(16).padStart(6, "0")}`;
  };
  return { head: [picker], body: [], set };
}

function textControl(property, change) {
  const field = make("input", {
    type: "text",
    "aria-label": property.name,
    autocomplete: "off",
    disabled: !property.writable,
    placeholder: property.writable ? "" : "requires ellipse-live --cameras FOLDER",
  });
  field.onchange = () => change(field.value);
  const set = showWhenLeft([field], (value) => {
    field.value = value;
  });
  return { head: [], body: [field], set };
}

export function makeControl(property, change) {
  const kinds = {
    bool: boolControl,
    enum: enumControl,
    flags: flagsControl,
    rect: arrayControl(kRectParts, 1, Math.round),
    vector: arrayControl(kVectorParts, "any", Number),
    int: numberControl,
    uint: numberControl,
    uint64: numberControl,
    double: numberControl,
  };
  const isColor = property.name.endsWith("-color");
  return (isColor ? colorControl : kinds[property.type] ?? textControl)(property, change);
}
