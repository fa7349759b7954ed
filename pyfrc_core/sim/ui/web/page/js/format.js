// Texts of numbers and times.

// A moment of robot time as 1:02.34, precise enough to show each packet.
export function clock(seconds) {
  const hundredths = Math.round(Math.max(seconds, 0) * 100);
  const minutes = Math.floor(hundredths / 6000);
  const rest = (hundredths % 6000) / 100;
  return `${minutes}:${rest.toFixed(2).padStart(5, "0")}`;
}

// Seconds that are left, as 1:02.
export function countdown(seconds) {
  const left = Math.max(Math.ceil(seconds), 0);
  return `${Math.floor(left / 60)}:${String(left % 60).padStart(2, "0")}`;
}

// A moment on an axis: as `clock`, with no more decimals than it needs.
export function clockTick(seconds) {
  return clock(seconds).replace(/\.?0+$/, "");
}

// Numbers that JSON cannot write come as {"$": "NaN"}.
export function plain(value) {
  if (value !== null && typeof value === "object" && "$" in value) {
    const number = { NaN: NaN, Infinity: Infinity, "-Infinity": -Infinity }[value.$];
    if (number !== undefined) return number;
  }
  return value;
}

// A finite number; null for any other value.
export function numberIn(value) {
  const simple = plain(value);
  return typeof simple === "number" && Number.isFinite(simple) ? simple : null;
}

// A measured number with a fixed number of decimals, so that it does not jump.
export function numberText(value, decimals = 2) {
  if (!Number.isFinite(value)) return String(value);
  if (Math.abs(value) >= 1e6) return value.toPrecision(3);
  const text = value.toFixed(decimals);
  return Number(text) === 0 && text.startsWith("-") ? text.slice(1) : text;
}

// Any number with six significant digits, and with all digits before its point.
export function shownNumber(value) {
  if (!Number.isFinite(value) || Number.isInteger(value)) return String(value);
  return String(Number(Math.abs(value) < 1000 ? value.toPrecision(6) : value.toFixed(3)));
}

const THOUSANDS = /^[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?$/;
const NUMBER = /^[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?$/i;

// The number that a person has typed, with a point or a comma before its decimals. `models.wording` has the same rules.
export function typedNumber(text) {
  const typed = text.trim();
  if (THOUSANDS.test(typed)) throw new Error(`write thousands without a comma and decimals with a point, not ${quoted(typed)}`);
  if (!NUMBER.test(typed)) throw new Error(`a number is needed, not ${quoted(typed)}`);
  const value = Number(typed.replace(",", "."));
  if (!Number.isFinite(value)) throw new Error(`${quoted(typed)} is too large`);
  return value;
}

export function quoted(text) {
  return `“${text.length > 40 ? `${text.slice(0, 40)}…` : text}”`;
}

// The decimals that a hundredth of a range has.
export function stepDecimals(range) {
  return range > 0 ? Math.min(Math.max(2 - Math.floor(Math.log10(range)), 0), 8) : 2;
}

// The same angle in degrees, above -180 and up to 180.
export function wrapped(degrees) {
  const turned = degrees % 360;
  return turned > 180 ? turned - 360 : turned <= -180 ? turned + 360 : turned;
}

// The colours that a value is: "#RRGGBB", or a list of these; none for others.
export function colorsIn(value) {
  const found = Array.isArray(value) ? value : [value];
  return found.every((each) => /^#[0-9a-f]{6}$/i.test(each)) ? found : [];
}

// Any value in one line.
export function valueText(value) {
  const simple = plain(value);
  if (simple === undefined || simple === null) return "–";
  if (typeof simple === "number") return shownNumber(simple);
  if (typeof simple === "string") return simple;
  if (typeof simple === "boolean") return String(simple);
  if (Array.isArray(simple)) return `[${simple.map(valueText).join(", ")}]`;
  if (simple.$ === "bytes") return `${simple.size} bytes`;
  if (simple.$ === "struct") return `${simple.type}, ${simple.size} bytes`; // its schema is missing or does not fit
  return `{${Object.entries(simple).map(([key, each]) => `${key}: ${valueText(each)}`).join(", ")}}`;
}

// A change of a value; of a list, its elements that have changed.
export function changeText(before, after) {
  if (!Array.isArray(before) || !Array.isArray(after)) return `${valueText(before)} → ${valueText(after)}`;
  const indices = Array.from({ length: Math.max(before.length, after.length) }, (_, index) => index);
  const changed = indices.filter((index) => valueText(before[index]) !== valueText(after[index]));
  return changed.map((index) => `${index}: ${valueText(before[index])} → ${valueText(after[index])}`).join(", ");
}

export function speedText(speed) {
  return speed === 0 ? "max" : `${Number(speed.toPrecision(2))}×`;
}
