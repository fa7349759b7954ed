// A dashboard that the team has made: widgets on a grid, arranged here, and full screen for the drivers.
import { dashboards } from "#js/dashboard/dashboards.js";
import { addTopic, addWidget, askName, createDashboard } from "#js/dashboard/adding.js";
import { WidgetFrame, titleOf } from "#js/dashboard/frame.js";
import { KINDS, otherTables, kindsFor } from "#js/dashboard/kinds.js";
import { stepText } from "#js/dashboard/steps.js";
import { topicOf } from "#js/dashboard/topics.js";
import { askWhether } from "#js/dialog.js";
import { link } from "#js/link.js";
import { Dropdown, Menu } from "#js/popup.js";
import { model } from "#js/model.js";
import { sendables } from "#js/panels/widgets.js";
import { PlotPicker } from "#js/plot_picker.js";
import { carriedTopic, hasTopic } from "#js/plotting.js";
import { Icon, Live, classes, createRef, html } from "#js/view.js";

const QUIET_INTERVAL = 50; // milliseconds between two renderings, while nothing is arranged
const MOST_CELLS = 48; // columns or rows, as in config/dashboards.py

export class DashboardPanel extends Live {
  parts = ["dashboards", "settings", "hello", "paths", "types", "shown"];
  state = { full: false };
  element = createRef();
  grid = createRef();

  componentDidMount() {
    super.componentDidMount();
    this.unfollow = dashboards.follow();
    document.addEventListener("fullscreenchange", this.left);
    document.addEventListener("keydown", this.escape, true);
    document.addEventListener("keydown", this.stepKey);
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    this.unfollow();
    document.removeEventListener("fullscreenchange", this.left);
    document.removeEventListener("keydown", this.escape, true);
    document.removeEventListener("keydown", this.stepKey);
  }

  get arranging() {
    return Boolean(dashboards.draft) && !this.state.full;
  }

  render(_, { full }) {
    const { shown, problem } = dashboards;
    this.interval = dashboards.draft ? 0 : QUIET_INTERVAL;
    return html`<div class=${classes({ dashboard: true, column: true, full })} ref=${this.element}>
      ${full ? html`<button class="leave-full quiet" title="Leave the full screen: Escape" aria-label="Leave the full screen" onClick=${this.leaveFull}><${Icon} name="close" /></button>` : this.tools(shown)}
      ${full && html`<${NotPresent} />`}
      ${problem && html`<p class="dashboard-problem" role="alert"><${Icon} name="warning" /><span>${problem}\n${this.remedy(shown)}</span></p>`}
      ${this.arranging && dashboards.isOvertaken && this.overtaken()}
      ${shown ? this.board(shown) : !problem && this.nothing()}
    </div>`;
  }

  tools(shown) {
    const { arranging } = this;
    const { readonly } = model;
    return html`<div class="panel-tools flex">
      ${arranging ? html`<b class="dashboard-name">${dashboards.name}</b>` : html`<${Menu} label=${dashboards.name || "Dashboards"} title="Dashboards of this project" items=${this.items()} />`}
      <div class="spacer"></div>
      ${arranging
        ? html`${this.step(true)}${this.step(false)}
          <${PlotPicker} label="Add widget" more=${this.offered()} add=${(path) => addTopic(path)} />
          <${Dropdown} label="Grid" title="Columns and rows of the grid" content=${() => this.gridSettings(shown)} />
          <button class="quiet" onClick=${this.discard}>${dashboards.isChanged ? "Discard" : "Cancel"}</button>
          <button class="primary" title="Write it into sim/dashboards.json" disabled=${Boolean(dashboards.problem)} onClick=${() => dashboards.save()}>Save</button>`
        : html`${this.step(true)}${this.step(false)}
          ${shown && !readonly && html`<button class="quiet" title="Add, move and remove widgets" onClick=${() => dashboards.arrange()}>Arrange</button>`}
          ${shown && html`<button class="quiet" title="Full screen, for the drivers" onClick=${this.enterFull}><${Icon} name="fit" /><span>Full screen</span></button>`}`}
    </div>`;
  }

