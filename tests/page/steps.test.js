// The steps of arranging dashboards.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Steps, same, stepText } from "#js/dashboard/steps.js";

const widget = (topic, given = {}) => ({ kind: "number", topic, x: 0, y: 0, w: 1, h: 1, ...given });
const drive = (...widgets) => ({ name: "Drive", columns: 4, rows: 3, widgets });
const titleOf = ({ topic }) => topic;

test("steps are undone and done again in their order, and a new one forgets what was undone", () => {
  const [empty, one, two] = [drive(), drive(widget("a")), drive(widget("a"), widget("b"))];
  const steps = new Steps().with(empty, one).with(one, two);
  assert.deepEqual(steps.next(true), { before: one, after: two });
  const undone = steps.after(true);
  assert.deepEqual(undone.next(true), { before: empty, after: one });
  assert.deepEqual(undone.next(false), { before: one, after: two });
  assert.deepEqual(undone.after(false), steps);
  assert.equal(undone.with(one, drive()).next(false), undefined);
  assert.equal(new Steps().after(true).next(true), undefined);
});

test("a change that changes nothing is no step", () => {
  const steps = new Steps();
  assert.equal(steps.with(drive(widget("a", { title: "", more: [] })), drive(widget("a"))), steps);
});

test("two dashboards are the same however the file spells them", () => {
  assert.ok(same(drive({ h: 1, w: 1, y: 0, x: 0, topic: "a", kind: "number", unit: "", min: null }), drive(widget("a"))));
  assert.ok(same(null, undefined));
  for (const other of [null, { ...drive(widget("a")), name: "Pit" }, drive(widget("b")), drive(widget("a", { min: 0 }))]) assert.ok(!same(drive(widget("a")), other));
});

test("each step has a name", () => {
  const [a, b] = [widget("a"), widget("b")];
  const steps = [
    [null, drive(), "“Drive” made"],
    [drive(), null, "“Drive” removed"],
    [drive(), { ...drive(), name: "Pit" }, "“Drive” renamed"],
    [drive(), { ...drive(), rows: 9 }, "grid changed"],
    [drive(a), drive(a, b), "b added"],
    [drive(a, b), drive({ ...b }), "a removed"],
    [drive(a, b), drive({ ...a, x: 2 }, { ...b }), "a: moved"],
    [drive(a, b), drive(a, { ...b, x: 2, w: 2 }), "b: size changed"],
    [drive(a), drive({ ...a, min: 1 }), "a: settings changed"],
    [drive(a, b), drive(), "“Drive” replaced"],
  ];
  for (const [before, after, text] of steps) assert.equal(stepText({ before, after }, titleOf), text);
});
