// Ways to a new dashboard, and to a new widget: from the dashboard's own tools, and from a value's row elsewhere.
import { dashboards } from "#js/dashboard/dashboards.js";
import { firstFree, nearestFree } from "#js/dashboard/grid.js";
import { KINDS, firstSettings, kindsFor } from "#js/dashboard/kinds.js";
import { topicOf } from "#js/dashboard/topics.js";
import { askText } from "#js/dialog.js";
import { showPanel } from "#js/layout/open.js";
import { panelsOf } from "#js/layout/presets.js";
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";

// Ask for the name of a dashboard; null if the person gave up, or there is one of this name.
export async function askName(question, text) {
  const name = (await askText(question, text))?.slice(0, 60);
  if (name && dashboards.names.includes(name)) {
    model.set("problem", `There is a dashboard “${name}” already.`);
    return null;
  }
  return name;
}

// Begin to arrange a new dashboard; false if the person gave up.
export async function createDashboard() {
  const name = await askName("The name of the new dashboard", dashboards.names.includes("Drive") ? "" : "Drive");
  if (name) dashboards.arrange(name);
  return Boolean(name);
}

// Add a widget for a value or a table to the dashboard that is arranged, as near to a cell of its grid as there is space.
export function addTopic(path, cell = null) {
  const kind = kindsFor(path)[0];
  addWidget(kind, topicOf(path), firstSettings(kind, path), cell);
}

export function addWidget(kind, topic, settings = {}, cell = null) {
  const { draft } = dashboards;
  const [w, h] = KINDS[kind].size;
  const place = cell ? nearestFree(draft, { w, h }, cell) : firstFree(draft, { w, h });
  if (!place) return model.set("problem", "The grid is full. Remove a widget or make one smaller, or choose more columns and rows under “Grid”.");
  dashboards.change({ widgets: [...draft.widgets, { kind, topic, ...place, ...settings }] });
  dashboards.chosen = draft.widgets.length;
}

// Whether a row of a value has a button for `putOnDashboard`: a dashboard is open, and this page may change it.
export function takesTopics() {
  return !model.readonly && panelsOf(settings.tree).includes("dashboard");
}

// Add a widget for a value or a table, without dragging it.
export async function putOnDashboard(path) {
  showPanel("dashboard");
  if (dashboards.problem) return;
  if (!dashboards.draft) {
    if (dashboards.shown) dashboards.arrange();
    else if (!(await createDashboard())) return;
  }
  addTopic(path);
}
