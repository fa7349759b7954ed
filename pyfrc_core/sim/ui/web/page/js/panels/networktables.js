// NetworkTables as a tree. Numbers, texts, switches and lists can be edited; any value can be plotted. Structs come as
// their parts, which only robot code changes; the elements of a list are below it.
import { write } from "#js/connection.js";
import { PlotButton, SearchBox, Switch } from "#js/controls.js";
import { putOnDashboard, takesTopics } from "#js/dashboard/adding.js";
import { plain, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { elementsOf } from "#js/parts.js";
import { carryPath, carryTable } from "#js/plotting.js";
import { ValueBox } from "#js/value_box.js";
import { Bound, Icon, classes, createRef, html } from "#js/view.js";
import { Finding } from "#js/panels/finding.js";

const START = "nt:";

export class NetworkTablesPanel extends Finding {
  parts = ["paths", "types", "hello", "shown", "settings", "found"];
  state = { search: "", open: Object.fromEntries(model.hello.options.dashboard.tables.map((table) => [table, true])) };
  search = (search) => this.setState({ search });

  render(_, { search, open }) {
    const words = search.toLowerCase().split(/\s+/).filter(Boolean);
    const known = model.past ? new Set([...model.values.keys(), ...model.past.values.keys()]) : model.values.keys();
    const paths = [...known].filter((path) => path.startsWith(START) && words.every((word) => path.toLowerCase().includes(word)));
    const tree = treeOf(paths);
    const rows = [];
    this.boards = takesTopics();
    const visit = (node, depth) => {
      for (const child of [...node.children.values()].sort(byName)) {
        const isOpen = words.length > 0 || (open[child.path] ?? (depth === 0 && tree.children.size === 1));
        if (child.children.size) rows.push(html`<${Folder} key=${`folder ${child.path}`} boards=${this.boards} node=${child} depth=${depth} open=${isOpen} toggle=${() => this.toggle(child.path, isOpen)} />`);
        if (child.leaf) this.addLeaf(rows, child, depth, open);
        if (child.children.size && isOpen) visit(child, depth + 1);
      }
    };
    visit(tree, 0);
    return html`<div class="networktables content column" ref=${this.element}>
      <${SearchBox} label="Search NetworkTables" text=${search} search=${this.search} />
      <div class="scroll fill" role="tree">${rows}${!rows.length && html`<p class="empty">${search ? `No value ${model.past ? "of this moment " : ""}is called that.` : "The robot has published nothing yet."}</p>`}</div>
    </div>`;
  }

  addLeaf(rows, { path, name }, depth, open) {
    const elements = elementsOf(path, model.shown.values.get(path));
    const toggle = elements.length ? () => this.toggle(path) : null;
    rows.push(html`<${Leaf} key=${path} boards=${this.boards} locked=${!model.mayWrite} path=${path} name=${name} depth=${depth} open=${Boolean(open[path])} toggle=${toggle} resized=${() => this.setState({})} />`);
    if (!open[path]) return;
    elements.forEach((element, index) => {
      rows.push(html`<${Leaf} key=${element} boards=${this.boards} locked=${!model.mayWrite} path=${element} name=${`[${index}]`} list=${path} index=${index} depth=${depth + 1} />`);
    });
  }

  stateToShow(path) {
    const open = { ...this.state.open };
    for (let end = START.length; end >= 0; end = path.indexOf("/", end + 1)) open[path.slice(0, end)] = true;
    return { search: "", open };
  }

  toggle(path, isOpen = this.state.open[path]) {
    this.setState({ open: { ...this.state.open, [path]: !isOpen } });
  }
}

function byName(one, other) {
  const [first, second] = [one.name.startsWith("."), other.name.startsWith(".")];
  if (first !== second) return first - second; // ".schema" and the like at the end
  return one.name.localeCompare(other.name, "en", { numeric: true });
}

// The nodes by their paths: a topic's name may begin without a slash, so "/Speed" and "Speed" are two tables.
export function treeOf(paths) {
  const root = { path: START, children: new Map() };
  for (const path of paths) {
    let node = root;
    for (let end = START.length; end < path.length; ) {
      const slash = path.indexOf("/", end + 1);
      end = slash < 0 ? path.length : slash;
      const whole = path.slice(0, end);
      if (!node.children.has(whole)) node.children.set(whole, { name: whole.slice(node.path.length).replace("/", ""), path: whole, children: new Map(), leaf: false });
      node = node.children.get(whole);
    }
    node.leaf = true;
  }
  return root;
}

// For who cannot drag a value there, as with a finger.
function ToDashboard({ path, name }) {
  const title = `Put ${name} on the dashboard`;
  return html`<button class="tool to-dashboard" title=${title} aria-label=${title} onClick=${() => putOnDashboard(path)}><${Icon} name="board" /></button>`;
}

function Folder({ boards, node, depth, open, toggle }) {
  const type = model.shown.values.get(`${node.path}/.type`) ?? model.types[node.path]?.replace("struct:", "");
  return html`<div class="nt-row flex folder" role="treeitem" aria-expanded=${open} draggable="true" onDragStart=${(event) => carryTable(event, node.path)} style=${{ paddingLeft: `${depth * 14}px` }}>
    <button class=${classes({ fold: true, closed: !open })} onClick=${toggle}><${Icon} name="chevron" /><span>${node.name}</span></button>
    ${typeof type === "string" && html`<span class="chip">${type}</span>`}
    ${boards && html`<span class="row-tools"><${ToDashboard} path=${node.path} name=${node.name} /></span>`}</div>`;
}

class Leaf extends Bound {
  element = createRef();

  shouldComponentUpdate(next, state) {
    const { path, depth, open, toggle, boards } = this.props;
    return next.locked !== this.props.locked || next.boards !== boards || next.path !== path || next.depth !== depth || next.open !== open || !next.toggle !== !toggle || state !== this.state;
  }

  get boundPath() {
    return this.props.list ?? this.props.path;
  }

  get value() {
    const value = model.shown.values.get(this.boundPath);
    return plain(this.props.list === undefined ? value : value?.[this.props.index]);
  }

  // A value whose kind has changed needs another control; otherwise only its text changes.
  paint() {
    const { value } = this;
    const kind = this.controlOf(value);
    if (Array.isArray(value) && value.length !== this.length) {
      if (this.length !== undefined) this.props.resized?.();
      this.length = value.length;
    }
    if (kind !== this.kind) {
      this.kind = kind;
      this.setState({});
    }
    const control = this.element.current?.querySelector(".nt-value");
    if (!control) return;
    if (control.type === "checkbox") control.checked = Boolean(value);
    else if (kind === "none") control.textContent = valueText(value);
  }

  componentDidUpdate() {
    super.componentDidUpdate();
    this.paint();
  }

  // Only topics can be written to: elements of lists and parts of structs have no type.
  controlOf(value) {
    return this.props.path in model.types ? controlOf(value) : "none";
  }

  render({ path, name, depth, open, toggle, boards }) {
    const kind = this.controlOf(this.value);
    this.kind = kind;
    return html`<div class="nt-row flex" role="treeitem" ref=${this.element} aria-expanded=${toggle ? open : undefined} style=${{ paddingLeft: `${depth * 14 + (toggle ? 0 : 18)}px` }}
        title=${`${path} ${model.types[path] ?? ""}`} draggable="true" onDragStart=${(event) => carryPath(event, path)} data-path=${path}>
      ${toggle
        ? html`<button class=${classes({ fold: true, "row-label": true, closed: !open })} title="The elements of this list" onClick=${toggle}><${Icon} name="chevron" /><span>${name}</span></button>`
        : html`<span class="row-label">${name}</span>`}
      ${kind === "switch"
        ? html`<${Switch} className="nt-value" label=${name} disabled=${!model.mayWrite} set=${(on) => write({ [path]: on })} />`
        : kind === "none"
          ? html`<span class="nt-value faint"></span>`
          : html`<${ValueBox} class=${`nt-value ${kind}`} path=${path} label=${name} />`}
      <span class="row-tools"><${PlotButton} name=${name} paths=${[path]} />
        ${boards && html`<${ToDashboard} path=${path} name=${name} />`}</span>
    </div>`;
  }
}

function controlOf(value) {
  if (typeof value === "boolean") return "switch";
  if (typeof value === "number") return "number";
  if (typeof value === "string") return "text";
  const simple = (each) => ["number", "boolean", "string"].includes(typeof each);
  return Array.isArray(value) && value.every(simple) ? "list" : "none";
}
