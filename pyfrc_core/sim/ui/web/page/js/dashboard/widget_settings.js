// The settings of a widget: what it shows, and how.
import { Select, Switch, TextBox } from "#js/controls.js";
import { KINDS, firstSettings, kindsFor } from "#js/dashboard/kinds.js";
import { pathOf, topicOf } from "#js/dashboard/topics.js";
import { typedNumber } from "#js/format.js";
import { model } from "#js/model.js";
import { html } from "#js/view.js";

const MOST_OFFERED = 500;
const NUMBERS = { min: "Minimum", max: "Maximum", step: "Step", decimals: "Decimals", seconds: "Seconds" };

export function WidgetSettings({ widget, change }) {
  const path = pathOf(widget.topic ?? "");
  const kinds = [...new Set([widget.kind, ...kindsFor(path)])].filter((kind) => KINDS[kind]);
  const settings = KINDS[widget.kind]?.settings ?? [];
  return html`<div class="form  widget-settings">
    <label>Show as <${Select} value=${widget.kind} options=${kinds.map((kind) => [kind, KINDS[kind].title])} set=${(kind) => change({ ...firstSettings(kind, path), ...widget, kind })} /></label>
    <${TextSetting} label="Title" text=${widget.title} set=${(title) => change({ title })} />
    <${TextSetting} label="Topic" text=${widget.topic} list="topics" set=${(topic) => change({ topic })} />
    ${settings.includes("more") && html`<${TextSetting} label=${widget.kind === "graph" ? "Further curves" : "Further topics"} text=${(widget.more ?? []).join(", ")}
      set=${(text) => change({ more: text.split(",").map((each) => each.trim()).filter(Boolean) })} />`}
    ${settings.includes("unit") && html`<${TextSetting} label="Unit" text=${widget.unit} set=${(unit) => change({ unit: unit.slice(0, 20) })} />`}
    ${Object.keys(NUMBERS).filter((name) => settings.includes(name)).map((name) => html`<${NumberSetting} key=${name} name=${name} value=${widget[name]} change=${change} />`)}
    ${settings.includes("counterclockwise") && html`<label>CCW positive
      <${Switch} label="Angles are positive counterclockwise" on=${Boolean(widget.counterclockwise)} set=${(on) => change({ counterclockwise: on || undefined })} /></label>`}
    <datalist id="topics">${offered().map((topic) => html`<option key=${topic} value=${topic}></option>`)}</datalist>
  </div>`;
}

function TextSetting({ label, text, set, list = undefined }) {
  return html`<label>${label} <${TextBox} text=${text ?? ""} list=${list} set=${(typed) => set(typed.trim())} /></label>`;
}

function NumberSetting({ name, value, change }) {
  const set = (text) => {
    try {
      const number = text.trim() ? typedNumber(text) : undefined;
      change({ [name]: name === "decimals" && number !== undefined ? Math.min(Math.max(Math.round(number), 0), 8) : number });
    } catch (error) {
      model.set("problem", `${NUMBERS[name]}: ${error.message}.`);
    }
  };
  return html`<label>${NUMBERS[name]} <${TextBox} class="number" inputmode="decimal" text=${value ?? ""} set=${set} /></label>`;
}

function offered() {
  return [...model.values.keys()].filter((path) => path.startsWith("nt:") && !path.includes("/.")).slice(0, MOST_OFFERED).map(topicOf);
}
