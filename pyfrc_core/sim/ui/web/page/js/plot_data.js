// The data of plots: curves with times of their own, as the columns that uPlot and CSV files need.
import { plain } from "#js/format.js";
import { indexAfter } from "#js/times.js";

const PER_PIXEL = 4; // points of a curve; with more, only the lowest and highest of each interval are drawn

// Columns for uPlot: all times, then each curve with its value in force at each of them, until its end.
export function aligned(curves, from, to, width) {
  const parts = curves.map((curve) => thinned(part(curve, from, to), Math.max(width, 50) * PER_PIXEL));
  const times = [...new Set(parts.flatMap((each) => each.t))].sort((one, other) => one - other);
  if (!times.length) return [[], ...parts.map(() => [])];
  const columns = parts.map(({ t, v }, curve) => {
    const until = curves[curve].until ?? Infinity;
    const column = new Array(times.length);
    let index = -1;
    for (let row = 0; row < times.length; row++) {
      while (index + 1 < t.length && t[index + 1] <= times[row]) index += 1;
      column[row] = index < 0 || times[row] > until ? null : number(v[index]);
    }
    return column;
  });
  return [times, ...columns];
}

function number(value) {
  const simple = plain(value);
  return typeof simple === "number" && Number.isFinite(simple) ? simple : null;
}

// The points between two times, with the value in force at both.
function part({ t, v, until = Infinity }, from, whole) {
  const to = Math.min(whole, until);
  const first = Math.max(indexAfter(t, from) - 1, 0);
  const end = indexAfter(t, to);
  if (!t.length || t[first] > to) return { t: [], v: [] };
  const times = t.slice(first, end);
  const values = v.slice(first, end);
  times[0] = Math.max(times[0], from);
  if (times.length && times[times.length - 1] < to) {
    times.push(to);
    values.push(values[values.length - 1]);
  }
  return { t: times, v: values };
}

function thinned({ t, v }, most) {
  if (t.length <= most) return { t, v };
  const size = Math.ceil((2 * t.length) / most);
  const times = [];
  const values = [];
  for (let start = 0; start < t.length; start += size) {
    let low = start;
    let high = start;
    for (let index = start; index < Math.min(start + size, t.length); index++) {
      if (v[index] < v[low]) low = index;
      if (v[index] > v[high]) high = index;
    }
    for (const index of low === high ? [low] : [Math.min(low, high), Math.max(low, high)]) {
      times.push(t[index]);
      values.push(v[index]);
    }
  }
  return { t: times, v: values };
}

// A CSV file: the time in seconds, then each value in force.
export function csvOf(paths, series) {
  const times = [...new Set(paths.flatMap((path) => series[path]?.t ?? []))].sort((one, other) => one - other);
  const at = paths.map(() => -1);
  const lines = [["t", ...paths].map(cell).join(",")];
  for (const t of times) {
    const cells = paths.map((path, column) => {
      const { t: own = [], v = [] } = series[path] ?? {};
      while (at[column] + 1 < own.length && own[at[column] + 1] <= t) at[column] += 1;
      return at[column] < 0 ? "" : cell(v[at[column]]);
    });
    lines.push([Number(t.toFixed(6)), ...cells].join(","));
  }
  return `${lines.join("\r\n")}\r\n`;
}

function cell(value) {
  const simple = plain(value);
  const text = typeof simple === "object" && simple !== null ? JSON.stringify(simple) : String(simple ?? "");
  // A text that begins like a formula would be one in a spreadsheet.
  const safe = typeof simple === "string" && /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

export function download(name, text, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
