// The names of values for people: what the devices' rows call them, otherwise their paths.
import { model } from "#js/model.js";

let names = new Map();
let namesOf = null; // the panels that they were made from

export function nameOf(path) {
  if (namesOf !== model.panels) {
    namesOf = model.panels;
    names = namesOfRows(model.panels);
  }
  return names.get(path) ?? OWN[path] ?? elementName(path) ?? withoutTable(path);
}

// Without the table of what robot code shows.
function withoutTable(path) {
  const table = model.hello?.options?.dashboard.tables.find((each) => path.startsWith(`${each}/`)) ?? "nt:";
  return path.startsWith(`${table}/`) ? path.slice(table.length + 1) : path;
}

const OWN = { "sim.mode": "Mode", "sim.pose[0]": "Robot x, ft", "sim.pose[1]": "Robot y, ft", "sim.pose[2]": "Robot angle, rad" };
const CONTROLS = { axes: "axis", buttons: "button", povs: "POV" };

function elementName(path) {
  const match = /^joysticks\[(\d+)\]\.(axes|buttons|povs)\[(\d+)\]$/.exec(path);
  return match ? `Joystick ${match[1]} ${CONTROLS[match[2]]} ${match[3]}` : undefined;
}

function namesOfRows(panels) {
  const found = new Map();
  for (const { title, rows } of panels) {
    let heading = "";
    for (const row of rows) {
      const indented = row.label.startsWith(" ");
      if (!indented) heading = row.label;
      const label = row.label.trim().replace(/\s+/g, " ");
      const named = indented ? `${heading.trim()} ${label}` : /^\d/.test(label) ? `${title} ${label}` : label;
      if (row.paths.length === 1) found.set(row.paths[0], named);
      else row.paths.forEach((path, index) => found.set(path, `${named} ${index}`));
    }
  }
  return found;
}
