// Every motor and sensor: outputs as bars and lamps, inputs to set. Values are drawn without rendering the rows again.
import { PlotButton, SearchBox } from "#js/controls.js";
import { numberText, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { motorsOf } from "#js/motors.js";
import { DeviceRow, Meter, Painted } from "#js/panels/device_row.js";
import { Finding } from "#js/panels/finding.js";
import { carryPath } from "#js/plotting.js";
import { settings } from "#js/settings.js";
import { Icon, classes, html } from "#js/view.js";

const READINGS = ["current", "velocity", "temperature"]; // of a motor
const MANY = 100; // rows of a group that is closed at first

export class DevicesPanel extends Finding {
  parts = ["panels", "settings", "hello", "found"];
  state = { search: "", closed: {} };
  search = (search) => this.setState({ search });

  render(_, { search, closed }) {
    const words = search.toLowerCase().split(/\s+/).filter(Boolean);
    const pins = new Set(settings.get("pins"));
    const groups = namedGroups(model.panels);
    const pinned = groups.flatMap((group) => group.rows).filter((row) => pins.has(rowKey(row)));
    const found = groups
      .map((group) => ({ ...group, rows: group.rows.filter((row) => matches(row, group.title, words)) }))
      .filter((group) => group.rows.length);
    const motors = motorsOf(model.panels).filter(({ name, device }) => words.every((word) => `motors ${name} ${device}`.toLowerCase().includes(word)));
    const isClosed = (title, rows) => !words.length && (closed[title] ?? rows.length > MANY);
    const toggle = (title, rows) => this.setState({ closed: { ...closed, [title]: !isClosed(title, rows) } });
    return html`<div class="devices content column" ref=${this.element}>
      <${SearchBox} label="Search devices" text=${search} search=${this.search} />
      <div class="scroll fill">
        ${pinned.length > 0 && html`<${Group} title="Pinned" rows=${pinned} pins=${pins} />`}
        ${motors.length > 0 && html`<${Group} key="Motors" title="Motors" rows=${motors} closed=${isClosed("Motors", [])} toggle=${() => toggle("Motors", [])}
          content=${() => html`<${MotorTable} motors=${motors} />`} />`}
        ${found.map((group) => html`<${Group} key=${group.title} title=${group.title} rows=${group.rows} pins=${pins}
          closed=${isClosed(group.title, group.rows)} toggle=${() => toggle(group.title, group.rows)} />`)}
        ${!found.length && html`<p class="empty">${model.panels.length ? "No device is called that." : "Devices appear here when the robot creates them."}</p>`}
      </div>
    </div>`;
  }

  stateToShow(path) {
    const group = model.panels.find(({ rows }) => rows.some((row) => row.paths.includes(path)));
    return { search: "", closed: { ...this.state.closed, [group?.title]: false } };
  }
}

// The groups, where the rows of a device with a heading know its name.
function namedGroups(panels) {
  return panels.map((panel) => {
    let heading = "";
    const rows = panel.rows.map((row) => {
      if (row.kind === "text" && !row.paths.length) heading = row.label;
      else if (!row.label.startsWith(" ")) heading = "";
      return { ...row, heading: row.label.startsWith(" ") ? heading : "", isHeading: row.kind === "text" && !row.paths.length };
    });
    return { title: panel.title, rows };
  });
}

function matches(row, title, words) {
  const text = `${title} ${row.heading} ${row.label} ${row.paths.join(" ")}`.toLowerCase();
  return words.every((word) => text.includes(word));
}

function rowKey(row) {
  return row.paths[0] ?? `heading ${row.label}`;
}

// `content` returns what is shown instead of the rows.
function Group({ title, rows, pins = new Set(), closed, toggle, content = null }) {
  return html`<section class="group">
    <h3><button class=${classes({ fold: true, closed })} aria-expanded=${!closed} onClick=${toggle} disabled=${!toggle}>
      ${toggle && html`<${Icon} name="chevron" />`}${title}${closed && html`<small class="faint">${rows.length} ${content ? "motors" : "rows"}</small>`}</button></h3>
    ${!closed && content?.()}
    ${!closed && !content && byDevice(rows).map((some) => html`<div class="device" key=${rowKey(some[0])}>
      ${some.map((row) => html`<${DeviceRow} key=${rowKey(row)} row=${row} pinned=${pins.has(rowKey(row))}
        named=${title === "Pinned"} pin=${() => togglePin(rowKey(row))} />`)}</div>`)}
  </section>`;
}

// The rows in parts, each of which begins with the heading of a device or has none.
function byDevice(rows) {
  const parts = [];
  for (const row of rows) {
    if (row.isHeading || !parts.length) parts.push([]);
    parts.at(-1).push(row);
  }
  return parts;
}

function togglePin(key) {
  const pins = settings.get("pins");
  settings.set("pins", pins.includes(key) ? pins.filter((each) => each !== key) : [...pins, key]);
}

// The motors with a controller on the CAN bus, one in each row, above everything that their devices have.
function MotorTable({ motors }) {
  return html`<table class="motors" aria-label="Motors">
    <thead><tr><th>Motor</th><th class="number output">Output</th><th class="number current">Current <small>A</small></th><th class="number velocity">Velocity</th><th class="number temperature">Temp. <small>°C</small></th><th class="add"></th></tr></thead>
    <tbody>${motors.map((motor) => html`<tr key=${motor.device}>
      <th scope="row" title=${motor.device}>${motor.name}</th>
      <${Cell} row=${motor.output} part=${Meter} />
      ${READINGS.map((name) => html`<${Cell} key=${name} row=${motor[name]} part=${Reading} />`)}
      <td><${PlotButton} title="Plot these values" name=${motor.device} paths=${[motor.output, ...READINGS.map((name) => motor[name])].map((row) => row?.paths[0])} /></td>
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
}
