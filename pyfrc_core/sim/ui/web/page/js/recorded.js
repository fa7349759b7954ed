// A run that is part of this file, as `--page` writes it: it answers what the server answers about the past.
// `packing.py` says how its values are stored.
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
  const values = columnsOf(run);
  const answers = {
    values: ({ t }) => ({ t, values: valuesAt(values, t) }),
    plot: ({ paths, from, to }) => ({ series: Object.fromEntries(paths.map((path) => [path, seriesOf(values, path, from, to)])) }),
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
  for (const { times, values } of [hal, network]) {
    const seconds = summed(times).map((microseconds) => microseconds / 1e6);
    for (const [path, packed] of Object.entries(values)) columns.set(path, new Column(seconds, packed));
  }
  return columns;
}

// The changes of one value, unpacked when they are needed: { t, v }, with undefined where the value is gone.
class Column {
  #times;
  #packed;

  constructor(times, packed) {
    this.#times = times;
    this.#packed = packed;
  }

  get t() {
    return this.#unpacked().t;
  }

  get v() {
    return this.#unpacked().v;
  }

  at(t) {
    return this.v[indexAfter(this.t, t + ROUNDING) - 1];
  }

  #unpacked() {
    if (this.#packed.v) return this.#packed;
    const { p, s: shapes, i: chosen, n = [] } = this.#packed;
    const t = summed(p).map((packet) => this.#times[packet]);
    const numbers = n.map(([decimals, ...differences]) => summed(differences).map((number) => number / 10 ** decimals));
    const v = shapes.length === 1 && shapes[0] === 0 ? numbers[0] : filled(t.length, shapes, chosen, numbers);
    this.#packed = { t, v };
    return this.#packed;
  }
}

function summed(differences) {
  let sum = 0;
  return differences.map((difference) => (sum += difference));
}

// Values of these shapes, in which each number is the next one of its column.
function filled(count, shapes, chosen, numbers) {
  const next = numbers.map(() => 0);
  const values = [];
  for (let change = 0; change < count; change++) {
    let column = 0;
    const fill = (shape) => {
      if (typeof shape === "number") return numbers[column][next[column++]++];
      if (Array.isArray(shape)) return shape.map(fill);
      if (shape === null || typeof shape !== "object") return shape;
      return Object.fromEntries(Object.entries(shape).map(([name, part]) => [name, fill(part)]));
    };
    const shape = shapes[chosen ? chosen[change] : 0];
    values.push(shape?.$ === "gone" ? undefined : fill(shape));
  }
  return values;
}

function valuesAt(columns, t) {
  const found = {};
  for (const [path, column] of columns) {
    const value = column.at(t);
    if (value !== undefined) found[path] = value;
  }
  return found;
}

// The steps of a value between two times; the first is the one in force at `from`. `path` may name an element of a list.
function seriesOf(columns, path, from, to) {
  const element = columns.has(path) ? null : /^(.+)\[(\d+)\]$/.exec(path);
  const column = columns.get(element ? element[1] : path);
  if (!column) return { kind: "number", t: [], v: [] };
  const pick = (value) => (element ? (Array.isArray(value) ? value[Number(element[2])] : undefined) : value);
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
