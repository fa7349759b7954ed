// What robot code has put on the dashboard: choosers, PID controllers, commands, alerts and single values, as cards.
import { write } from "#js/connection.js";
import { PlotButton, Switch } from "#js/controls.js";
import { plain, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { typedTables } from "#js/tables.js";
import { ValueBox } from "#js/value_box.js";
import { Icon, Live, html } from "#js/view.js";
import { Chooser } from "#js/panels/match.js";

// Shown elsewhere: on the field, or as a drawing.
const ELSEWHERE = new Set(["Field2d", "Mechanism2d", "String Chooser", "Selectable", "Alerts", "FMSInfo", "DriverStation"]);
const ALERTS = [["errors", "red"], ["warnings", "amber"], ["infos", "accent"]];

export class WidgetsPanel extends Live {
  parts = ["values", "paths", "choosers", "shown", "hello"];
  interval = 80;

  render() {
    const { values } = model.shown;
    const folders = sendables(values);
    const cards = folders.filter((each) => !ELSEWHERE.has(each.type));
    const alerts = folders.filter((each) => each.type === "Alerts");
    model.need(this, [...cards, ...alerts].map(({ path }) => `${path}/`));
    return html`<div class="widgets scroll">
      ${alerts.map((each) => html`<${Alerts} key=${each.path} folder=${each} values=${values} />`)}
      ${model.choosers.map((chooser) => html`<div class="card form" key=${chooser.name}><${Chooser} chooser=${chooser} /></div>`)}
      ${cards.map((each) => {
        const Card = each.type === "Command" ? CommandCard : ValuesCard;
        return html`<${Card} key=${each.path} folder=${each} values=${values} />`;
      })}
      ${!cards.length && !alerts.length && !model.choosers.length && html`<p class="empty">Choosers, PID controllers, commands and alerts that the robot publishes with ${model.hello.options.dashboard.publishing} appear here.</p>`}
    </div>`;
  }
}

// Folders with a ".type": { path, name, type }.
export function sendables(values) {
  const found = [];
  for (const [path, type] of typedTables(values)) {
    const isInOne = found.some((each) => path.startsWith(`${each.path}/`));
    if (!isInOne) found.push({ path, name: path.split("/").pop(), type });
  }
  return found;
}

export function Alerts({ folder, values }) {
  const lines = ALERTS.flatMap(([kind, name]) => (plain(values.get(`${folder.path}/${kind}`)) ?? []).map((text) => ({ name, text })));
  return html`<div class="card" tabindex="0"><h4>${folder.name}</h4>${lines.map(({ name, text }, index) => html`<p key=${index} class=${`alert flex ${name}`}><${Icon} name="warning" />${text}</p>`)}
    ${!lines.length && html`<p class="faint">No alerts.</p>`}</div>`;
}

export function CommandCard({ folder, values }) {
  const running = Boolean(values.get(`${folder.path}/running`));
  return html`<div class="card command flex"><h4>${folder.name}</h4>
    <button class=${running ? "stop" : "go"} disabled=${!model.mayWrite} onClick=${() => write({ [`${folder.path}/running`]: !running })}>${running ? "Cancel" : "Run"}</button></div>`;
}

// paths: those of the values to show, in this order; without it, all of the table
export function ValuesCard({ folder, values, paths = null }) {
  const shown = paths ?? [...values.keys()].filter((path) => path.startsWith(`${folder.path}/`) && !path.slice(folder.path.length).includes("/."));
  return html`<div class="card" tabindex="0"><h4>${folder.name}<span class="chip">${folder.type}</span></h4>
    ${shown.map((path) => html`<${ValueRow} key=${path} path=${path} name=${paths ? path.split("/").pop() : path.slice(folder.path.length + 1)} value=${plain(values.get(path))} />`)}</div>`;
}

function ValueRow({ path, name, value }) {
  const number = typeof value === "number";
  const nudge = (by) => write({ [path]: Number((value + by).toPrecision(10)) });
  const step = number && value ? 10 ** Math.floor(Math.log10(Math.abs(value)) - 0.3) / (Math.abs(value) >= 1 ? 10 : 1) : 0.1;
  return html`<div class="row flex"><span class="row-label">${name}</span>
    ${typeof value === "boolean"
      ? html`<${Switch} label=${name} on=${value} disabled=${!model.mayWrite} set=${(on) => write({ [path]: on })} />`
      : number || typeof value === "string"
        ? html`<span class="number-box">${number && html`<button class="tool always" aria-label=${`Less ${name}`} disabled=${!model.mayWrite} onClick=${() => nudge(-step)}>−</button>`}
            <${ValueBox} class=${number ? "number" : ""} path=${path} label=${name} />
            ${number && html`<button class="tool always" aria-label=${`More ${name}`} disabled=${!model.mayWrite} onClick=${() => nudge(step)}>+</button>`}</span>`
        : html`<span class="faint">${valueText(value)}</span>`}
    <span class="row-tools"><${PlotButton} name=${name} paths=${[path]} /></span></div>`;
}
