// What a person has arranged: panels, plots, pins, keys, gamepads, light or dark. The server keeps it for the project.
import { Disconnected, ask } from "#js/connection.js";
import { model } from "#js/model.js";
import { PRESETS } from "#js/layout/presets.js";
import { isRecorded } from "#js/recorded.js";

const SAVE_AFTER = 400; // milliseconds without another change
// A page that is reloaded before that finds its arrangement here, in this tab of the browser.
const UNSAVED = "pyfrc-unsaved";

const DEFAULTS = {
  version: 1,
  theme: "auto",
  layout: matchMedia("(pointer: coarse)").matches ? "tablet" : "driving",
  trees: {},
  plots: {},
  pins: [],
  fieldLayers: {},
  fieldRobot: "", // the path of the pose that is the robot of a log, if another one than pyfrc takes
  dashboard: "", // the name of the one that is shown
  coordinates: "", // how places on the field are written; as the project says unless chosen
  keyboard: { chosen: null, own: [] },
  gamepads: {},
  console: { levels: ["info", "warning", "error", "pyfrc"] },
};

class Settings {
  values = structuredClone(DEFAULTS);
  #timer = null;
  #saved = structuredClone(DEFAULTS); // as far as this page knows

  // Take over what was saved. What this version does not know, or what is broken, is left at its default.
  load(saved) {
    this.#take(saved);
    this.#saved = structuredClone(this.values);
    const unsaved = isRecorded ? null : sessionStorage.getItem(UNSAVED);
    if (!unsaved || model.readonly) return;
    this.#take(JSON.parse(unsaved));
    this.save();
  }

  #take(saved) {
    if (saved === null || typeof saved !== "object" || saved.version !== 1) return;
    for (const [name, value] of Object.entries(DEFAULTS)) {
      const given = saved[name];
      if (given === undefined || typeof given !== typeof value || Array.isArray(given) !== Array.isArray(value)) continue;
      this.values[name] = structuredClone(given);
    }
    if (!PRESETS[this.values.layout] && !this.values.trees[this.values.layout]) this.values.layout = DEFAULTS.layout;
  }

  get(name) {
    return this.values[name];
  }

  set(name, value) {
    this.values[name] = value;
    model.announce("settings");
    if (model.readonly) return;
    sessionStorage.setItem(UNSAVED, JSON.stringify(this.values));
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.save(), SAVE_AFTER);
  }

  // Only what was changed here: another window may have changed other things meanwhile.
  async save() {
    const timer = this.#timer;
    const now = structuredClone(this.values);
    try {
      await ask("layout", { layout: { version: DEFAULTS.version, ...changes(this.#saved, now, 2) } });
    } catch (error) {
      if (error instanceof Disconnected) return; // `saveUnsaved` comes with the next one
      return model.set("problem", error.message);
    }
    this.#saved = now;
    if (timer === this.#timer) sessionStorage.removeItem(UNSAVED);
  }

  // Save what could not be saved while there was no connection.
  saveUnsaved() {
    if (sessionStorage.getItem(UNSAVED)) this.save();
  }

  // The panels' arrangement in the chosen layout.
  get tree() {
    const name = this.values.layout;
    return this.values.trees[name] ?? PRESETS[name].tree;
  }

  set tree(tree) {
    this.set("trees", { ...this.values.trees, [this.values.layout]: tree });
  }

  // Give the chosen layout its first arrangement again.
  resetTree() {
    const { [this.values.layout]: _, ...others } = this.values.trees;
    if (!PRESETS[this.values.layout]) this.set("layout", DEFAULTS.layout);
    this.set("trees", others);
  }
}

// What differs between two objects, this many levels deep; null for what is gone.
function changes(before, after, levels) {
  const found = {};
  for (const name of new Set([...Object.keys(before), ...Object.keys(after)])) {
    const [old, now] = [before[name], after[name]];
    if (JSON.stringify(old) === JSON.stringify(now)) continue;
    found[name] = levels > 1 && isObject(old) && isObject(now) ? changes(old, now, levels - 1) : (now ?? null);
  }
  return found;
}

function isObject(value) {
  return value !== null && typeof value === "object" && !Array.isArray(value);
}

export const settings = new Settings();

// Set what the chosen theme says on the page: "light", "dark", or what the system prefers.
export function applyTheme() {
  document.documentElement.dataset.theme = isDark() ? "dark" : "light";
}

export function isDark() {
  const theme = settings.get("theme");
  return theme === "auto" ? matchMedia("(prefers-color-scheme: dark)").matches : theme === "dark";
}

// The value of a colour of theme.css, for canvases.
let colorsOf = {};
let colorsFor = "";
export function color(name) {
  const theme = document.documentElement.dataset.theme;
  if (colorsFor !== theme) {
    colorsFor = theme;
    colorsOf = {};
  }
  return (colorsOf[name] ??= resolved(name));
}

function resolved(name) {
  const probe = document.createElement("i");
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const found = getComputedStyle(probe).color;
  probe.remove();
  return found;
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  applyTheme();
  model.announce("settings", "shown");
});
