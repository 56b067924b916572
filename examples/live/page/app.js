// SPDX-License-Identifier: MIT
// Entry point of the page: connects its parts. Start reading here.
import { Compare } from "./compare.js";
import { watchFrames } from "./frames.js";
import { Guide, isFirstVisit } from "./guide.js";
import { Labels } from "./labels.js";
import { Playback } from "./playback.js";
import { Plots } from "./plots.js";
import { setUpPresets } from "./presets.js";
import { Region } from "./region.js";
import { Screen } from "./screen.js";
import { Settings } from "./settings.js";
import { Stages } from "./stages.js";
import { Status } from "./status.js";
import { setUpTabs } from "./tabs.js";

const at = (id) => document.getElementById(id);

const status = new Status();
const screen = new Screen(at("screen"), at("layers"));
const playback = new Playback(screen.canvas, status.notify);
const settings = new Settings(at("settings"), at("filter"), at("reset-all"));
const region = new Region(screen, settings, status.notify);
const plots = new Plots(at("plots"));
const views = {
  stages: new Stages(screen, playback, settings, status.notify),
  compare: new Compare(screen, playback, settings),
  label: new Labels(screen, playback),
};
let view = null;

function openView(next) {
  view?.stop();
  view = next;
  at("layers").hidden = view !== null;
  region.isOn = view === null;
  view?.start();
}
const openTab = setUpTabs((name) => {
  // The comparison stays visible in Tune, so that its settings can be changed.
  const stays = name === "tune" && view === views.compare && view.isKept;
  if (!stays && views[name] !== view) openView(views[name] ?? null);
});
const guide = new Guide(screen, playback, settings, () => {
  openTab("tune");
  at("guide-button").focus();
});
at("guide-button").onclick = () => {
  if (view === guide) return openTab("tune");
  openView(guide);
  at("guide").focus();
};

let plotted = null;  // timestamp of the last plotted line
watchFrames({
  onFrame: (frame) => {
    // A new picture, or a new analysis of a paused one.
    const isAnother = frame.pts !== screen.frame?.pts || frame.line !== screen.frame.line;
    screen.show(frame);
    status.takeFrame();
    playback.showFrame(frame.pts);
    if (isAnother && !playback.isPlaying) view?.refresh();
  },
  onLine: (line) => {
    status.takeLine(line);
    if (line.pts_ns !== plotted) plots.add(line);
    plotted = line.pts_ns;
  },
  onConnection: (isOpen) => status.setTrouble(isOpen ? "" : "No connection to ellipse-live; reconnecting"),
});
const showPresetState = setUpPresets(settings, status.notify);
settings.onChange = () => {
  screen.draw();
  showPresetState();
  view?.refresh();
};
let wasPlaying = true;
playback.onChange = (source) => {
  status.setTrouble(source.error);
  // Frames and the playback state arrive independently, so the view is refreshed for both.
  if (source.playing !== wasPlaying) view?.refresh();
  wasPlaying = source.playing;
};
views.stages.onSetting = (name) => {
  openTab("tune");
  settings.reveal(name);
};

screen.canvas.addEventListener("keydown", (event) => {
  if (event.key === "o" || event.key === "O") screen.toggleAll();
});
at("help-button").onclick = () => at("help-dialog").showModal();

settings.refresh();
playback.refresh();
if (isFirstVisit()) openView(guide);
