// Which values are plotted where: each plot panel has a list of curves in the settings.
import { CURVE_COLORS, LINES, isComputed, unitOf } from "#js/curves.js";
import { showPanel } from "#js/layout/open.js";
import { panelsOf } from "#js/layout/presets.js";
import { model } from "#js/model.js";
import { unitOfPath } from "#js/names.js";
import { settings } from "#js/settings.js";

const PATH_TYPE = "application/x-pyfrc-path";
const TABLE_TYPE = "application/x-pyfrc-table";
const MOST_CURVES = CURVE_COLORS * LINES.length; // each of which looks different

// Begin to drag a value.
export function carryPath(event, path) {
  event.stopPropagation();
  event.dataTransfer.setData(PATH_TYPE, path);
  event.dataTransfer.setData("text/plain", path);
  event.dataTransfer.effectAllowed = "copy";
}

// Begin to drag a table, which dashboards take.
export function carryTable(event, path) {
  event.stopPropagation();
  event.dataTransfer.setData(TABLE_TYPE, path);
  event.dataTransfer.effectAllowed = "copy";
}

// Whether a value or a table is dragged, and which.
export function hasTopic(event) {
  return hasPath(event) || event.dataTransfer.types.includes(TABLE_TYPE);
}

export function carriedTopic(event) {
  return carriedPath(event) || event.dataTransfer.getData(TABLE_TYPE);
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
  if (!plotOf(id).curves.some((curve) => curve.path === path && !isComputed(curve))) addCurve(id, { path, axis: axisFor(path, plotOf(id).curves) });
  showPanel(id);
}

// The right axis if what is known at the left one has other units: degrees make a curve in radians look flat.
function axisFor(path, curves) {
  const unit = unitOfPath(path);
  const others = curves.filter(({ axis }) => axis === "left").map(unitOf).filter(Boolean);
  return unit && others.length && !others.includes(unit) ? "right" : "left";
}

// Add a curve, even one of a value that the plot shows already.
export function addCurve(id, curve) {
  const { curves } = plotOf(id);
  if (curves.length >= MOST_CURVES) {
    model.set("problem", `A plot has at most ${MOST_CURVES} curves. Remove one of them, or open another plot under “Panels”.`);
    return;
  }
  const keys = new Set(curves.map((each) => each.key ?? each.path));
  const colors = new Set(curves.map((each) => each.color));
  let color = 0;
  while (colors.has(color)) color += 1;
  let key = curve.path;
  for (let number = 2; keys.has(key); number++) key = `${curve.path} (${number})`;
  changePlot(id, { curves: [...curves, { ...curve, key, color }] });
}

// Show a value that differs in a plot, around a moment; that of the one before goes, if it came in the same way.
export function plotFound(path, t) {
  const id = openPlot();
  const { found: before } = model;
  const kept = plotOf(id).curves.filter((curve) => !before?.added || curve.path !== before.path || path === before.path);
  const added = !kept.some((curve) => curve.path === path) || Boolean(before?.added && before.path === path);
  changePlot(id, { curves: kept });
  addToPlot(path, id);
  model.set("found", { path, t, added });
}

function openPlot() {
  return panelsOf(settings.tree).find((id) => id.startsWith("plot:")) ?? "plot:1";
}
