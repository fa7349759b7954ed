// "Add a value": a search through everything that can be plotted, also the elements of lists; and what else is offered.
import { SearchBox } from "#js/controls.js";
import { valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { nameOf } from "#js/names.js";
import { elementsOf, valueIn } from "#js/parts.js";
import { Popup } from "#js/popup.js";
import { Icon, html } from "#js/view.js";

const MOST = 60;
const LAST = /^nt:\/(LiveWindow|\.schema)|^event\.|\/\.\w+$|raw_value$/;
const BUTTONS = /^joysticks\[\d+\]\.buttons$/; // robot code counts them from the season's first one
const FROM_OUTSIDE = /^nt:\/(FMSInfo|DS|DSLog|DriverStation)\//;

export class PlotPicker extends Popup {
  state = { open: false, search: "" };
  search = (search) => this.setState({ search });

  componentWillUnmount() {
    super.componentWillUnmount();
    model.need(this, []);
  }

  componentDidUpdate() {
    model.need(this, this.state.open ? [""] : []);
  }

  opened(list) {
    list.querySelector("input").focus();
  }

  begin = (event) => event.newState === "open" && this.setState({ open: true, search: "" });

  // add(path): called with the value that was chosen; stays: whether a click leaves the list open; more: [{ key, name, note, add() }], above the values
  render({ label = "Add value", more = [], stays = false, add }, { open, search }) {
    const found = open ? searched(search) : [];
    const others = open ? more.filter(({ name, note }) => matches(`${name} ${note}`, search)) : [];
    return html`<div class="menu picker" ref=${this.element} onKeyDown=${this.pressed}>
      <button class="quiet" aria-expanded=${open} popovertarget=${this.id}><${Icon} name="plus" />${label}</button>
      <div class="menu-list" ...${this.list}>${open && html`
        <${SearchBox} label="Search all values" text=${search} search=${this.search} />
        <ul>${others.map(({ key, name, note, add: act }) => html`<li key=${key}><button title=${key} onClick=${() => this.choose(act)}><b>${name}</b><small>${note}</small></button></li>`)}
          ${found.map((path) => html`<li key=${path}><button title=${path} onClick=${({ detail }) => (stays && detail ? add(path) : this.choose(() => add(path)))}>
          <span class="long-name"><bdi>${nameOf(path)}</bdi></span><small>${valueText(valueIn(model.shown.values, path)).slice(0, 24)}</small></button></li>`)}</ul>
        ${found.length === MOST && html`<p class="faint">Only ${MOST} values are listed: search for others.</p>`}
        ${!found.length && !others.length && html`<p class="faint">No value ${model.past ? "of this moment " : ""}is called that.</p>`}`}
      </div>
    </div>`;
  }

  pressed = (event) => {
    if (event.key !== "Enter" || !event.target.matches("input")) return this.key(event, "input, li button");
    event.preventDefault(); // the keyboard goes back to the button, which would open the list again
    this.popover.querySelector("li button")?.click();
  };
}

function matches(whole, text) {
  return text.toLowerCase().split(/\s+/).every((word) => whole.toLowerCase().includes(word));
}

function searched(text) {
  const found = [];
  for (const path of allPaths()) {
    if (matches(`${nameOf(path)} ${path}`, text)) found.push(path);
    if (found.length >= MOST) break;
  }
  return found;
}

// The paths of single values, what people plot most first: what the robot publishes, what it outputs, its sensors, all else.
function allPaths() {
  const rows = model.panels.flatMap((panel) => panel.rows);
  const pathsOf = (settable) => new Set(rows.filter((row) => row.settable === settable).flatMap((row) => row.paths));
  const [outputs, sensors] = [pathsOf(false), pathsOf(true)];
  const rank = (path) => {
    if (LAST.test(path)) return 4;
    if (path.startsWith("nt:")) return FROM_OUTSIDE.test(path) ? 3 : 0;
    return outputs.has(path) || path.startsWith("sim.") ? 1 : sensors.has(path) ? 2 : 3;
  };
  const groups = [[], [], [], [], []];
  for (const path of new Set([...model.values.keys(), ...model.shown.values.keys()])) groups[rank(path)].push(...valuesOf(path));
  return groups.flat();
}

// A list's elements, as many as it has now or at the moment that is shown; a list of texts or one that is empty can be
// plotted whole, as a text.
function valuesOf(path) {
  const lists = [model.values, model.shown.values].map((values) => values.get(path)).filter(Array.isArray);
  if (!lists.length) return [path];
  const list = lists.reduce((one, other) => (other.length > one.length ? other : one));
  const elements = elementsOf(path, list).slice(BUTTONS.test(path) ? model.hello.options.buttons.first : 0);
  return list.every((each) => typeof each === "string") ? [path, ...elements] : elements;
}
