// Topics of widgets: "/SmartDashboard/kP" or a table of NetworkTables, or a path into hal_data; and what is published there.
// A topic of NetworkTables whose name begins without a slash is its whole path: "nt:kP".
import { model } from "#js/model.js";
import { elementIn, valueIn } from "#js/parts.js";

export function pathOf(topic) {
  return topic.startsWith("/") ? `nt:${topic}` : topic;
}

export function topicOf(path) {
  return path.startsWith("nt:/") ? path.slice("nt:".length) : path;
}

// The value to which a path belongs: of an element its list.
export function boundPath(path) {
  return model.values.has(path) ? path : elementIn(path)[0];
}

// Whether there is a value at the moment that is shown, or a table with some.
export function isPublished(path) {
  const { values } = model.shown;
  if (valueIn(values, path) !== undefined) return true;
  for (const each of values.keys()) if (each.startsWith(`${path}/`)) return true;
  return false;
}

// The paths of those values of a table that are published.
export function valuesIn(path, names) {
  return names.map((name) => `${path}/${name}`).filter((each) => model.shown.values.has(each));
}

// The type of a table that robot code has published, such as "PIDController", or of a topic; otherwise "".
export function typeOf(path) {
  const type = model.shown.values.get(`${path}/.type`);
  return typeof type === "string" ? type : (model.types[path] ?? "");
}
