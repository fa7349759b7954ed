// Places of widgets on a dashboard's grid.
import assert from "node:assert/strict";
import { test } from "node:test";
import { firstFree, fitted, isFree, movedBy, nearestFree } from "#js/dashboard/grid.js";

const place = (x, y, w = 1, h = 1) => ({ x, y, w, h });
const grid = (...widgets) => ({ columns: 4, rows: 3, widgets });

test("a place is free on the grid where no other widget is", () => {
  const full = grid(place(0, 0, 2, 2));
  assert.ok(isFree(full, place(2, 0, 2, 3)));
  assert.ok(isFree(full, place(0, 2)));
  assert.ok(isFree(full, place(1, 1), 0), "its own place counts as free");
  for (const other of [place(1, 1), place(3, 0, 2), place(0, 3), place(-1, 0), place(2, 0, 0)]) assert.ok(!isFree(full, other));
});

test("a new widget gets the first free place, in a smaller size if it must", () => {
  assert.deepEqual(firstFree(grid(place(0, 0, 2, 1)), { w: 2, h: 1 }), place(2, 0, 2, 1));
  assert.deepEqual(firstFree(grid(), { w: 9, h: 9 }), place(0, 0, 4, 3));
  assert.deepEqual(firstFree(grid(place(0, 0, 4, 2), place(0, 2)), { w: 3, h: 2 }), place(1, 2, 2, 1));
  assert.equal(firstFree(grid(place(0, 0, 4, 3)), { w: 1, h: 1 }), null);
});

test("a dropped widget comes as near to the pointer as there is space", () => {
  assert.deepEqual(nearestFree(grid(), { w: 2, h: 1 }, { x: 3, y: 2 }), place(2, 2, 2, 1));
  assert.deepEqual(nearestFree(grid(place(1, 1)), { w: 1, h: 1 }, { x: 1, y: 1 }).y, 0);
  assert.deepEqual(nearestFree(grid(place(0, 0, 4, 2)), { w: 2, h: 2 }, { x: 0, y: 0 }), place(0, 2, 1, 1));
});

test("the arrow keys move a widget over others", () => {
  const two = grid(place(0, 0), place(1, 0));
  assert.deepEqual(movedBy(two, 0, [1, 0]), place(2, 0));
  assert.deepEqual(movedBy(two, 1, [0, 1]), place(1, 1));
  assert.equal(movedBy(two, 1, [-1, 0]), null);
});

test("a smaller grid has all widgets", () => {
  const small = fitted({ columns: 2, rows: 1, widgets: [{ kind: "number", ...place(3, 2, 3, 1) }] });
  assert.deepEqual(small.widgets, [{ kind: "number", ...place(0, 0, 2, 1) }]);
});
