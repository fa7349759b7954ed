// The layouts that are offered, and those that were saved when there were others.
import assert from "node:assert/strict";
import { test } from "node:test";
import "./browser.js";
import { PRESETS, layoutTitle, offeredLayouts, tabs } from "#js/layout/presets.js";
import { settings } from "#js/settings.js";

const FOUR = ["driving", "tablet", "tuning", "dashboard"];

test("what is driven has four layouts, and what is looked at one more, its own", () => {
  assert.deepEqual(offeredLayouts("simulation", true, {}), FOUR);
  assert.deepEqual(offeredLayouts("simulation", false, {}), ["log", ...FOUR]);
  assert.deepEqual(offeredLayouts("log", false, {}), ["log", ...FOUR]);
});

test("a layout that a person has arranged under a former name is still offered", () => {
  const trees = { review: tabs("field"), tuning: tabs("console"), log: tabs("devices") };
  assert.deepEqual(offeredLayouts("simulation", true, trees), [...FOUR, "review"]);
  assert.equal(layoutTitle("review"), "Review");
});

test("what was saved with a former name is shown as it was; without an arrangement, the first layout is", () => {
  settings.load({ version: 1, layout: "presentation", trees: { presentation: tabs("field") } });
  assert.deepEqual(settings.tree, tabs("field"));
  settings.load({ version: 1, layout: "presentation", trees: {} });
  assert.equal(settings.get("layout"), "driving");
  assert.equal(settings.tree, PRESETS.driving.tree);
});
