// SPDX-License-Identifier: MIT
// Presets of the element, and the gst-launch-1.0 line of the current settings.
import { ask } from "./connection.js";
import { make } from "./controls.js";

const at = (id) => document.getElementById(id);

/** @returns a function to call whenever settings have changed. */
export function setUpPresets(settings, notify) {
  const list = at("preset");
  const dialog = at("save-dialog");
  let presets = [];
  let loaded = null;  // {name, values}: the preset loaded or saved last, and all values at that time

  const refresh = async (chosen = list.value) => {
    presets = await ask("GET", "api/presets");
    list.replaceChildren(
      make("option", { value: "" }, "Preset…"),
      ...presets.map(({ name, comment }) => make("option", { value: name, title: comment }, name)));
    list.value = presets.some(({ name }) => name === chosen) ? chosen : "";
    updateButtons();
  };
  const updateButtons = () => {
    const preset = presets.find(({ name }) => name === list.value);
    at("preset-load").disabled = !preset;
    at("preset-delete").disabled = !preset?.is_own;
    showState();
  };
  const showState = () => {
    at("preset-state").textContent = [
      ...(loaded ? [stateOf(loaded, settings.values())] : []),
      ...(list.value && list.value !== loaded?.name ? [`${list.value} is selected, not loaded`] : []),
    ].join("; ");
  };
  const keep = (name) => {
    loaded = { name, values: settings.values() };
    showState();
  };
  const attempt = async (task) => {
    try {
      await task();
    } catch (error) {
      notify(error.message);
    }
  };
  const pathOf = (name) => `api/presets/${encodeURIComponent(name)}`;

  list.onchange = updateButtons;
  at("preset-load").onclick = () => attempt(async () => {
    await ask("POST", `${pathOf(list.value)}/load`);
    await settings.refresh();
    keep(list.value);
    notify(`Loaded ${list.value}`);
  });
  at("preset-delete").onclick = () => attempt(async () => {
    await ask("DELETE", pathOf(list.value));
    if (loaded?.name === list.value) loaded = null;
    await refresh();
  });
  at("preset-save").onclick = () => {
    at("save-error").textContent = "";
    at("save-name").value = presets.find(({ name, is_own }) => is_own && name === list.value)?.name ?? "";
    dialog.showModal();
  };
  at("save-cancel").onclick = () => dialog.close();
  at("save-form").onsubmit = async (event) => {
    event.preventDefault();
    const name = at("save-name").value.trim();
    try {
      await ask("PUT", pathOf(name));
      dialog.close();
      await refresh(name);
      keep(name);
      notify(`Saved as ${name}`);
    } catch (error) {
      at("save-error").textContent = error.message;
    }
  };

  at("launch-copy").onclick = () => attempt(async () => {
    const line = (await ask("GET", "api/launch-line")).trim();
    at("launch-line").textContent = line;
    at("launch-line").hidden = false;
    // Browsers provide the clipboard only on localhost and over TLS. Elsewhere the user can select the line.
    if (!navigator.clipboard) return;
    await navigator.clipboard.writeText(line);
    notify("Copied");
  });
  attempt(refresh);
  return showState;
}

// Names the active preset and counts the settings changed since.
function stateOf({ name, values }, now) {
  const changed = Object.keys(values).filter((each) => JSON.stringify(values[each]) !== JSON.stringify(now[each]));
  if (changed.length === 0) return `Active preset: ${name}`;
  return `Active preset: ${name}; ${changed.length} ${changed.length === 1 ? "setting" : "settings"} changed since`;
}
