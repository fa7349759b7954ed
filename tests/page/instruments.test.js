// Widgets that are instruments: their arithmetic, and what is shown as one of them.
import "./browser.js";
import assert from "node:assert/strict";
import { test } from "node:test";
import { firstSettings, kindsFor } from "#js/dashboard/kinds.js";
import { colorsIn, stepDecimals, wrapped } from "#js/format.js";
import { model } from "#js/model.js";

test("a hundredth of a range has these decimals", () => {
  assert.deepEqual([0.02, 1, 2, 10, 100, 6000, 0, -1, Infinity, NaN].map(stepDecimals), [4, 2, 2, 1, 0, 0, 2, 2, 0, 2]);
});

test("an angle stays what it is without whole turns", () => {
  assert.deepEqual([0, 45, 180, 181, 405, -179, -180, -181, -720.5].map(wrapped), [0, 45, 180, -179, 45, -179, 180, 179, -0.5]);
});

test("colours have six digits after #", () => {
  assert.deepEqual([colorsIn("#00aaFF"), colorsIn(["#000000", "#FFFFFF"])], [["#00aaFF"], ["#000000", "#FFFFFF"]]);
  for (const other of ["#FFF", "red", "#00000000", "url(#000000)", 7, null, undefined, [], ["#000000", "red"]]) assert.deepEqual(colorsIn(other), []);
});

test("what is published decides which instrument shows it", () => {
  model.take({
    type: "hello", source: {}, options: { dashboard: { tables: [] } }, types: {},
    values: { "nt:/T/Gyro/.type": "Gyro", "nt:/T/PDH/.type": "PowerDistribution", "nt:/T/color": "#FF8000", "nt:/T/colors": ["#000000"], "nt:/T/kP": -3 },
  });
  const found = ["Gyro", "PDH", "color", "colors", "kP"].map((name) => kindsFor(`nt:/T/${name}`)[0]);
  assert.deepEqual(found, ["gyro", "power", "color", "color", "number"]);
  assert.ok(kindsFor("nt:/T/kP").includes("slider"));
  assert.deepEqual(firstSettings("slider", "nt:/T/kP"), { min: -10, max: 10 });
});
