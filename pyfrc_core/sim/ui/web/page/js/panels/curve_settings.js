// The settings of one curve: what is shown of its value, in which unit, and how it is drawn.
import { CURVE_COLORS, LINES, keyOf, swatchOf, titleOf } from "#js/curves.js";
import { Dropdown } from "#js/dropdown.js";
import { nameOf, unitOfPath } from "#js/names.js";
import { UNITS, unitsLike } from "#js/units.js";
import { classes, html } from "#js/view.js";

const MATH = [["", "Its value"], ["derivative", "Derivative, per second"], ["integral", "Integral over time"]];
const LINE_NAMES = ["solid", "dashed", "dotted", "dash-dotted"];

// plot: { curves, x, isNumber(curve), change(curve, changes, or a function that returns them), copy(curve), setX(key or null) }
export function CurveSettings({ curve, plot }) {
  return html`<${Dropdown} className="curve-button" title=${`Settings of ${titleOf(curve)}`} name=${`Settings of ${keyOf(curve)}`}
    label=${html`<${CurveName} curve=${curve} />`} content=${(close) => html`<${Settings} curve=${curve} plot=${plot} close=${close} />`} />`;
}

export function CurveName({ curve }) {
  return html`<span class="curve-name long-name" title=${curve.path}><bdi>${titleOf(curve)}</bdi></span>`;
}

function Settings({ curve, plot, close }) {
  const change = (changes) => plot.change(curve, changes);
  const chosen = (name) => (event) => change({ [name]: event.target.value || undefined });
  const { path, color, math = "", minus = "", from = unitOfPath(path), to = from } = curve;
  const others = [...new Set(plot.curves.filter(plot.isNumber).map((each) => each.path))].filter((each) => each !== path || each === minus);
  const line = Math.floor(color / CURVE_COLORS) % LINES.length;
  const isX = plot.x === keyOf(curve);
  return html`<div class="curve-settings">
    <label><span>Show</span><select aria-label="Show" value=${math} onChange=${chosen("math")}>${MATH.map(([value, text]) => html`<option key=${value} value=${value}>${text}</option>`)}</select></label>
    <label><span>Minus</span><select aria-label="Minus" value=${minus} onChange=${chosen("minus")}><option value="">nothing</option>${others.map((each) => html`<option key=${each} value=${each}>${nameOf(each)}</option>`)}</select></label>
    <label><span>Measured in</span><select aria-label="Measured in" value=${from} onChange=${(event) => change({ from: event.target.value, to: undefined })}><option value="">no unit</option>${optionsOf(UNITS, from)}</select></label>
    <label><span>Shown in</span><select aria-label="Shown in" value=${to} disabled=${!unitsLike(from).length} onChange=${chosen("to")}>${optionsOf(unitsLike(from), to)}</select></label>
    <div class="choices" role="group" aria-label="Colour">${Array.from({ length: CURVE_COLORS }, (_, number) => html`<button key=${number} aria-label=${`Colour ${number + 1}`}
      class=${classes({ chosen: color % CURVE_COLORS === number })} onClick=${() => change((now) => ({ color: now.color - (now.color % CURVE_COLORS) + number }))}><i class="swatch" style=${swatchOf({ color: number })}></i></button>`)}</div>
    <div class="choices" role="group" aria-label="Line">${LINE_NAMES.map((name, number) => html`<button key=${name} aria-label=${`Line: ${name}`} title=${name}
      class=${classes({ chosen: line === number })} onClick=${() => change((now) => ({ color: number * CURVE_COLORS + (now.color % CURVE_COLORS) }))}><i class="swatch wide" style=${swatchOf({ color: number * CURVE_COLORS + (color % CURVE_COLORS) })}></i></button>`)}</div>
    <button onClick=${() => { close(); plot.setX(isX ? null : keyOf(curve)); }}>${isX ? "Show all curves over time" : "Show the others over this curve (XY)"}</button>
    <button onClick=${() => { close(); plot.copy(curve); }}>Add this value once more</button>
  </div>`;
}

function optionsOf(units, chosen) {
  const all = units.includes(chosen) || !chosen ? units : [chosen, ...units];
  return all.map((each) => html`<option key=${each} value=${each}>${each}</option>`);
}
