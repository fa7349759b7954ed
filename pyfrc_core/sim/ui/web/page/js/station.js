// The driver station, along the top: modes, enabling, match, emergency stop; and the page's own menus.
import { command } from "#js/connection.js";
import { countdown } from "#js/format.js";
import { toggle } from "#js/layout/open.js";
import { layoutTitle, offeredLayouts, panelsOf } from "#js/layout/presets.js";
import { robotState } from "#js/link.js";
import { Menu } from "#js/popup.js";
import { model } from "#js/model.js";
import { PANELS, panelTitle } from "#js/panels/all.js";
import { commandLive } from "#js/past.js";
import { isRecorded } from "#js/recorded.js";
import { SourceLabel } from "#js/recorded_bar.js";
import { applyTheme, isDark, settings } from "#js/settings.js";
import { Icon, Live, classes, html } from "#js/view.js";

const ICON = /** @type {HTMLLinkElement} */ (document.querySelector("link[rel=icon]")).href;
const SHORT = { teleop: "Teleop", autonomous: "Auto" };

export class StationBar extends Live {
  parts = ["station", "opmodes", "shown", "hello", "connection", "settings", "clients", "hint", "tuning"];

  render() {
    const { text, kind } = robotState();
    const left = model.past || model.isOver || model.connection !== "open" ? "" : matchLeft(model.station);
    return html`<header class="station flex">
      <div class="brand flex" title=${model.hello.project.root || model.hello.project.name}><img src=${ICON} alt="" /><span>${model.hello.project.name}</span></div>
      ${model.isDriven ? this.driving() : html`<${SourceLabel} />`}
      <div class=${`state flex ${kind}`} role="status" aria-live="polite">
        <i class="lamp"></i><b>${shortText(text)}</b>
        ${model.past && !model.isOver && html`<em>past</em>`}
        ${left && html`<span class="countdown">${left}</span>`}
      </div>
      ${model.hint && this.ready && !model.station.enabled && html`<span class="hint" role="status">${model.hint}</span>`}
      <div class="spacer"></div>
      ${model.hello.source?.kind === "robot" && !model.readonly && html`<${TuneSwitch} />`}
      ${model.readonly && !model.isOver && html`<span class="chip" title="This address only shows the simulation">Read only</span>`}
      ${model.clients > 1 && html`<span class="chip" title="Windows that show this simulation">${model.clients} windows</span>`}
      <${LayoutMenu} />
      <${PanelsMenu} />
      <button class="quiet" onClick=${switchTheme} title=${isDark() ? "Light colours" : "Dark colours"}
        aria-label=${isDark() ? "Light colours" : "Dark colours"}><${Icon} name=${isDark() ? "sun" : "moon"} /></button>
      ${model.isDriven && this.emergencyStop()}
    </header>`;
  }

  get ready() {
    return model.connection === "open" && ["disabled", "enabled"].includes(model.station.kind) && model.mayDrive;
  }

  // The robot's code does not respond: a stop is carried out as soon as it does.
  get stuck() {
    return model.connection === "open" && !model.status.responding && model.mayDrive;
  }

  driving() {
    const present = model.station;
    const connected = model.connection === "open";
    return html`
      <div class="segments" role="radiogroup" aria-label="Mode">
        ${Object.entries(model.hello.options.modes).map(([mode, text]) => html`<button key=${mode} role="radio" aria-checked=${present.chosen_mode === mode}
          class=${classes({ chosen: present.chosen_mode === mode })} disabled=${!model.mayDrive || !connected}
          onClick=${() => command("choose_mode", { mode })}>${SHORT[mode] ?? text}</button>`)}
      </div>
      ${model.opmodes.length > 0 && html`<${OpmodeChooser} disabled=${!model.mayDrive || !connected} />`}
      <div class="pair">
        <button class="go" disabled=${!this.ready || present.enabled} title="Enable the robot: Ctrl+E, or [ ] \\ together"
          onClick=${() => command("enable")}>Enable</button>
        <button class="stop" disabled=${!this.ready || !present.enabled} title="Disable the robot: Enter"
          onClick=${() => commandLive("disable")}>Disable</button>
      </div>
      <button class="practice" disabled=${!this.ready} title="Practice match: autonomous, a pause and teleop"
        onClick=${() => command("practice")}><${Icon} name="flag" /><span>Practice</span></button>`;
  }

