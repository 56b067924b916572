// SPDX-License-Identifier: MIT
// The controls of all properties, by purpose. A change applies immediately.
import { ask } from "./connection.js";
import { make, makeControl } from "./controls.js";

const kPollMs = 3000;
const kGroups = {
  detector: ["Detector", "criteria for an ellipse"],
  tracker: ["Tracker", "from frame to frame"],
  limits: ["Limits", "size and shape of the target"],
  "search region": ["Search region", "part of the frame"],
  scale: ["Scale", "resolution of the search"],
  "lens and pose": ["Lens and pose", "camera and size of the target"],
  output: ["Output", "metadata, messages, overlay"],
  performance: ["Performance", "time limit and frame skipping"],
  other: ["Other", ""],
};
const kOpenAtFirst = ["detector", "tracker", "limits"];

const isSame = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/**
 * Why a setting currently has no effect; empty if it has one.
 * @param effect  The setting's "effect" from the program.
 * @param value   The setting's value; @param values  all values by name.
 */
function idleReason(effect, value, values) {
  if (!effect || (effect.otherwise && values[effect.otherwise] !== 0)) return "";
  const others = ["detector", "tracking"].filter((name) => effect[name] && effect[name] !== values[name]);
  if (others.length === 0) return "";
  const reason = `No effect with ${others.map((name) => `${name}=${values[name]}`).join(" and ")}`;
  if (effect.otherwise) return `${reason} unless ${effect.otherwise} is set`;
  const { elsewhere_above: above } = effect;
  if (!above || others.includes("tracking")) return reason;
  return value > above ? "" : `${reason} up to ${above}`;
}

export class Settings {
  #properties = [];
  #controls = new Map();  // by name: {property, control, node, error, idle, value}
  #pending = {};
  #isSending = false;
  /** Called when any value has changed, even by another client. */
  onChange = () => {};

  constructor(container, filter, resetAll) {
    this.container = container;
    this.resetAll = resetAll;
    filter.oninput = () => this.#filter(filter.value.trim().toLowerCase());
    resetAll.onclick = () => this.set(Object.fromEntries(this.changed().map((p) => [p.name, p.default])));
    setInterval(() => document.hidden || this.refresh(), kPollMs);
  }

