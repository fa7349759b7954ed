// Changes of a layout's tree. Each function returns a new tree, and leaves the given one as it was.

// Change the node at a place: a list of child numbers from the root.
function replaceAt(tree, place, change) {
  if (!place.length) return change(tree);
  const [first, ...rest] = place;
  const children = tree.children.map((child, index) => (index === first ? replaceAt(child, rest, change) : child));
  return { ...tree, children };
}

// Remove empty tabs, and rows and columns of one child.
function tidy(tree) {
  if (tree.kind === "tabs") return tree.panels.length ? tree : null;
  const kept = tree.children
    .map((child, index) => ({ child: tidy(child), size: tree.sizes[index] ?? 1 }))
    .filter((each) => each.child !== null);
  if (!kept.length) return null;
  if (kept.length === 1) return kept[0].child;
  return { ...tree, children: kept.map((each) => each.child), sizes: kept.map((each) => each.size) };
}

function without(tree, panel) {
  if (tree.kind !== "tabs") return { ...tree, children: tree.children.map((child) => without(child, panel)) };
  const panels = tree.panels.filter((each) => each !== panel);
  return { ...tree, panels, active: panels.includes(tree.active) ? tree.active : panels[0] };
}

export function close(tree, panel) {
  return tidy(without(tree, panel)) ?? { kind: "tabs", panels: [], active: undefined };
}

export function activate(tree, place, panel) {
  return replaceAt(tree, place, (node) => ({ ...node, active: panel }));
}

// Move or open a panel at tabs: as one more tab ("center"), or beside them ("left", "right", "top", "bottom").
export function put(tree, place, panel, where) {
  const mark = Symbol("target");
  const marked = replaceAt(tree, place, (node) => ({ ...node, mark }));
  const placed = insert(without(marked, panel), mark, panel, where);
  return tidy(placed) ?? placed;
}

function insert(tree, mark, panel, where) {
  if (tree.kind !== "tabs") return { ...tree, children: tree.children.map((child) => insert(child, mark, panel, where)) };
  if (tree.mark !== mark) return tree;
  const { mark: _, ...node } = tree;
  if (where === "center") return { ...node, panels: [...node.panels, panel], active: panel };
  const added = { kind: "tabs", panels: [panel], active: panel };
  const kind = where === "left" || where === "right" ? "row" : "column";
  const children = where === "left" || where === "top" ? [added, node] : [node, added];
  return { kind, sizes: [50, 50], children };
}

// Move the border after a child by a share of the whole, keeping a least size on both sides.
export function resize(tree, place, index, share) {
  return replaceAt(tree, place, (node) => {
    const sizes = [...node.sizes];
    const whole = sizes.reduce((sum, size) => sum + size, 0);
    const least = whole * 0.06;
    const pair = sizes[index] + sizes[index + 1];
    sizes[index] = Math.min(Math.max(sizes[index] + share * whole, least), pair - least);
    sizes[index + 1] = pair - sizes[index];
    return { ...node, sizes };
  });
}

// The place of the largest tabs.
export function largestTabs(tree) {
  let best = { size: -1, place: [] };
  const visit = (node, size, place) => {
    if (node.kind === "tabs") {
      if (size > best.size) best = { size, place };
      return;
    }
    const whole = node.sizes.reduce((sum, each) => sum + each, 0);
    node.children.forEach((child, index) => visit(child, (size * node.sizes[index]) / whole, [...place, index]));
  };
  visit(tree, 1, []);
  return best.place;
}

export function placeOf(tree, panel, place = []) {
  if (tree.kind === "tabs") return tree.panels.includes(panel) ? place : null;
  for (let index = 0; index < tree.children.length; index++) {
    const found = placeOf(tree.children[index], panel, [...place, index]);
    if (found) return found;
  }
  return null;
}
