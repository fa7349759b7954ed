// The curves of a plot: their names, values and settings, as a list or as a table with what is in view.
import { Select } from "#js/controls.js";
import { CURVE_COLORS, LINES, keyOf, swatchOf, titleOf, unitOf } from "#js/curves.js";
import { shownNumber, valueText } from "#js/format.js";
import { nameOf, unitOfPath } from "#js/names.js";
import { Dropdown } from "#js/popup.js";
import { UNITS, unitsLike } from "#js/units.js";
import { Icon, classes, html } from "#js/view.js";

const COLUMNS = ["Minimum", "Mean", "Maximum"];
const MATH = [["", "Its value"], ["derivative", "Derivative, per second"], ["integral", "Integral over time"]];
const LINE_NAMES = ["solid", "dashed", "dotted", "dash-dotted"];

// bare: names and values alone, as in a widget
// plot: { curves, change(curve, changes), remove(curve), … } as `CurveSettings` needs it
// isNumber(curve), shownOf(curve), statisticsOf(curve): of the run, and of the branch for a curve with `other: true`
export function PlotLegend({ plot, bare, isTable, hasBranch, isNumber, shownOf, statisticsOf }) {
  const curves = plot.curves;
  if (bare) {
    return html`<ul class="legend" aria-label="Curves" tabindex="0">
      ${curves.map((curve) => html`<li key=${keyOf(curve)}><i class="swatch" style=${swatchOf(curve)}></i><${CurveName} curve=${curve} />
        <${Value} curve=${curve} value=${shownOf(curve)} /></li>`)}
    </ul>`;
  }
  if (!isTable) {
    return html`<ul class="legend" aria-label="Curves">
      ${curves.map((curve) => html`<li key=${keyOf(curve)} class=${classes({ off: curve.hidden })}>
        <${Name} curve=${curve} plot=${plot} isNumber=${isNumber} />
        <${Value} curve=${curve} value=${shownOf(curve)} />
        ${hasBranch && html`<span class="faint in-branch" title="In the branch"><${Value} curve=${curve} value=${shownOf({ ...curve, other: true })} /></span>`}
        <${Tools} curve=${curve} plot=${plot} isNumber=${isNumber} />
      </li>`)}
    </ul>`;
  }
  const rows = curves.flatMap((curve) => (hasBranch ? [curve, { ...curve, other: true }] : [curve]));
  return html`<div class="legend curve-table"><table aria-label="Curves">
    <thead><tr><th>Curve</th><th class="number">Value</th>${COLUMNS.map((each) => html`<th key=${each} class="number">${each}</th>`)}<th></th></tr></thead>
    <tbody>${rows.map((curve) => {
      const found = isNumber(curve) ? statisticsOf(curve) : null;
      const numbers = found && [found.min, found.mean, found.max];
      return html`<tr key=${`${keyOf(curve)}${curve.other ? " in the branch" : ""}`} class=${classes({ off: curve.hidden })}>
        <td>${curve.other ? html`<span class="faint">in the branch</span>` : html`<${Name} curve=${curve} plot=${plot} isNumber=${isNumber} />`}</td>
        <td class="number"><${Value} curve=${curve} value=${shownOf(curve)} /></td>
        ${COLUMNS.map((each, index) => html`<td key=${each} class="number">${numbers ? shownNumber(Number(numbers[index].toPrecision(4))) : ""}</td>`)}
        <td>${!curve.other && html`<${Tools} curve=${curve} plot=${plot} isNumber=${isNumber} />`}</td>
      </tr>`;
    })}</tbody>
  </table></div>`;
}

function Name({ curve, plot, isNumber }) {
  const hide = `${curve.hidden ? "Show" : "Hide"} ${keyOf(curve)}`;
  return html`<span class="curve">
    <button class="swatch-button" aria-label=${hide} title=${hide} aria-pressed=${Boolean(curve.hidden)} onClick=${() => plot.change(curve, { hidden: !curve.hidden })}>
      <i class="swatch" style=${swatchOf(curve)}></i></button>
    ${isNumber(curve) ? html`<${CurveSettings} curve=${curve} plot=${plot} />` : html`<${CurveName} curve=${curve} />`}
  </span>`;
}