  /** All values by name. */
  values() {
    return Object.fromEntries(this.#properties.map(({ name }) => [name, this.#controls.get(name).value]));
  }

  /** The default of each setting by name. */
  defaults() {
    return Object.fromEntries(this.#properties.map((property) => [property.name, property.default]));
  }

  changed() {
    return this.#properties.filter((p) => !this.#isDefault(p, this.#controls.get(p.name).value));
  }

  async refresh() {
    if (this.#isSending) return;
    let properties;
    try {
      properties = await ask("GET", "api/properties");
    } catch {
      return;
    }
    if (this.#isSending) return;
    if (this.#properties.length === 0) this.#build(properties);
    let hasChanged = false;
    for (const property of properties) {
      const entry = this.#controls.get(property.name);
      if (!entry) continue;
      const isOther = !isSame(entry.value, property.value);
      if (!isOther && entry.property.in_force === property.in_force) continue;
      entry.property.in_force = property.in_force;
      this.#show(entry, property.value);
      hasChanged ||= isOther;
    }
    this.#count();
    this.#showEffects();
    if (hasChanged) this.onChange();
  }

  /**
   * Sets {name: value, ...}. Values set during a request are sent together in the next one.
   * @returns the program's message if it rejected them, else "".
   */
  async set(values) {
    Object.assign(this.#pending, values);
    for (const [name, value] of Object.entries(values)) this.#show(this.#controls.get(name), value);
    this.#count();
    this.#showEffects();
    if (this.#isSending) return "";
    this.#isSending = true;
    let trouble = "";
    while (Object.keys(this.#pending).length > 0) {
      const sent = this.#pending;
      this.#pending = {};
      trouble = await this.#send(sent);
    }
    this.#isSending = false;
    await this.refresh();
    this.onChange();
    return trouble;
  }

  /** Scrolls to a setting and focuses it. */
  reveal(name) {
    const entry = this.#controls.get(name);
    if (!entry) return;
    entry.node.closest("details").open = true;
    entry.node.scrollIntoView({ block: "center" });
    entry.node.querySelector("input, select")?.focus({ preventScroll: true });
    entry.node.classList.remove("found");
    requestAnimationFrame(() => entry.node.classList.add("found"));
  }

  async #send(values) {
    let trouble = "";
    try {
      await ask("PUT", "api/properties", values);
    } catch (error) {
      trouble = error.message;
    }
    for (const name of Object.keys(values)) this.#controls.get(name).error.textContent = trouble;
    return trouble;
  }

  #build(properties) {
    this.#properties = properties;
    const groups = new Map(Object.keys(kGroups).map((name) => [name, []]));
    for (const property of properties) {
      if (!groups.has(property.group)) groups.set(property.group, []);
      groups.get(property.group).push(property);
    }
    for (const [group, members] of groups) {
      if (members.length === 0) continue;
      const [title, about] = kGroups[group] ?? [group, ""];
      this.container.append(make("details", { className: "group", open: kOpenAtFirst.includes(group) },
        make("summary", {}, title, make("small", {}, about)),
        ...members.map((property) => this.#setting(property))));
    }
  }

  #setting(property) {
    const { name } = property;
    const control = makeControl(property, (value) => this.set({ [name]: value }));
    const reset = make("button", { className: "quiet reset", title: `Reset to ${property.default}` });
    reset.setAttribute("aria-label", `Reset ${name}`);
    reset.innerHTML = '<svg viewBox="0 0 20 20" aria-hidden="true"><use href="#i-reset"/></svg>';
    reset.onclick = () => this.set({ [name]: property.default });
    const help = make("p", { className: "help", id: `help-${name}` }, property.blurb);
    const idle = make("p", { className: "idle", id: `idle-${name}`, hidden: true });
    const error = make("p", { className: "error", role: "alert" });
    const node = make("div", { className: "setting" },
      make("div", { className: "head" },
        make("span", { className: "name" }, name), reset, ...control.head,
        ...(property.unit ? [make("span", { className: "unit" }, property.unit)] : [])),
      ...control.body, idle, help, error);
    node.dataset.setting = name;
    for (const input of node.querySelectorAll("input")) input.setAttribute("aria-describedby", `${idle.id} ${help.id}`);
    const entry = { property, control, node, error, idle };
    this.#controls.set(name, entry);
    this.#show(entry, property.value);
    return node;
  }

  #show(entry, value) {
    entry.value = value;
    entry.control.set(value, entry.property.in_force);
    entry.node.classList.toggle("changed", !this.#isDefault(entry.property, value));
  }

  // Flags, regions and vectors have more than one representation of their default.
  #isDefault({ type, default: usual }, value) {
    if (type === "rect") return usual.length === 0 ? !value[2] : isSame(value, usual);
    if (type === "vector") return value.every((number, i) => number === (usual[i] ?? 0));
    if (type === "flags") return isSame(value, usual) || (value === "none" && usual === "Nothing");
    return isSame(value, usual);
  }

  // Greys out settings without effect for the current detector and tracking mode, and shows the reason.
  // They can still be set.
  #showEffects() {
    const values = this.values();
    for (const { property, node, idle, value } of this.#controls.values()) {
      const reason = idleReason(property.effect, value, values);
      idle.textContent = reason;
      idle.hidden = reason === "";
      node.classList.toggle("idle", reason !== "");
    }
  }

  #count() {
    const count = this.changed().length;
    this.resetAll.disabled = count === 0;
    this.resetAll.textContent = count === 0 ? "Reset all" : `Reset ${count}`;
  }

  #filter(text) {
    for (const { property, node } of this.#controls.values()) {
      node.hidden = !`${property.name} ${property.blurb}`.toLowerCase().includes(text);
    }
    for (const group of this.container.querySelectorAll("details.group")) {
      group.hidden = !group.querySelector(".setting:not([hidden])");
      if (text) group.open = true;
    }
  }
}
