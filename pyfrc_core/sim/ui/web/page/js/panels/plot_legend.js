// The curves of a plot: their names, values and settings, as a list or as a table with what is in view.
import { keyOf, swatchOf, unitOf } from "#js/curves.js";
import { shownNumber, valueText } from "#js/format.js";
import { Icon, classes, html } from "#js/view.js";
import { CurveName, CurveSettings } from "#js/panels/curve_settings.js";

const COLUMNS = ["Minimum", "Mean", "Maximum"];

// bare: names and values alone, as in a widget
// plot: { curves, x, change(curve, changes), remove(curve), … } as `CurveSettings` needs it
// isNumber(curve), shownOf(curve), statisticsOf(curve): of the run, and of the branch for a curve with `other: true`
export function PlotLegend({ plot, bare, isTable, hasBranch, isNumber, shownOf, statisticsOf }) {
  const curves = plot.curves;
  if (bare) {
    return html`<ul class="legend" aria-label="Curves">
      ${curves.map((curve) => html`<li key=${keyOf(curve)}><i class="swatch" style=${swatchOf(curve)}></i><${CurveName} curve=${curve} />
        <${Value} curve=${curve} value=${shownOf(curve)} /></li>`)}
    </ul>`;
  }
  if (!isTable) {
    return html`<ul class="legend" aria-label="Curves">
      ${curves.map((curve) => html`<li key=${keyOf(curve)} class=${classes({ off: curve.hidden })}>
        <${Name} curve=${curve} plot=${plot} isNumber=${isNumber} />
        <${Value} curve=${curve} value=${shownOf(curve)} />
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
  const isX = plot.x === keyOf(curve);
  const other = curve.axis === "left" ? "right" : "left";
  return html`${isX && html`<span class="axis-choice" title="The other curves are drawn over this one">X</span>`}
    ${!isX && isNumber(curve) && html`<button class="axis-choice" title="The axis of this curve: left or right" aria-label=${`Axis of ${keyOf(curve)}`}
      onClick=${() => plot.change(curve, { axis: other })}>${curve.axis === "left" ? "L" : "R"}</button>`}
    <button class="tool" aria-label=${`Remove ${keyOf(curve)}`} title="Remove" onClick=${() => plot.remove(curve)}><${Icon} name="close" /></button>`;
}
