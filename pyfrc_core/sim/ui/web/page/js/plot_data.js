// The data of plots: curves with times of their own, as the columns that uPlot and CSV files need.
import { numberIn, plain } from "#js/format.js";
import { indexAfter } from "#js/times.js";

const PER_PIXEL = 4; // points of a curve; of more, each pixel keeps its lowest, its highest and its last

// Columns for uPlot: all times, then each curve with its value in force at each of them, until its end.
export function aligned(curves, from, to, width) {
  const pixels = Math.max(width, 50);
  const parts = curves.map((curve) => thinned(part(curve, from, to), (to - from) / pixels, pixels * PER_PIXEL));
  const times = [...new Set(parts.flatMap((each) => each.t))].sort((one, other) => one - other);
  if (!times.length) return [[], ...parts.map(() => [])];
  const columns = parts.map(({ t, v }, curve) => {
    const until = curves[curve].until ?? Infinity;
    const column = new Array(times.length);
    let index = -1;
    for (let row = 0; row < times.length; row++) {
      while (index + 1 < t.length && t[index + 1] <= times[row]) index += 1;
      column[row] = index < 0 || times[row] > until ? null : numberIn(v[index]);
    }
    return column;
  });
  return [times, ...columns];
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

// The lowest, the highest and the last point of each pixel, which is this long. The last one holds until the next pixel with
// a change, which may be far away, or the end.
function thinned({ t, v }, pixel, most) {
  if (t.length <= most) return { t, v };
  const times = [];
  const values = [];
  for (let start = 0, end = 0; start < t.length; start = end) {
    const after = (Math.floor(t[start] / pixel) + 1) * pixel;
    let low = start;
    let high = start;
    for (end = start + 1; end < t.length && t[end] < after; end++) {
      if (v[end] < v[low]) low = end;
      if (v[end] > v[high]) high = end;
    }
    for (const index of new Set([Math.min(low, high), Math.max(low, high), end - 1])) {
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
