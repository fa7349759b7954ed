// Texts of numbers and times.

// A moment of robot time as 1:02.34, precise enough to show each packet.
export function clock(seconds) {
  const hundredths = Math.round(Math.max(seconds, 0) * 100);
  const minutes = Math.floor(hundredths / 6000);
  const rest = (hundredths % 6000) / 100;
  return `${minutes}:${rest.toFixed(2).padStart(5, "0")}`;
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

export function numberText(value, decimals = 2) {
  if (!Number.isFinite(value)) return String(value);
  if (Math.abs(value) >= 1e6) return value.toPrecision(3);
  const text = value.toFixed(decimals);
  return Number(text) === 0 && text.startsWith("-") ? text.slice(1) : text;
}

// The number that a person has typed, with a comma or a point; undefined: it is none.
export function typedNumber(text) {
  const value = Number(text.replace(",", "."));
  return text.trim() && Number.isFinite(value) ? value : undefined;
}

// A number with as many decimals as it has, but not more than `most`.
export function shortNumber(value, most = 4) {
  if (!Number.isFinite(value)) return String(value);
  return Number.isInteger(value) ? String(value) : String(Number(value.toFixed(most)));
}

// Any value in one line.
export function valueText(value, decimals = 3) {
  const simple = plain(value);
  if (simple === undefined || simple === null) return "–";
  if (typeof simple === "number") return Number.isInteger(simple) ? String(simple) : numberText(simple, decimals);
  if (typeof simple === "string") return simple;
  if (typeof simple === "boolean") return String(simple);
  if (Array.isArray(simple)) return `[${simple.map((each) => valueText(each, decimals)).join(", ")}]`;
  if (simple.$ === "bytes") return `${simple.size} bytes`;
  if (simple.$ === "struct") return simple.value === undefined ? simple.type : `${simple.type} ${valueText(simple.value)}`;
  return `{${Object.entries(simple).map(([key, each]) => `${key}: ${valueText(each, decimals)}`).join(", ")}}`;
}

export function speedText(speed) {
  return speed === 0 ? "max" : `${Number(speed.toPrecision(2))}×`;
}
