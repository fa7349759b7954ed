// The layouts that are offered. A tree has rows and columns with sizes, and tabs of panels at its ends.

export function tabs(...panels) {
  return { kind: "tabs", panels, active: panels[0] };
}

export function row(sizes, ...children) {
  return { kind: "row", sizes, children };
}

export function column(sizes, ...children) {
  return { kind: "column", sizes, children };
}

// With `looks`, a layout is only for these sources that cannot be driven: a robot, or what is over, a log or a run.
/** @type {Record<string, { title: string, looks?: string[], tree: any }>} */
export const PRESETS = {
  robot: {
    title: "Robot",
    looks: ["robot"],
    tree: row(
      [24, 44, 32],
      tabs("networktables"),
      column([60, 40], tabs("field", "mechanism", "swerve", "cameras"), tabs("console")),
      column([62, 38], tabs("plot:1", "plot:2"), tabs("widgets", "match", "dashboard")),
    ),
  },
  log: {
    title: "Review",
    looks: ["log", "simulation"],
    tree: row(
      [24, 48, 28],
      tabs("networktables", "changes", "devices"),
      column([50, 50], tabs("field", "mechanism"), tabs("plot:1", "plot:2")),
      column([58, 42], tabs("console"), tabs("joysticks", "match", "widgets")),
    ),
  },
  driving: {
    title: "Driving",
    tree: row(
      [23, 53, 24],
      tabs("devices", "networktables"),
      column([68, 32], tabs("field", "mechanism"), tabs("console", "plot:1")),
      column([38, 62], tabs("match"), tabs("joysticks", "keys", "touch")),
    ),
  },
  tablet: {
    title: "Tablet",
    tree: column(
      [58, 42],
      row([28, 44, 28], tabs("networktables", "devices"), tabs("field", "mechanism", "plot:1"), tabs("match", "console", "joysticks", "widgets")),
      tabs("touch"),
    ),
  },
  tuning: {
    title: "Tuning",
    tree: row(
      [26, 50, 24],
      tabs("networktables", "devices"),
      column([50, 50], tabs("plot:1"), tabs("plot:2", "console")),
      column([45, 55], tabs("field", "mechanism"), tabs("widgets", "match", "joysticks")),
    ),
  },
  dashboard: {
    title: "Dashboard",
    tree: row([22, 78], tabs("networktables", "widgets", "match"), tabs("dashboard")),
  },
};

// The names of the layouts to choose from: also those that a person has arranged when there were more of them.
export function offeredLayouts(kind, isDriven, trees) {
  const offered = Object.keys(PRESETS).filter((name) => !PRESETS[name].looks || (!isDriven && PRESETS[name].looks.includes(kind)));
  return [...offered, ...Object.keys(trees).filter((name) => !PRESETS[name])];
}

export function layoutTitle(name) {
  return PRESETS[name]?.title ?? name.charAt(0).toUpperCase() + name.slice(1);
}

// On a narrow screen: the field and plots above, everything else in tabs below; or beside them.
export function stacked(tree, isLow = false) {
  const panels = panelsOf(tree);
  const above = panels.filter((id) => ["field", "mechanism", "dashboard"].includes(id) || id.startsWith("plot:"));
  const below = panels.filter((id) => !above.includes(id));
  if (!above.length || !below.length) return tabs(...panels);
  return (isLow ? row : column)(above.includes("dashboard") ? [66, 34] : [52, 48], tabs(...above), tabs(...below));
}

export function panelsOf(tree) {
  return tree.kind === "tabs" ? tree.panels : tree.children.flatMap(panelsOf);
}
