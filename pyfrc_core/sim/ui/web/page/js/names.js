// The names of values for people: what the devices' rows call them, otherwise their paths.
import { model } from "./model.js";

let names = new Map();
let namesOf = null; // the panels that they were made from

export function nameOf(path) {
  if (namesOf !== model.panels) {
    namesOf = model.panels;
    names = namesOfRows(model.panels);
  }
  return names.get(path) ?? path.replace(/^nt:\/(SmartDashboard\/)?/, "");
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
