// The points of curves that are drawn: of many, those that can be seen.
import "./browser.js";
import assert from "node:assert/strict";
import { test } from "node:test";
import { aligned } from "#js/plot_data.js";

const WIDTH = 100;

// A value that changes each 5 ms for five seconds, ends at neither its lowest nor its highest, and holds.
const count = 1000;
const t = Array.from({ length: count }, (_, index) => index / 200);
const v = t.map((_, index) => (index === count - 1 ? 0.5 : index % 2 ? 1 : -1));

test("a curve of many points goes on to the end with its last value", () => {
  const [times, values] = aligned([{ t, v, until: 20 }], 0, 20, WIDTH);
  assert.ok(times.length < 4 * WIDTH);
  assert.deepEqual([times.at(-1), values.at(-1)], [20, 0.5]);
  assert.deepEqual([Math.min(...values), Math.max(...values)], [-1, 1]);
});

test("what holds for long between many changes is its value, and a short peak in a quiet time is seen", () => {
  const later = { t: [...t, 15, 15.001, 15.002, 18], v: [...v, 3, 9, 3, 4], until: 20 };
  const [times, values] = aligned([later], 0, 20, WIDTH);
  const at = (time) => values[times.findLastIndex((each) => each <= time)];
  assert.deepEqual([at(10), at(14.9), at(16), at(19)], [0.5, 0.5, 3, 4]);
  assert.ok(values.includes(9));
});
