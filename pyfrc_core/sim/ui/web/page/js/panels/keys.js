// The keys that drive: the chosen layout, and the person's own bindings.
import { Select } from "#js/controls.js";
import { bindings, keyName, takenBy } from "#js/input/keys.js";
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";
import { Icon, Live, createRef, html } from "#js/view.js";

const STATION_KEYS = [
  ["[ ] \\ together, Ctrl+E", "enable"],
  ["Enter", "disable"],
  ["Space", "emergency stop"],
  ["F5", "pause or run"],
  ["F6", "step by one packet"],
  ["F8", "disconnect or connect the driver station"],
  ["F9", "restart the robot"],
  ["Shift, held", "gentle driving"],
];
const NAMES = { left: "←", right: "→", up: "↑", down: "↓", bracketleft: "[", bracketright: "]", backslash: "\\" };

export class KeysPanel extends Live {
  parts = ["settings", "hello"];
  state = { key: "", kind: "axis", stick: 0, control: 0, by: 1 };
  fields = createRef();

  render(_, state) {
    const { keyboard, buttons: { first, most } } = model.hello.options;
    const { layout, axes, buttons, added } = bindings();
    const own = new Set(added.map((each) => each.key));
    return html`<div class="keys scroll form">
      <label>Keys that drive
        <${Select} value=${layout.name} options=${keyboard.layouts.map(({ name }) => name)} set=${(chosen) => change({ chosen })} /></label>
      <p class="faint">${layout.help}</p>
      <table><thead><tr><th>Key</th><th>Does</th><th></th></tr></thead><tbody>
        ${Object.entries(axes).map(([key, moves]) => html`<tr key=${`axis ${key}`}><td><kbd>${NAMES[key] ?? key.toUpperCase()}</kbd></td>
          <td>${moves.map(([stick, axis, by]) => `joystick ${stick} axis ${axis} ${by > 0 ? "+" : "−"}${Math.abs(by)}`).join(", ")}</td>
          <td>${own.has(key) && html`<${Remove} name=${key} />`}</td></tr>`)}
        ${added.filter((each) => each.kind === "button").map(({ key }) => html`<tr key=${`button ${key}`}><td><kbd>${NAMES[key] ?? key.toUpperCase()}</kbd></td>
          <td>${(buttons[key] ?? []).map(([stick, button]) => `joystick ${stick} button ${button}`).join(", ")}</td>
          <td><${Remove} name=${key} /></td></tr>`)}
      </tbody></table>
      <fieldset ref=${this.fields} disabled=${!model.mayDrive}><legend>Add a key</legend>
        <div class="binding flex">
          <input type="text" readonly value=${state.key ? (NAMES[state.key] ?? state.key.toUpperCase()) : ""} placeholder="Press a key" aria-label="Key" onKeyDown=${this.takeKey} />
          <${Select} aria-label="Kind" value=${state.kind} options=${["axis", "button"]} set=${(kind) => this.setState({ kind, control: kind === "button" ? first : 0 })} />
          <label>joystick <input type="number" required min="0" max="5" value=${state.stick} onInput=${(event) => this.setState({ stick: event.target.value })} /></label>
          <label>number <input type="number" required min=${state.kind === "axis" ? 0 : first} max=${state.kind === "axis" ? 11 : first + most - 1} value=${state.control} onInput=${(event) => this.setState({ control: event.target.value })} /></label>
          ${state.kind === "axis" && html`<label>by <input type="number" required min="-1" max="1" step="any" value=${state.by} onInput=${(event) => this.setState({ by: event.target.value })} /></label>`}
          <button disabled=${!state.key} onClick=${this.add}>Add</button>
        </div></fieldset>
      <h4>The driver station</h4>
      <table><tbody>${STATION_KEYS.map(([key, what]) => html`<tr key=${key}><td><kbd>${key}</kbd></td><td>${what}</td></tr>`)}
        <tr><td><kbd>${keyboard.button_keys_text}</kbd></td><td>buttons ${first} to ${first + 9} of joystick 0</td></tr></tbody></table>
    </div>`;
  }

  takeKey = (event) => {
    if (event.key === "Tab") return;
    event.preventDefault();
    event.stopPropagation();
    const key = keyName(event);
    const taken = takenBy(key);
    const refused = taken && `${event.code || key} ${taken}. Choose another key.`;
    if (refused || model.problem === this.refused) model.set("problem", refused);
    this.refused = refused;
    this.setState({ key: taken ? "" : key });
  };

  add = () => {
    const { key, kind, ...typed } = this.state;
    if (![...this.fields.current.elements].every((box) => box.reportValidity())) return;
    const [stick, control, by] = [typed.stick, typed.control, typed.by].map(Number);
    const others = settings.get("keyboard").own.filter((each) => each.key !== key);
    change({ own: [...others, { key, kind, stick, control, by }] });
    this.setState({ key: "" });
  };
}

function Remove({ name }) {
  const remove = () => change({ own: settings.get("keyboard").own.filter((each) => each.key !== name) });
  return html`<button class="tool" aria-label=${`Remove the key ${name}`} onClick=${remove}><${Icon} name="close" /></button>`;
}

function change(part) {
  settings.set("keyboard", { ...settings.get("keyboard"), ...part });
}
