// Units of measurement, and how one becomes another of its kind. Nothing here knows the page.

const TURN = 2 * Math.PI;
export const FOOT = 0.3048; // metres

// For each kind, its units: how many of the first one each is, and where its zero lies.
const KINDS = [
  { m: [1], cm: [0.01], mm: [0.001], ft: [FOOT], in: [FOOT / 12] },
  { rad: [1], "°": [TURN / 360], turns: [TURN] },
  { "m/s": [1], "ft/s": [FOOT], "in/s": [FOOT / 12] },
  { "rad/s": [1], "°/s": [TURN / 360], "turns/s": [TURN], rpm: [TURN / 60] },
  { "m/s²": [1], "ft/s²": [FOOT], g: [9.80665] },
  { "°C": [1], "°F": [5 / 9, -32] },
  { V: [1], mV: [0.001] },
  { A: [1], mA: [0.001] },
  { s: [1], ms: [0.001], min: [60] },
];

export const UNITS = KINDS.flatMap((kind) => Object.keys(kind));

// The units that a unit can become, itself included; none for an unknown one.
export function unitsLike(unit) {
  return Object.keys(kindOf(unit) ?? {});
}

// The function that converts numbers from a unit to another one; null if it changes nothing or is impossible.
export function conversion(from, to) {
  const kind = kindOf(from);
  if (from === to || !kind || !Object.hasOwn(kind, to)) return null;
  const [size, zero = 0] = kind[from];
  const [newSize, newZero = 0] = kind[to];
  return (value) => ((value + zero) * size) / newSize - newZero;
}

const PER_SECOND = { "m/s": "m/s²", "ft/s": "ft/s²" };

// The unit of a derivative (1) or an integral (-1) over seconds.
export function unitOverTime(unit, order) {
  if (!unit) return "";
  if (order > 0) return PER_SECOND[unit] ?? `${unit}/s`;
  const squared = Object.keys(PER_SECOND).find((each) => PER_SECOND[each] === unit);
  return squared ?? (unit.endsWith("/s") ? unit.slice(0, -2) : `${unit}·s`);
}

function kindOf(unit) {
  return KINDS.find((kind) => Object.hasOwn(kind, unit));
}
