// The motors among the devices: controllers that report an output, with what belongs to them. Nothing here knows the page.

// The rows of the columns, by their labels: the first one that a device has.
const OUTPUT = ["Applied Output", "dutyCycle"];
const CURRENT = ["Motor Current", "torqueCurrent", "supplyCurrent"];
const VELOCITY = ["Velocity", "velocity"];
const TEMPERATURE = ["Motor Temperature"];
const ROTOR = " Rotor Sensor"; // of a Talon FX: a device of its own

// The motors of the panels: { name, device, output, current, velocity, temperature }: rows, or undefined.
export function motorsOf(panels) {
  const devices = panels.flatMap(({ rows }) => devicesIn(rows));
  const byName = new Map(devices.map((each) => [each.device, each]));
  const motors = [];
  for (const { device, label, rows } of devices) {
    const output = rowNamed(rows, OUTPUT);
    if (!output) continue;
    const rotor = byName.get(`${device}${ROTOR}`)?.rows ?? [];
    motors.push({
      name: label || device.replace(/^(\w+)\b.*\[(.+)\]/, "$1 $2"), // SPARK 3
      device,
      output,
      current: rowNamed(rows, CURRENT),
      velocity: rowNamed(rows, VELOCITY) ?? rowNamed(rotor, VELOCITY),
      temperature: rowNamed(rows, TEMPERATURE),
    });
  }
  return motors.sort((one, other) => one.device.localeCompare(other.device, "en", { numeric: true }));
}

// Rows below the heading of a device, which has two spaces between it and the label that the project gives it.
function devicesIn(rows) {
  const devices = [];
  for (const row of rows) {
    if (row.kind === "text" && !row.paths.length) {
      const [device, label = ""] = row.label.split("  ");
      devices.push({ device, label, rows: [] });
    } else if (row.label.startsWith(" ")) devices.at(-1)?.rows.push(row);
  }
  return devices;
}

function rowNamed(rows, names) {
  for (const name of names) {
    const found = rows.find((row) => row.label.trim() === name);
    if (found) return found;
  }
}
