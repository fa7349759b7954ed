// The limits of a plot's axes: automatic, or those that the person has typed or locked.
import { TextBox } from "#js/controls.js";
import { Dropdown } from "#js/popup.js";
import { shownNumber, typedNumber } from "#js/format.js";
import { model } from "#js/model.js";
import { html } from "#js/view.js";

const NAMES = { left: "Left", right: "Right" };

// axes: names of the axes that the plot has; ranges(): limits that were set; limits(axis): what the chart shows
// hold: whether the time that is shown stays
export function PlotAxes({ axes, ranges, limits, setRange, hold, setHold }) {
  return html`<${Dropdown} label="Axes" title="Limits of the axes" content=${() => html`<div class="form">
    <div><label class="check"><input type="checkbox" checked=${hold} onChange=${() => setHold(!hold)} /> Keep the time that is shown</label></div>
    ${axes.map((axis) => html`<${Axis} key=${axis} axis=${axis} locked=${axis in ranges()} range=${() => ranges()[axis] ?? limits(axis)} setRange=${setRange} />`)}
  </div>`} />`;
}

// What is typed into one box goes with the other limit of that moment, which may not be drawn yet.
function Axis({ axis, locked, range, setRange }) {
  const [low, high] = range();
  const typed = (make) => (text) => {
    try {
      const [from, to] = make(typedNumber(text));
      if (!(from < to)) throw new Error(`the axis ends at ${shownNumber(to)}, which is not above ${shownNumber(from)}`);
      setRange(axis, [from, to]);
    } catch (error) {
      model.set("problem", `${NAMES[axis]} axis: ${error.message}`);
    }
  };
  return html`<div class="axis-line"><span>${NAMES[axis]}</span>
    <${TextBox} aria-label=${`${NAMES[axis]} axis from`} text=${short(low)} set=${typed((value) => [value, range()[1]])} />
    <${TextBox} aria-label=${`${NAMES[axis]} axis to`} text=${short(high)} set=${typed((value) => [range()[0], value])} />
    <label class="check"><input type="checkbox" aria-label=${`Lock the ${NAMES[axis].toLowerCase()} axis`} checked=${locked} onChange=${() => setRange(axis, locked ? null : range())} /> Lock</label></div>`;
}

function short(value) {
  return shownNumber(Number(value.toPrecision(4)));
}