function Value({ curve, value }) {
  const unit = unitOf(curve);
  return html`<b class="number">${valueText(typeof value === "number" && curve.math ? Number(value.toPrecision(5)) : value)}</b>${unit && html`<small class="unit">${unit}</small>`}`;
}

function Tools({ curve, plot, isNumber }) {
  const other = curve.axis === "left" ? "right" : "left";
  return html`${isNumber(curve) && html`<button class="axis-choice" title=${`Put this curve on the ${other} axis`} aria-label=${`${curve.axis} axis, of ${keyOf(curve)}`}
      onClick=${() => plot.change(curve, { axis: other })}>${curve.axis} axis</button>`}
    <button class="tool" aria-label=${`Remove ${keyOf(curve)}`} title="Remove" onClick=${() => plot.remove(curve)}><${Icon} name="close" /></button>`;
}

// What is shown of a value, in which unit, and how it is drawn.
// plot: { curves, isNumber(curve), change(curve, changes, or a function that returns them), copy(curve) }
function CurveSettings({ curve, plot }) {
  return html`<${Dropdown} className="curve-button" title=${`Settings of ${titleOf(curve)}`} name=${`Settings of ${keyOf(curve)}, ${titleOf(curve)}`}
    label=${html`<${CurveName} curve=${curve} />`} content=${(close) => html`<${Settings} curve=${curve} plot=${plot} close=${close} />`} />`;
}

function CurveName({ curve }) {
  return html`<span class="curve-name long-name" title=${curve.path}><bdi>${titleOf(curve)}</bdi></span>`;
}

function Settings({ curve, plot, close }) {
  const change = (changes) => plot.change(curve, changes);
  const chosen = (name) => (value) => change({ [name]: value || undefined });
  const { path, color, math = "", minus = "", from = unitOfPath(path), to = from } = curve;
  const others = [...new Set(plot.curves.filter(plot.isNumber).map((each) => each.path))].filter((each) => each !== path || each === minus);
  const line = Math.floor(color / CURVE_COLORS) % LINES.length;
  return html`<div class="form">
    <label><span>Show</span><${Select} aria-label="Show" value=${math} options=${MATH} set=${chosen("math")} /></label>
    <label><span>Minus</span><${Select} aria-label="Minus" value=${minus} options=${[["", "nothing"], ...others.map((each) => [each, nameOf(each)])]} set=${chosen("minus")} /></label>
    <label><span>Measured in</span><${Select} aria-label="Measured in" value=${from} options=${[["", "no unit"], ...withChosen(UNITS, from)]} set=${(unit) => change({ from: unit, to: undefined })} /></label>
    <label><span>Shown in</span><${Select} aria-label="Shown in" value=${to} options=${withChosen(unitsLike(from), to)} disabled=${!unitsLike(from).length} set=${chosen("to")} /></label>
    <div class="choices" role="group" aria-label="Colour">${Array.from({ length: CURVE_COLORS }, (_, number) => html`<button key=${number} aria-label=${`Colour ${number + 1}`}
      class=${classes({ chosen: color % CURVE_COLORS === number })} onClick=${() => change((now) => ({ color: now.color - (now.color % CURVE_COLORS) + number }))}><i class="swatch" style=${swatchOf({ color: number })}></i></button>`)}</div>
    <div class="choices" role="group" aria-label="Line">${LINE_NAMES.map((name, number) => html`<button key=${name} aria-label=${`Line: ${name}`} title=${name}
      class=${classes({ chosen: line === number })} onClick=${() => change((now) => ({ color: number * CURVE_COLORS + (now.color % CURVE_COLORS) }))}><i class="swatch wide" style=${swatchOf({ color: number * CURVE_COLORS + (color % CURVE_COLORS) })}></i></button>`)}</div>
    <button onClick=${() => { close(); plot.copy(curve); }}>Add this value once more</button>
  </div>`;
}

function withChosen(units, chosen) {
  return units.includes(chosen) || !chosen ? units : [chosen, ...units];
}
