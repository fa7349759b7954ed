// NetworkTables as a tree. Numbers, texts, switches and lists can be edited; any value can be plotted.
import { write } from "#js/connection.js";
import { plain, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { addToPlot, carryPath } from "#js/plotting.js";
import { ValueBox } from "#js/value_box.js";
import { Component, Icon, Live, classes, createRef, html } from "#js/view.js";

const START = "nt:/";

export class NetworkTablesPanel extends Live {
  parts = ["paths", "types", "hello", "shown"];
  state = { search: "", open: Object.fromEntries(model.hello.options.dashboard.tables.map((table) => [table, true])) };

  render(_, { search, open }) {
    const words = search.toLowerCase().split(/\s+/).filter(Boolean);
    const paths = [...model.shown.values.keys()].filter((path) => path.startsWith(START) && words.every((word) => path.toLowerCase().includes(word)));
    const tree = treeOf(paths);
    const rows = [];
    const visit = (node, depth) => {
      for (const child of [...node.children.values()].sort(byName)) {
        const isOpen = words.length > 0 || open[child.path];
        if (child.children.size) rows.push(html`<${Folder} key=${`folder ${child.path}`} node=${child} depth=${depth} open=${isOpen} toggle=${() => this.toggle(child.path)} />`);
        if (child.leaf) rows.push(html`<${Leaf} key=${child.path} path=${child.path} name=${child.name} depth=${depth} />`);
        if (child.children.size && isOpen) visit(child, depth + 1);
      }
    };
    visit(tree, 0);
    return html`<div class="networktables">
      <label class="search"><${Icon} name="search" /><input type="search" placeholder="Search NetworkTables" value=${search}
        aria-label="Search NetworkTables" onInput=${(event) => this.setState({ search: event.target.value })} /></label>
      <div class="scroll" role="tree">${rows}${!rows.length && html`<p class="empty">${search ? "No value is called that." : "The robot has published nothing yet."}</p>`}</div>
    </div>`;
  }

  toggle(path) {
    const { open } = this.state;
    this.setState({ open: { ...open, [path]: !open[path] } });
  }
}

function byName(one, other) {
  const [first, second] = [one.name.startsWith("."), other.name.startsWith(".")];
  if (first !== second) return first - second; // ".schema" and the like at the end
  return one.name.localeCompare(other.name, "en", { numeric: true });
}

function treeOf(paths) {
  const root = { path: "nt:", children: new Map() };
  for (const path of paths) {
    let node = root;
    for (const name of path.slice(START.length).split("/")) {
      if (!node.children.has(name)) node.children.set(name, { name, path: `${node.path}/${name}`, children: new Map(), leaf: false });
      node = node.children.get(name);
    }
    node.leaf = true;
  }
  return root;
}

function Folder({ node, depth, open, toggle }) {
  const type = model.shown.values.get(`${node.path}/.type`);
  return html`<div class="nt-row folder" role="treeitem" aria-expanded=${open} style=${{ paddingLeft: `${depth * 14}px` }}>
    <button class=${classes({ fold: true, closed: !open })} onClick=${toggle}><${Icon} name="chevron" /><span>${node.name}</span></button>
    ${typeof type === "string" && html`<span class="chip">${type}</span>`}</div>`;
}

class Leaf extends Component {
  element = createRef();

  shouldComponentUpdate(next, state) {
    return next.path !== this.props.path || next.depth !== this.props.depth || state !== this.state;
  }

  componentDidMount() {
    this.unbind = model.bind(this.props.path, (value) => this.paint(plain(value)));
  }

  componentWillUnmount() {
    this.unbind();
  }

  // A value whose kind has changed needs another control; otherwise only its text changes.
  paint(value) {
    const kind = controlOf(value);
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
    this.paint(plain(model.shown.values.get(this.props.path)));
  }

  render({ path, name, depth }) {
    const kind = controlOf(plain(model.shown.values.get(path)));
    this.kind = kind;
    return html`<div class="nt-row" role="treeitem" ref=${this.element} style=${{ paddingLeft: `${depth * 14 + 18}px` }} title=${`${path} ${model.types[path] ?? ""}`}
        draggable="true" onDragStart=${(event) => carryPath(event, path)} data-path=${path}>
      <span class="row-label">${name}</span>
      ${kind === "switch"
        ? html`<label class="switch"><input type="checkbox" role="switch" class="nt-value" aria-label=${name} disabled=${model.readonly}
            onChange=${(event) => write({ [path]: event.target.checked })} /><i></i></label>`
        : kind === "none"
          ? html`<span class="nt-value faint"></span>`
          : html`<${ValueBox} class=${`nt-value ${kind}`} path=${path} label=${name} />`}
      <span class="row-tools"><button class="tool" title="Plot this value" aria-label=${`Plot ${name}`} onClick=${() => addToPlot(path)}><${Icon} name="plus" /></button></span>
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