  emergencyStop() {
    return html`<button class="estop" disabled=${!this.ready && !this.stuck} title="Emergency stop: the space bar. Only a restart enables the robot again."
        onClick=${() => commandLive("e_stop")}>E-STOP</button>`;
  }
}

// Values are set on a robot on purpose only.
function TuneSwitch() {
  const set = async (event) => {
    const on = event.target.checked;
    if (await command("tune", { on })) model.set("tuning", on);
    model.announce("hello", "tuning");
  };
  return html`<label class=${classes({ tune: true, flex: true, on: model.tuning })} title="While it is on, this page can set values on the robot. It never enables it.">
    <span class="switch"><input type="checkbox" role="switch" checked=${model.tuning} disabled=${model.connection !== "open"} onChange=${set} /><i></i></span>Tune</label>`;
}

// The opmodes of the chosen mode; only robots of 2027 have some.
function OpmodeChooser({ disabled }) {
  const { chosen_mode: mode, opmode } = model.station;
  const offered = model.opmodes.filter((each) => each.mode === mode);
  const option = ({ name, description }) => html`<option key=${name} value=${name} title=${description} selected=${name === opmode}>${name}</option>`;
  const groups = [...new Set(offered.map((each) => each.group))];
  return html`<select class="opmode" aria-label="Opmode" value=${opmode} disabled=${disabled || !offered.length}
    title=${offered.find((each) => each.name === opmode)?.description || "The opmode that runs in this mode. Choosing another one disables the robot."}
    onChange=${(event) => command("choose_opmode", { opmode: event.target.value, mode })}>
    <option value="" selected=${!opmode}>${model.hello.options.no_opmode}</option>
    ${groups.map((group) => {
      const options = offered.filter((each) => each.group === group).map(option);
      return group ? html`<optgroup key=${group} label=${group}>${options}</optgroup>` : options;
    })}
  </select>`;
}

// The server's text without the seconds, which have a place of their own.
function shortText(text) {
  const short = (text ?? "").replace(/, -?\d+ s$/, "");
  return model.isDriven ? short : short.replace("Driver station lost (F8)", "No driver station"); // no key connects it
}

function matchLeft(station) {
  if (station.practice_since === null || station.practice_since === undefined) return "";
  return countdown(station.match_left);
}

function switchTheme() {
  settings.set("theme", isDark() ? "light" : "dark");
  applyTheme();
  model.announce("shown");
}

function LayoutMenu() {
  const chosen = settings.get("layout");
  /** @type {any[]} */
  const items = offeredLayouts(model.hello.source?.kind, model.isDriven, settings.get("trees")).map((name) => ({
    text: layoutTitle(name),
    checked: name === chosen,
    act: () => settings.set("layout", name),
  }));
  items.push({ separator: true }, { text: "Reset this layout", act: () => settings.resetTree() });
  return html`<${Menu} label=${layoutTitle(chosen)} icon="layout" title="Layout" items=${items} />`;
}

function PanelsMenu() {
  const open = new Set(panelsOf(settings.tree));
  const ids = Object.keys(PANELS).filter(isOffered).flatMap((kind) => (kind === "plot" ? plotIds(open) : [kind]));
  const items = ids.map((id) => ({ text: panelTitle(id), checked: open.has(id), act: () => toggle(id) }));
  return html`<${Menu} label="Panels" icon="panels" title="Open and close panels" items=${items} />`;
}

// Devices and joysticks are simulated or logged: a robot elsewhere publishes none.
function isOffered(kind) {
  const { drives, devices, served } = PANELS[kind];
  return !(drives && !model.isDriven) && !(devices && model.hello.source?.kind === "robot") && !(served && isRecorded);
}

function plotIds(open) {
  const numbers = [...open].filter((id) => id.startsWith("plot:")).map((id) => Number(id.slice(5)));
  const most = Math.max(0, ...numbers);
  return Array.from({ length: most + 1 }, (_, index) => `plot:${index + 1}`);
}
