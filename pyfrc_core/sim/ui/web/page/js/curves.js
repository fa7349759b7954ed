// The curves of plots: which value, what is computed from it, and how it is drawn. A curve is an object in the settings:
// { path, axis, color, key?, hidden?, math?: "derivative" | "integral", minus?: path, from?, to?: units }.
import { numberIn } from "#js/format.js";
import { nameOf, unitOfPath } from "#js/names.js";
import { derivative, difference, integral, mapped } from "#js/plot_math.js";
import { valueAt } from "#js/series.js";
import { color } from "#js/settings.js";
import { conversion, unitOverTime } from "#js/units.js";

export const CURVE_COLORS = 8; // --curve-0 to --curve-7 in theme.css
export const LINES = [[], [10, 4], [2, 3], [12, 4, 2, 4]]; // dashes, in pixels: more curves than colours
const ORDERS = { derivative: 1, integral: -1 };

// What a curve is known by in its plot.
export function keyOf(curve) {
  return curve.key ?? curve.path;
}

// Whether a curve shows more than its value.
export function isComputed({ path, math, minus, from = unitOfPath(path), to }) {
  return Boolean(math || minus || conversion(from, to));
}

export function titleOf({ path, math, minus }) {
  const what = minus ? `${nameOf(path)} − ${nameOf(minus)}` : nameOf(path);
  if (!math) return what;
  return `${math === "derivative" ? "d/dt" : "∫"} ${minus ? `(${what})` : what}`;
}

export function unitOf({ path, math, from = unitOfPath(path), to }) {
  const unit = to && (conversion(from, to) || from === to) ? to : from;
  return math ? unitOverTime(unit, ORDERS[math]) : unit;
}

// All paths that a plot needs: of its curves, and of what is subtracted.
export function pathsOf(curves) {
  return [...new Set(curves.flatMap(({ path, minus }) => (minus ? [path, minus] : [path])))];
}

export function strokeOf({ color: number }) {
  return color(`curve-${number % CURVE_COLORS}`);
}

export function dashOf({ color: number }) {
  return LINES[Math.floor(number / CURVE_COLORS) % LINES.length];
}

// The sample of a curve's line, as a style for its swatch.
export function swatchOf({ color: number }) {
  const one = `var(--curve-${number % CURVE_COLORS})`;
  const dash = LINES[Math.floor(number / CURVE_COLORS) % LINES.length];
  if (!dash.length) return { background: one };
  const stops = [];
  let x = 0;
  dash.slice(0, 2).forEach((pixels, index) => {
    stops.push(`${index % 2 ? "transparent" : one} ${x / 2}px ${(x + pixels) / 2}px`);
    x += pixels;
  });
  return { background: `repeating-linear-gradient(90deg, ${stops.join(", ")})` };
}

// Computes curves, and computes one again only when its values have changed.
export class Computed {
  #known = new Map();

  // `name` tells apart a curve and that of the compared branch; `rawOf` returns the values of a path; `start` is the
  // integral before them.
  of(curve, name, rawOf, until, start = () => 0) {
    const raw = rawOf(curve.path);
    if (!raw || !isComputed(curve)) return raw;
    const other = curve.minus && rawOf(curve.minus);
    const state = [raw, raw.t.length, raw.t[raw.t.length - 1], other, other?.t.length, other?.t[other.t.length - 1], curve, unitOfPath(curve.path)];
    if (curve.math === "integral") state.push(until);
    const before = this.#known.get(name);
    if (before?.state.every((each, index) => each === state[index])) return before.curve;
    const found = { ...computed(curve, raw, other, until, start), kind: "number", until: raw.until };
    this.#known.set(name, { state, curve: found });
    return found;
  }
}

function computed({ path, math, minus, from = unitOfPath(path), to }, raw, other, until, start) {
  let curve = numbers(raw);
  if (minus) curve = difference(curve, numbers(other ?? { t: [], v: [] }));
  const convert = conversion(from, to);
  if (convert) {
    // A difference of temperatures has no zero of its own.
    const zero = minus ? convert(0) : 0;
    curve = mapped(curve, (value) => convert(value) - zero);
  }
  if (math === "derivative") return derivative(curve, raw.exactFrom ?? 0);
  if (math === "integral") return integral(curve, raw.until ?? until, start());
  return curve;
}

function numbers({ t, v }) {
  return { t, v: v.map(numberIn) };
}

// The value of a computed curve at a moment, or of one that is not loaded.
export function curveValue(curve, t) {
  return curve && t <= (curve.until ?? Infinity) + 1e-6 ? valueAt(curve, t) : undefined;
}
