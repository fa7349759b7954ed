// The clock by which a drive team remembers a match: the time since autonomous was enabled.
import { clock } from "#js/format.js";
import { watch } from "#js/series.js";
import { indexAfter } from "#js/times.js";

const LONGEST = 200; // seconds: no match is longer, with the pauses in it
const ROUNDING = 1e-6; // seconds

// Seconds since the last enabling of autonomous before a moment; null if there is none, or too long before.
export function matchTime(modes, t) {
  let index = indexAfter(modes.t, t + ROUNDING) - 1;
  while (index >= 0 && modes.v[index] !== "autonomous") index -= 1;
  while (index > 0 && modes.v[index - 1] === "autonomous") index -= 1;
  const seconds = index < 0 ? Infinity : t - modes.t[index];
  return seconds <= LONGEST ? Math.max(seconds, 0) : null;
}

let modes = null; // watched as long as the page is open

// A moment on that clock, such as "match 0:47.0"; "" where there is none.
export function matchText(t) {
  modes ??= watch("sim.mode");
  const seconds = matchTime(modes, t);
  return seconds === null ? "" : `match ${clock(seconds).slice(0, -1)}`;
}

// A moment of robot time, and on that clock.
export function momentText(t) {
  return [clock(t), matchText(t)].filter(Boolean).join(", ");
}
