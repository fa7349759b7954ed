// The model: what the page knows of the simulation, and when it says that something has changed.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame } from "./browser.js";

const { model } = await import("#js/model.js");

beforeEach(() => {
  model.show(null);
  model.take({ type: "hello", readonly: false, t: 0, values: { a: 1, b: 2 }, marks: [], known_from: 0 });
  drawFrame();
});

test("changes are announced once in a frame, and values only to those who draw them", () => {
  const drawn = [];
  const heard = [];
  const ends = [model.bind("a", (value) => drawn.push(value)), model.listen((changed) => heard.push([...changed].sort()))];
  model.take({ type: "update", t: 0.02, values: { a: 3 } });
  model.take({ type: "update", t: 0.04, values: { b: 5 } });
  assert.deepEqual([drawn, heard], [[1], []]);
  assert.equal(drawFrame(), 1);
  assert.deepEqual(drawn, [1, 3]);
  assert.deepEqual(heard, [["needs", "t", "type", "values"]]);
  ends.forEach((end) => end());
  model.take({ type: "update", values: { a: 4 } });
  drawFrame();
  assert.deepEqual(drawn, [1, 3]);
});

test("a value that is gone is drawn as undefined", () => {
  const drawn = [];
  const end = model.bind("a", (value) => drawn.push(value));
  model.take({ type: "update", gone: ["a"] });
  drawFrame();
  end();
  assert.deepEqual(drawn, [1, undefined]);
  assert.ok(!model.values.has("a"));
});

test("panels show the past while the present goes on, and the present again afterwards", () => {
  const drawn = [];
  const end = model.bind("a", (value) => drawn.push(value));
  model.show({ t: 0, values: new Map([["a", "then"]]) });
  drawFrame();
  model.take({ type: "update", t: 1, values: { a: "now" } });
  drawFrame();
  model.show(null);
  drawFrame();
  end();
  assert.deepEqual(drawn, [1, "then", "now"]);
});

test("a run that goes on from before the moment that is shown shows the present, without its marks", () => {
  model.take({ type: "update", marks: [{ n: 1, t: 4, kind: "own", text: "x" }] });
  const shown = (t) => ({ t, values: new Map() });
  model.show(shown(2));
  model.take({ type: "update", run: { number: 2, t: 3 } });
  assert.deepEqual([model.past?.t, model.marks], [2, []]);
  model.take({ type: "update", run: { number: 3, t: 1 } });
  assert.equal(model.past, null);
});

test("a flood of lines leaves the warnings, and a flood of marks the person's own", () => {
  const line = (n, level) => ({ n, level, text: "" });
  model.take({ type: "update", console: [line(0, "warning")] });
  model.take({ type: "update", console: Array.from({ length: 5000 }, (_, n) => line(n + 1, "info")) });
  assert.equal(model.console.length, 2001);
  assert.deepEqual([model.console[0].level, model.console.at(-1).n], ["warning", 5000]);
  const mark = (n, kind) => ({ n, t: n, kind, text: "" });
  model.take({ type: "update", marks: [mark(0, "own"), ...Array.from({ length: 3000 }, (_, n) => mark(n + 1, "press"))] });
  assert.deepEqual([model.marks.length, model.marks[0].kind, model.marks[1].n], [2000, "own", 1002]);
});

test("what is bound and what panels need is asked for, until it is no longer", () => {
  const end = model.bind("a", () => {});
  const again = model.bind("a", () => {});
  const panel = {};
  model.need(panel, ["nt:/Arm/"]);
  assert.deepEqual(model.needs, { paths: ["a"], beginnings: ["nt:/Arm/"] });
  end();
  model.need(panel, []);
  assert.deepEqual(model.needs, { paths: ["a"], beginnings: [] });
  again();
  assert.deepEqual(model.needs.paths, []);
});
