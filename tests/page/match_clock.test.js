// The clock of a match: what drivers say, beside the robot's time.
import assert from "node:assert/strict";
import { test } from "node:test";
import "./browser.js";

const { matchTime } = await import("#js/match_clock.js");

const MATCH = {
  t: [0, 83.04, 98, 101, 150, 151, 240, 400],
  v: ["disabled", "autonomous", "disabled autonomous", "teleop", "disabled", "teleop", "disabled", "teleop"],
};

test("a match counts from the enabling of autonomous, through pauses and a lost connection", () => {
  for (const [t, seconds] of [[83.04, 0], [90, 6.96], [99, 15.96], [130.04, 47], [150.5, 67.46], [250, 166.96]]) {
    assert.equal(matchTime(MATCH, t)?.toFixed(2), seconds.toFixed(2), `at ${t}`);
  }
});

test("there is no clock before autonomous, without it, and long after it", () => {
  assert.equal(matchTime(MATCH, 83.02), null);
  assert.equal(matchTime(MATCH, 410), null);
  assert.equal(matchTime({ t: [0, 5], v: ["disabled", "teleop"] }, 10), null);
  assert.equal(matchTime({ t: [], v: [] }, 10), null);
});

test("another autonomous begins another match, and one that is written twice does not", () => {
  const modes = { t: [0, 10, 12, 20, 30], v: ["disabled", "autonomous", "autonomous", "disabled", "autonomous"] };
  assert.deepEqual([15, 31].map((t) => matchTime(modes, t)), [5, 1]);
});
