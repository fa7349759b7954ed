// A run that is part of this file, as `--page` writes it: it replies as the server does about the past.
// `value_history.py` says how its values are stored.
import { elementIn } from "#js/parts.js";
import { indexAfter } from "#js/times.js";

const ROUNDING = 1e-6; // seconds
const data = document.getElementById("run");

// Whether this page shows a run of the past, which cannot be driven.
export const isRecorded = data !== null;

// Read the run, and return { hello, answer(type, fields) }.
export async function readRun() {
  const packed = Uint8Array.from(atob(data.textContent), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const run = await new Response(stream).json();
  const present = { columns: columnsOf(run), offset: 0 };
  const branches = new Map(run.branches.map((branch) => [branch.id, { ...branch, columns: columnsOf(branch) }]));
  const chosen = (branch) => branches.get(branch) ?? present;
  const answers = {
    values: ({ t, branch }) => ({ t, values: valuesAt(chosen(branch).columns, t - chosen(branch).offset) }),
    plot: ({ paths, from, to, branch }) => ({ series: Object.fromEntries(paths.map((path) => [path, curveOf(chosen(branch), path, from, to)])) }),
    first_difference: ({ branch }) => chosen(branch).difference,
    changes: ({ t, reach }) => ({ changes: changesAround(present.columns, t, reach) }),
    subscribe: () => ({}), // nothing comes any more
  };
  return {
    hello: run.hello,
    async answer(type, fields) {
      if (!answers[type]) throw new Error("This is a recorded run: it cannot be driven.");
      return answers[type](fields);
    },
  };
}

function columnsOf({ hal, network }) {
  const columns = new Map();
  for (const { times, values } of [hal, network])
    for (const [path, { p, v }] of Object.entries(values)) columns.set(path, columnOf(times, p, v));
  return columns;
}

// The changes of one value: { t, v, at(t) }, with undefined where the value is gone.
function columnOf(times, packets, changes) {
  const t = packets.map((packet) => times[packet]);
  const v = changes.map((value) => (value?.$ === "gone" ? undefined : value));
  return { t, v, at: (when) => v[indexAfter(t, when + ROUNDING) - 1] };
}

function valuesAt(columns, t) {
  const found = {};
  for (const [path, column] of columns) {
    const value = column.at(t);
    if (value !== undefined) found[path] = value;
  }
  return found;
}

const MOST_CHANGES = 100;
export const MOST_EACH = 8; // of a value that changes more often around a moment, only the first change is there

// As `Runs.changes_around` has it.
function changesAround(columns, t, reach) {
  const found = [];
  for (const [path, column] of columns) {
    let before = column.at(t - reach);
    const changes = [];
    const end = indexAfter(column.t, t + reach + ROUNDING);
    for (let index = indexAfter(column.t, t - reach + ROUNDING); index < end; index++) {
      if (JSON.stringify(column.v[index]) === JSON.stringify(before)) continue;
      changes.push({ path, t: column.t[index], before: before ?? null, after: column.v[index] ?? null, count: column.t.length });
      before = column.v[index];
    }
    const named = changes.length <= MOST_EACH ? changes : changes.slice(0, 1);
    found.push(...named.map((change) => ({ ...change, near: changes.length })));
  }
  return found.sort((one, other) => one.count - other.count || one.path.localeCompare(other.path) || one.t - other.t).slice(0, MOST_CHANGES);
}

function curveOf({ columns, offset }, path, from, to) {
  const curve = seriesOf(columns, path, from - offset, to - offset);
  return offset ? { ...curve, t: curve.t.map((t) => t + offset) } : curve;
}

// The steps of a value between two times; the first is the one in force at `from`. `path` may name an element of a list.
function seriesOf(columns, path, from, to) {
  const [list, index] = columns.has(path) ? [path, null] : elementIn(path);
  const column = columns.get(list);
  if (!column) return { kind: "number", t: [], v: [] };
  const pick = (value) => (index === null ? value : Array.isArray(value) ? value[index] : undefined);
  const first = Math.max(indexAfter(column.t, from + ROUNDING) - 1, 0);
  const end = indexAfter(column.t, to + ROUNDING);
  const t = column.t.slice(first, end);
  if (t.length) t[0] = Math.max(t[0], from);
  const v = column.v.slice(first, end).map((value) => pick(value) ?? null);
  return { kind: kindOf(v), t, v };
}

function kindOf(values) {
  const kinds = new Set(values.filter((value) => value !== null).map((value) => typeof value));
  if (kinds.size > 1) return "other";
  return { number: "number", boolean: "boolean", string: "text" }[[...kinds][0] ?? "number"] ?? "other";
}
