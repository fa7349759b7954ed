// The motors with a controller on the CAN bus, one in each row, above everything that their devices have.
import { numberText, valueText } from "#js/format.js";
import { addToPlot, carryPath } from "#js/plotting.js";
import { Icon, html } from "#js/view.js";
import { Meter, Painted } from "#js/panels/device_row.js";

const READINGS = ["current", "velocity", "temperature"];

export function MotorTable({ motors }) {
  return html`<table class="motors" aria-label="Motors">
    <thead><tr><th>Motor</th><th class="number output">Output</th><th class="number current">Current <small>A</small></th><th class="number velocity">Velocity</th><th class="number temperature">Temp. <small>°C</small></th><th class="add"></th></tr></thead>
    <tbody>${motors.map((motor) => html`<tr key=${motor.device}>
      <th scope="row" title=${motor.device}>${motor.name}</th>
      <${Cell} row=${motor.output} part=${Meter} />
      ${READINGS.map((name) => html`<${Cell} key=${name} row=${motor[name]} part=${Reading} />`)}
      <td><button class="tool" title="Plot these values" aria-label=${`Plot ${motor.device}`}
        onClick=${() => [motor.output, ...READINGS.map((name) => motor[name])].forEach((row) => addToPlot(row?.paths[0]))}><${Icon} name="plus" /></button></td>
    </tr>`)}</tbody>
  </table>`;
}

function Cell({ row, part: Part }) {
  if (!row) return html`<td class="number faint">–</td>`;
  const [path] = row.paths;
  return html`<td class="number" draggable="true" title=${row.tooltip.split(":")[0]} data-reading=${path} onDragStart=${(event) => carryPath(event, path)}><${Part} row=${row} /></td>`;
}

class Reading extends Painted {
  paint(value) {
    this.element.current.textContent = typeof value === "number" ? numberText(value, Math.abs(value) >= 100 ? 0 : this.props.row.unit ? 1 : 2) : valueText(value);
  }

  render() {
    return html`<span ref=${this.element}></span>`;
  }
}
