// Which panels are open in the chosen layout.
import { activate, close, largestTabs, placeOf, put } from "#js/layout/tree.js";
import { settings } from "#js/settings.js";

let recent = []; // panels that were brought to the front, the last one first

// On a narrow screen, where the tabs are others than those of the layout.
export function bringToFront(id) {
  recent = [id, ...recent.filter((each) => each !== id)];
}

export function frontOf(panels) {
  return recent.find((id) => panels.includes(id));
}

// Close a panel, or open it.
export function toggle(id) {
  const { tree } = settings;
  settings.tree = placeOf(tree, id) ? close(tree, id) : openPanel(tree, id);
}

function openPanel(tree, id, beside = null) {
  return put(tree, (beside && placeOf(tree, beside)) ?? largestTabs(tree), id, "center");
}

// Bring a panel to the front. If it is closed, open it: in the tabs with another one, or else in the largest ones.
export function showPanel(id, beside = null) {
  bringToFront(id);
  const { tree } = settings;
  const place = placeOf(tree, id);
  settings.tree = place ? activate(tree, place, id) : openPanel(tree, id, beside);
}
