// Places on the field as they are written, against WPILib's axes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { COORDINATES, originOf, written } from "#js/field/coordinates.js";

const FIELD = { width: 50, height: 26 };
const rounded = ({ x, y, degrees, unit }) => [Number(x.toFixed(6)), Number(y.toFixed(6)), Number(degrees.toFixed(6)) + 0, unit];
const quarter = Math.PI / 2;

test("a pose is written in each kind of coordinates", () => {
  const pose = [10, 6, quarter]; // it faces downwards on the screen: to the right of the blue drivers
  for (const [name, alliance, expected] of [
    ["pyfrc", "red 1", [10, 6, 90, "ft"]],
    ["blue", "red 1", [3.048, 6.096, -90, "m"]],
    ["blue-feet", "blue 1", [10, 20, -90, "ft"]],
    ["alliance", "blue 3", [3.048, 6.096, -90, "m"]],
    ["alliance", "red 1", [12.192, 1.8288, 90, "m"]],
    ["alliance-feet", "red 1", [40, 6, 90, "ft"]],
    ["alliance-feet", "", [10, 20, -90, "ft"]],
  ]) assert.deepEqual(rounded(written(pose, FIELD, name, alliance)), expected, `${name}, ${alliance}`);
});

test("the origin is where both are 0, and the field's other corner where both are largest", () => {
  for (const name of Object.keys(COORDINATES)) {
    for (const alliance of ["red 2", "blue 2"]) {
      const [x, y] = originOf(FIELD, name, alliance);
      assert.deepEqual(rounded(written([x, y, 0], FIELD, name, alliance)).slice(0, 2), [0, 0]);
      const far = written([FIELD.width - x, FIELD.height - y, 0], FIELD, name, alliance);
      const feet = far.unit === "m" ? 0.3048 : 1;
      assert.deepEqual([far.x, far.y].map((each) => Math.round(each / feet)), [50, 26]);
    }
  }
});

test("an alliance sees the field alike: half a turn between the two", () => {
  for (let angle = -7; angle < 7; angle += 0.7) {
    const blue = written([4, 3, angle], FIELD, "alliance", "blue 1");
    const red = written([FIELD.width - 4, FIELD.height - 3, angle + Math.PI], FIELD, "alliance", "red 1");
    for (const key of ["x", "y"]) assert.ok(Math.abs(blue[key] - red[key]) < 1e-9);
    assert.ok(Math.abs(Math.sin(((blue.degrees - red.degrees) * Math.PI) / 360)) < 1e-9);
    assert.ok(blue.degrees >= -180 && blue.degrees < 180);
  }
});
