// Topics of NetworkTables whose names begin with a slash, as most do, and without one.
import "./browser.js";
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathOf, topicOf } from "#js/dashboard/topics.js";
import { treeOf } from "#js/panels/networktables.js";

test("a topic of a dashboard is a path and itself again", () => {
  for (const path of ["nt:/SmartDashboard/kP", "nt:kP", "nt:Arm/kP", "pwm[0].value"]) assert.equal(pathOf(topicOf(path)), path);
});

test("tables with and without a slash are two", () => {
  const shown = ({ name, path, leaf, children }) => [name, path, leaf, [...children.values()].map(shown)];
  const tree = treeOf(["nt:/Arm/kP", "nt:Arm/kP", "nt:kP"]);
  assert.deepEqual([...tree.children.values()].map(shown), [
    ["Arm", "nt:/Arm", false, [["kP", "nt:/Arm/kP", true, []]]],
    ["Arm", "nt:Arm", false, [["kP", "nt:Arm/kP", true, []]]],
    ["kP", "nt:kP", true, []],
  ]);
});
