// Which values are plotted where: each plot panel has a list of curves in the settings.
import { showPanel } from "#js/layout/open.js";
import { panelsOf } from "#js/layout/presets.js";
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";

const PATH_TYPE = "application/x-pyfrc-path";
const MOST_CURVES = 12;
const CURVE_COLORS = 8; // --curve-0 to --curve-7 in theme.css

// Begin to drag a value.
export function carryPath(event, path) {
  event.stopPropagation();
  event.dataTransfer.setData(PATH_TYPE, path);
  event.dataTransfer.setData("text/plain", path);
  event.dataTransfer.effectAllowed = "copy";
}

export function hasPath(event) {
  return event.dataTransfer.types.includes(PATH_TYPE);
}

export function carriedPath(event) {
  return event.dataTransfer.getData(PATH_TYPE);
}

export function plotOf(id) {
  return settings.get("plots")[id] ?? { curves: [], seconds: 20 };
}

export function changePlot(id, change) {
  settings.set("plots", { ...settings.get("plots"), [id]: { ...plotOf(id), ...change } });
}

// Add a value to a plot, or to the first one that is open.
export function addToPlot(path, id = openPlot()) {
  if (!path) return;
  const { curves } = plotOf(id);
  if (curves.some((curve) => curve.path === path)) return showPanel(id);
  if (curves.length >= MOST_CURVES) {
    model.set("problem", `A plot has at most ${MOST_CURVES} curves. Remove one of them, or open another plot under “Panels”.`);
  } else {
    const used = new Set(curves.map((curve) => curve.color));
    let color = 0;
    while (used.has(color) && color < CURVE_COLORS - 1) color += 1;
    changePlot(id, { curves: [...curves, { path, axis: "left", color }] });
  }
  showPanel(id);
}

function openPlot() {
  return panelsOf(settings.tree).find((id) => id.startsWith("plot:")) ?? "plot:1";
}