  // The button that undoes a step, or does it again. A dashboard that is only looked at has it after a change.
  step(isUndo) {
    const way = dashboards.problem ? null : dashboards.way(isUndo);
    if (!way && !(this.arranging || dashboards.way(!isUndo))) return null;
    const [name, keys] = isUndo ? ["Undo", "Ctrl+Z"] : ["Redo", "Ctrl+Shift+Z"];
    const title = way ? `${name} “${stepText(way.step, titleOf)}”: ${keys}` : `Nothing to ${name.toLowerCase()}: ${keys}`;
    return html`<button class="quiet" title=${title} aria-label=${name} disabled=${!way} onClick=${() => dashboards.go(isUndo)}><${Icon} name=${name.toLowerCase()} /></button>`;
  }

  // What to do about a file with a mistake.
  remedy(shown) {
    const kept = this.arranging ? " What you have arranged stays here, and can be saved then." : shown ? " The dashboard is the last one that could be read." : "";
    return `Correct the file, or take an earlier one from Git: nothing is written into it before.${kept}`;
  }

  // The file has something else in the place of what is arranged.
  overtaken() {
    const { draft } = dashboards;
    const found = dashboards.inFile(draft.base?.name) ?? dashboards.inFile(draft.name);
    const text = found
      ? `“${found.name}” was changed in sim/dashboards.json by another page, an editor or Git. Yours is not saved yet.`
      : `“${draft.base.name}” was removed from sim/dashboards.json meanwhile. “Save” writes yours again.`;
    return html`<p class="dashboard-problem" role="alert"><${Icon} name="warning" /><span>${text}</span>
      ${found && html`<button title="It is a step: undone, it brings yours back" onClick=${() => dashboards.takeOver()}>Take the other one</button>`}</p>`;
  }

  items() {
    const { name, names, problem } = dashboards;
    const disabled = model.readonly || Boolean(problem);
    /** @type {any[]} */
    const items = names.map((each) => ({ text: each, checked: each === name, act: () => dashboards.choose(each) }));
    if (items.length) items.push({ separator: true });
    items.push({ text: "New dashboard…", act: createDashboard, disabled });
    items.push({ text: "From a layout of Elastic", note: robotsLayout(), act: () => dashboards.takeLayout(), disabled });
    if (!name) return items;
    const copy = async () => {
      const given = await askName(`A copy of “${name}” is called`, `${name} 2`);
      if (!given) return;
      dashboards.arrange(given, dashboards.shown);
    };
    const rename = async () => {
      const given = await askName(`The new name of “${name}”`, name);
      if (given) await dashboards.rename(given);
    };
    const remove = async () => (await askWhether(`Remove the dashboard “${name}” from sim/dashboards.json?`, "Remove")) && dashboards.remove();
    return [...items, { text: "Copy…", act: copy, disabled }, { text: "Rename…", act: rename, disabled }, { text: "Remove…", act: remove, disabled }];
  }

  nothing() {
    if (model.readonly) return html`<p class="empty">This project has no dashboards. Who can drive the robot can make one.</p>`;
    return html`<div class="empty"><p>A dashboard has widgets, arranged as your team wants them. It is kept in <code>sim/dashboards.json</code>, beside the code.</p>
      <p><button class="primary" onClick=${createDashboard}>New dashboard…</button>
        <button class="quiet" title=${robotsLayout()} onClick=${() => dashboards.takeLayout()}>From a layout of Elastic</button></p></div>`;
  }

  board(shown) {
    const { arranging } = this;
    const board = { arranging, chosen: dashboards.chosen, choose: this.choose, cell: this.cell, change: this.change, remove: this.remove };
    const style = { "--columns": shown.columns, "--rows": shown.rows };
    return html`<div class=${classes({ grid: true, fill: true, arranging })} tabindex="0" ref=${this.grid} style=${style} onPointerDown=${this.leaveWidgets} onDragOver=${this.over} onDrop=${this.drop}>
      ${shown.widgets.map((widget, index) => html`<${WidgetFrame} key=${index} widget=${widget} index=${index} board=${board} />`)}
      ${!shown.widgets.length && html`<p class="empty grid-empty">${arranging ? "Drag a value here from NetworkTables, or choose “Add widget”." : "This dashboard has no widgets. Choose “Arrange”."}</p>`}
    </div>`;
  }

  gridSettings({ columns, rows }) {
    const box = (name, value) => html`<label>${name === "columns" ? "Columns" : "Rows"}
      <input type="number" min="1" max=${MOST_CELLS} value=${value} onKeyDown=${(event) => event.stopPropagation()}
        onChange=${(event) => dashboards.change({ [name]: Math.min(Math.max(Math.round(Number(event.target.value)) || 1, 1), MOST_CELLS) })} /></label>`;
    return html`<div class="form ">${box("columns", columns)}${box("rows", rows)}</div>`;
  }

