// The panels on the screen: rows and columns with movable borders, and tabs that can be dragged elsewhere.
import { model } from "#js/model.js";
import { PANELS, panelTitle } from "#js/panels/all.js";
import { settings } from "#js/settings.js";
import { Component, Icon, Live, classes, createRef, html } from "#js/view.js";
import { bringToFront, frontOf } from "#js/layout/open.js";
import { stacked } from "#js/layout/presets.js";
import { activate, close, put, resize } from "#js/layout/tree.js";

const PANEL_TYPE = "application/x-pyfrc-panel";
const NARROW = 900; // pixels: below, panels are stacked
const LOW = 480; // pixels: of a phone that lies, where they are side by side
const KEY_SHARE = 0.02; // by how much an arrow key moves a border

export class Dock extends Live {
  parts = ["settings", "window"];

  render() {
    const narrow = innerWidth <= NARROW || innerHeight <= LOW;
    const tree = narrow ? stackedTree() : settings.tree;
    if (tree.kind === "tabs" && !tree.panels.length) {
      return html`<main class="dock fill"><p class="empty">No panel is open. Choose one under “Panels”.</p></main>`;
    }
    return html`<main class="dock fill"><${Node} node=${tree} place=${[]} narrow=${narrow} /></main>`;
  }
}

// On a narrow screen the arrangement is made from the chosen one.
function stackedTree() {
  const tree = stacked(settings.tree, innerHeight <= LOW);
  const choose = (node) => ({ ...node, active: frontOf(node.panels) ?? node.active });
  return tree.kind === "tabs" ? choose(tree) : { ...tree, children: tree.children.map(choose) };
}

function Node({ node, place, narrow }) {
  return node.kind === "tabs"
    ? html`<${Tabs} node=${node} place=${place} narrow=${narrow} />`
    : html`<${Split} node=${node} place=${place} narrow=${narrow} />`;
}

class Split extends Component {
  element = createRef();

  render({ node, place, narrow }) {
    const parts = [];
    node.children.forEach((child, index) => {
      if (index) parts.push(html`<${Border} key=${`border${index}`} split=${this} index=${index - 1} sizes=${node.sizes} narrow=${narrow} />`);
      const style = { flexGrow: String(node.sizes[index]) };
      parts.push(html`<div class="cell" key=${`cell${index}`} style=${style}>
        <${Node} node=${child} place=${[...place, index]} narrow=${narrow} />
      </div>`);
    });
    return html`<div class=${`split split-${node.kind}`} ref=${this.element}>${parts}</div>`;
  }

  move(index, share) {
    settings.tree = resize(settings.tree, this.props.place, index, share);
  }
}

class Border extends Component {
  render({ split, index, sizes, narrow }) {
    if (narrow) return html`<div class="border" role="separator"></div>`; // the arrangement is not the person's
    const across = split.props.node.kind === "row" ? "vertical" : "horizontal";
    const share = (100 * sizes[index]) / (sizes[index] + sizes[index + 1]);
    return html`<div class="border" role="separator" tabindex="0" aria-orientation=${across} aria-valuenow=${Math.round(share)}
      aria-label="Border between panels: arrow keys move it"
      onPointerDown=${this.begin} onPointerMove=${this.drag} onPointerUp=${this.end} onKeyDown=${this.key}></div>`;
  }

  begin = (event) => {
    event.currentTarget.setPointerCapture(event.pointerId);
    this.last = event;
  };

  drag = (event) => {
    if (!this.last) return;
    const box = this.props.split.element.current.getBoundingClientRect();
    const isRow = this.props.split.props.node.kind === "row";
    const share = isRow ? (event.clientX - this.last.clientX) / box.width : (event.clientY - this.last.clientY) / box.height;
    this.last = event;
    this.props.split.move(this.props.index, share);
  };

  end = () => {
    this.last = null;
  };

  key = (event) => {
    const by = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    this.props.split.move(this.props.index, by * KEY_SHARE);
  };
}

class Tabs extends Component {
  state = { over: null };

  render({ node, narrow }, { over }) {
    const active = node.panels.includes(node.active) ? node.active : node.panels[0];
    const kind = PANELS[active?.split(":")[0]];
    return html`<section class="tabs column" onDragOver=${this.over} onDragLeave=${this.leave} onDrop=${this.drop}
        data-panel=${active} aria-label=${panelTitle(active)}>
      <div class="tab-line flex">
        <div class="tab-list fill" role="tablist">
          ${node.panels.map((panel) => html`<div key=${panel} class=${classes({ tab: true, flex: true, active: panel === active })}
              draggable=${!narrow} onDragStart=${(event) => this.carry(event, panel)}>
            <button role="tab" aria-selected=${panel === active} onClick=${() => this.front(panel)}
              onKeyDown=${(event) => this.key(event, panel)}>${panelTitle(panel)}</button>
          </div>`)}
        </div>
        <button class="tab-close" title=${`Close ${panelTitle(active)}`} aria-label=${`Close ${panelTitle(active)}`} onClick=${() => this.close(active)}><${Icon} name="close" /></button>
      </div>
      <div class="panel fill" role="tabpanel" aria-label=${panelTitle(active)} key=${active}>
        ${kind && html`<${kind.component} key=${active} id=${active} />`}
      </div>
      ${over && html`<div class=${`drop-mark ${over}`}></div>`}
    </section>`;
  }

  front(panel) {
    if (!this.props.narrow) settings.tree = activate(settings.tree, this.props.place, panel);
    else {
      bringToFront(panel);
      model.announce("settings");
    }
  }

  close(panel) {
    settings.tree = close(settings.tree, panel);
  }

  // Delete closes a tab; the arrow keys choose the one beside it.
  key(event, panel) {
    const { panels } = this.props.node;
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === "Delete") this.close(panel);
    else if (by) {
      const next = panels[(panels.indexOf(panel) + by + panels.length) % panels.length];
      this.front(next);
      const list = event.currentTarget.closest(".tab-list");
      requestAnimationFrame(() => list.querySelectorAll('[role="tab"]')[panels.indexOf(next)]?.focus());
    } else return;
    event.stopPropagation();
    event.preventDefault();
  }

  carry(event, panel) {
    event.dataTransfer.setData(PANEL_TYPE, panel);
    event.dataTransfer.effectAllowed = "move";
  }

  over = (event) => {
    if (!event.dataTransfer.types.includes(PANEL_TYPE)) return;
    event.preventDefault();
    const over = sideOf(event);
    if (over !== this.state.over) this.setState({ over });
  };

  leave = (event) => {
    if (!event.currentTarget.contains(event.relatedTarget)) this.setState({ over: null });
  };

  drop = (event) => {
    const panel = event.dataTransfer.getData(PANEL_TYPE);
    this.setState({ over: null });
    if (!panel) return;
    event.preventDefault();
    const { node, place } = this.props;
    const where = sideOf(event);
    if (node.panels.length === 1 && node.panels[0] === panel) return;
    settings.tree = put(settings.tree, place, panel, where);
  };
}

// Which side of the tabs a pointer is near: the outer quarter, or the middle.
function sideOf(event) {
  const box = event.currentTarget.getBoundingClientRect();
  const x = (event.clientX - box.left) / box.width;
  const y = (event.clientY - box.top) / box.height;
  const sides = { left: x, right: 1 - x, top: y, bottom: 1 - y };
  const [side, distance] = Object.entries(sides).sort((one, other) => one[1] - other[1])[0];
  return distance < 0.25 ? side : "center";
}

addEventListener("resize", () => model.announce("window"));
