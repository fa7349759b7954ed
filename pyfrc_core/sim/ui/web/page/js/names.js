// The names of values for people: what the devices' rows call them, otherwise their paths.
import { model } from "#js/model.js";

let names = new Map();
let units = new Map();
let namesOf = null; // the panels that they were made from

export function nameOf(path) {
  if (namesOf !== model.panels) {
    namesOf = model.panels;
    names = namesOfRows(model.panels);
    units = new Map(model.panels.flatMap(({ rows }) => rows.filter((row) => row.unit).flatMap((row) => row.paths.map((each) => [each, row.unit]))));
  }
  return names.get(path) ?? OWN[path] ?? elementName(path) ?? withoutTable(path);
}

// Without the table of what robot code shows.
function withoutTable(path) {
  const table = model.hello?.options?.dashboard.tables.find((each) => path.startsWith(`${each}/`)) ?? "nt:";
  return path.startsWith(`${table}/`) ? path.slice(table.length + 1) : path.replace(/^nt:/, "");
}

// The unit of a value, as far as it is known; otherwise "".
export function unitOfPath(path) {
  nameOf(path); // and the units of the rows
  return units.get(path) ?? OWN_UNITS[path] ?? STRUCT_UNITS.find(([part]) => part.test(path))?.[1] ?? "";
}

const OWN_UNITS = { "sim.pose[0]": "ft", "sim.pose[1]": "ft", "sim.pose[2]": "rad" };
// The units of the parts of WPILib's structs, and of other values.
/** @type {[RegExp, string][]} */
const STRUCT_UNITS = [
  [/^nt:.*\/translation\/[xyz]$/, "m"],
  [/^nt:.*\/(rotation|angle)\/value$/, "rad"],
  [/^nt:.*\/(v[xy]|\d+\/(speed|velocity))$/, "m/s"],
  [/^nt:.*\/omega$/, "rad/s"],
  // What a name says at its end.
  [/^nt:.*([^a-zA-Z]deg|Deg|[dD]egrees|°)\W*$/, "°"],
  [/^nt:.*([^a-zA-Z]rad|Rad|[rR]adians)\W*$/, "rad"],
];
const OWN = { "sim.mode": "Mode", "sim.pose[0]": "Robot x", "sim.pose[1]": "Robot y", "sim.pose[2]": "Robot angle" };
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