  // -- widgets

  // What "Add widget" offers besides values: tables of the robot, and what needs no topic.
  offered() {
    const tables = [...sendables(model.values), ...otherTables()].filter(({ path }) => KINDS[kindsFor(path)[0]]);
    const alone = Object.entries(KINDS).filter(([, kind]) => kind.alone);
    return [
      ...tables.map(({ path, name, type }) => ({ key: path, name, note: type, add: () => addTopic(path) })),
      ...alone.map(([kind, { title }]) => ({ key: `kind ${kind}`, name: title, note: "", add: () => addWidget(kind, "") })),
    ];
  }

  change = (index, changes) => {
    const widgets = dashboards.draft.widgets.map((widget, other) => (other === index ? { ...widget, ...changes } : widget));
    dashboards.change({ widgets });
  };

  remove = (index) => {
    this.choose(-1);
    dashboards.change({ widgets: dashboards.draft.widgets.filter((_, other) => other !== index) });
  };

  choose = (index) => {
    if (index === dashboards.chosen) return;
    dashboards.chosen = index;
    this.setState({});
  };

  leaveWidgets = (event) => event.target === event.currentTarget && this.choose(-1);

  discard = async () => {
    if (!dashboards.isChanged || (await askWhether("Discard what you have changed?", "Discard"))) dashboards.discard();
  };

  cell = () => {
    const { columns, rows } = dashboards.shown;
    const { scrollWidth, scrollHeight } = this.grid.current;
    return [scrollWidth / columns, scrollHeight / rows];
  };

  over = (event) => {
    if (!hasTopic(event) || model.readonly) return;
    event.preventDefault();
    event.dataTransfer.dropEffect = "copy";
  };

  // A value on a graph becomes one of its curves, elsewhere a widget.
  drop = (event) => {
    const path = carriedTopic(event);
    if (!path || model.readonly) return;
    event.preventDefault();
    if (!dashboards.draft) dashboards.arrange();
    const over = event.target.closest?.(".widget-graph");
    const index = over ? [...this.grid.current.querySelectorAll(".widget")].indexOf(over) : -1;
    const graph = dashboards.draft.widgets[index];
    if (graph) return this.change(index, graph.topic ? { more: [...new Set([...(graph.more ?? []), topicOf(path)])] } : { topic: topicOf(path) });
    const box = this.grid.current.getBoundingClientRect();
    const [width, height] = this.cell();
    addTopic(path, { x: Math.floor((event.clientX - box.left + this.grid.current.scrollLeft) / width), y: Math.floor((event.clientY - box.top + this.grid.current.scrollTop) / height) });
  };

  // Where the buttons are. Boxes for text have an undo of their own.
  stepKey = (event) => {
    const name = event.key.toLowerCase();
    if (this.state.full || dashboards.problem || !(event.ctrlKey || event.metaKey) || event.altKey || !["z", "y"].includes(name)) return;
    if (event.target.closest?.("input:not([type=checkbox], [type=radio], [type=range]), textarea, dialog")) return;
    event.preventDefault();
    dashboards.go(name === "z" && !event.shiftKey);
  };

  // -- full screen

  enterFull = () => {
    this.setState({ full: true });
    this.element.current.requestFullscreen?.().catch(() => {}); // where the browser has none, it fills the page
  };

  leaveFull = () => {
    this.setState({ full: false });
    if (document.fullscreenElement) document.exitFullscreen();
  };

  left = () => {
    if (!document.fullscreenElement && this.state.full) this.setState({ full: false });
  };

  escape = (event) => {
    if (event.key === "Escape" && this.state.full) this.leaveFull();
  };
}

// Where the layout for Elastic is that becomes dashboards.
function robotsLayout() {
  return model.hello.source.kind === "robot" ? "the robot's" : "deploy/elastic-layout.json";
}

// Drivers must not take what they see for the present when it is not: the rest of the page does not say so in the full screen.
class NotPresent extends Live {
  parts = ["connection", "status", "station", "shown"];

  render() {
    const { text, kind } = link();
    const why = model.past && !model.isOver ? "This is the past." : kind === "live" || model.isOver ? "" : `${text}. These are the last values.`;
    return why && html`<p class="dashboard-problem" role="alert"><${Icon} name="warning" /><span>${why}</span></p>`;
  }
}
