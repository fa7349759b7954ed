// Every motor and sensor: outputs as bars and lamps, inputs to set. Values are drawn without rendering the rows again.
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";
import { Icon, Live, classes, html } from "#js/view.js";
import { motorsOf } from "#js/motors.js";
import { DeviceRow } from "#js/panels/device_row.js";
import { MotorTable } from "#js/panels/motor_table.js";

const MANY = 100; // rows of a group that is closed at first

export class DevicesPanel extends Live {
  parts = ["panels", "settings", "hello"];
  state = { search: "", closed: {} };

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
    return html`<div class="devices">
      <label class="search"><${Icon} name="search" /><input type="search" placeholder="Search devices" value=${search}
        aria-label="Search devices" onInput=${(event) => this.setState({ search: event.target.value })} /></label>
      <div class="scroll">
        ${pinned.length > 0 && html`<${Group} title="Pinned" rows=${pinned} pins=${pins} />`}
        ${motors.length > 0 && html`<${Group} key="Motors" title="Motors" rows=${motors} closed=${isClosed("Motors", [])} toggle=${() => toggle("Motors", [])}
          content=${() => html`<${MotorTable} motors=${motors} />`} />`}
        ${found.map((group) => html`<${Group} key=${group.title} title=${group.title} rows=${group.rows} pins=${pins}
          closed=${isClosed(group.title, group.rows)} toggle=${() => toggle(group.title, group.rows)} />`)}
        ${!found.length && html`<p class="empty">${model.panels.length ? "No device is called that." : "Devices appear here when the robot creates them."}</p>`}
      </div>
    </div>`;
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
