// What can be computed from curves. A curve is { t, v }: times in order, and the value that holds from each of them on.
// A value of null is no number. Nothing here knows the page.
import { indexAfter } from "#js/times.js";

const PACKET = 0.02; // seconds between two values of the robot
const STANDING = 0.11; // seconds without a change after which a value stands still, and has not moved slowly

// The slope between each two changes, per second. It holds from the earlier to the later of them, so its integral is the
// curve again. Before `exactFrom`, changes are missing in between, and a long time without one says nothing.
export function derivative({ t, v }, exactFrom = 0) {
  const found = { t: [], v: [] };
  let slope = null;
  for (let index = 1; index < t.length; index++) {
    const gap = t[index] - t[index - 1];
    if (gap <= 0) continue;
    const stood = gap > STANDING && t[index - 1] >= exactFrom;
    const begin = stood ? t[index] - PACKET : t[index - 1];
    if (stood) add(found, t[index - 1], 0);
    slope = between(v[index - 1], v[index], (one, next) => (next - one) / (t[index] - begin));
    add(found, begin, slope);
  }
  if (!t.length) return found;
  if (slope !== null) add(found, t[t.length - 1], slope); // until a change would have come
  add(found, t[t.length - 1] + (slope === null ? 0 : STANDING), v[v.length - 1] === null ? null : 0);
  return found;
}

// The area under a curve until each moment, beginning with `start`. It has a point at each change, at `until`, and about
// as often as a plot has pixels in between, since it rises while the curve stands still.
export function integral({ t, v }, until, start = 0) {
  const found = { t: [], v: [] };
  const step = Math.max(PACKET, (until - (t[0] ?? 0)) / 4000);
  let sum = start;
  for (let index = 0; index < t.length; index++) {
    const end = t[index + 1] ?? Math.max(until, t[index]);
    const value = v[index] ?? 0;
    const count = value === 0 ? 1 : Math.max(Math.ceil((end - t[index]) / step - 1e-9), 1);
    for (let part = 0; part < count; part++) {
      const passed = ((end - t[index]) * part) / count;
      add(found, t[index] + passed, sum + value * passed);
    }
    sum += value * (end - t[index]);
  }
  if (t.length && until > t[t.length - 1]) add(found, until, sum);
  return found;
}

// One curve minus another one, from the moment on from which both are known.
export function difference(one, other) {
  const found = { t: [], v: [] };
  let left = -1;
  let right = -1;
  while (left + 1 < one.t.length || right + 1 < other.t.length) {
    const time = Math.min(one.t[left + 1] ?? Infinity, other.t[right + 1] ?? Infinity);
    while (one.t[left + 1] <= time) left += 1;
    while (other.t[right + 1] <= time) right += 1;
    if (left >= 0 && right >= 0) add(found, time, between(one.v[left], other.v[right], (a, b) => a - b));
  }
  return found;
}

// A curve with each of its numbers changed.
export function mapped({ t, v }, change) {
  return { t, v: v.map((value) => (value === null ? null : change(value))) };
}

// Minimum, maximum and mean between two moments, weighed by how long each value holds; null without a number.
export function statistics({ t, v }, from, to) {
  const held = [];
  for (let index = Math.max(indexAfter(t, from) - 1, 0); index < t.length && t[index] <= to; index++) {
    const seconds = Math.min(t[index + 1] ?? to, to) - Math.max(t[index], from);
    if (v[index] !== null && Number.isFinite(v[index]) && seconds >= 0) held.push([v[index], seconds]);
  }
  if (!held.length) return null;
  const isMoment = held.every(([, seconds]) => seconds === 0);
  let [min, max, mean, whole] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY, 0, 0];
  for (const [value, seconds] of held) {
    const weight = isMoment ? 1 : seconds;
    whole += weight;
    mean += (value - mean) * (weight / (whole || 1));
    min = Math.min(min, value);
    max = Math.max(max, value);
  }
  return { min, max, mean: Math.min(Math.max(mean, min), max) };
}

function between(one, other, compute) {
  return one === null || other === null ? null : compute(one, other);
}

// Add a point; another one at the same time replaces it, so that times stay in order.
function add({ t, v }, time, value) {
  if (t.length && t[t.length - 1] >= time) {
    v[v.length - 1] = value;
    return;
  }
  t.push(time);
  v.push(value);
}
