// What plots compute from curves. A random walk with a fixed seed stands for any value of a robot.
import assert from "node:assert/strict";
import { test } from "node:test";
import { derivative, difference, integral, mapped, statistics } from "#js/plot_math.js";
import { UNITS, conversion, unitOverTime, unitsLike } from "#js/units.js";

const PACKET = 0.02;
const round = (value) => (value === null ? null : Number(value.toFixed(9)));
const rounded = ({ t, v }) => t.map((time, index) => [round(time), round(v[index])]);

// Numbers from 0 to 1 that are the same in each run: a linear congruential generator.
function random(seed) {
  let state = seed;
  return () => (state = (state * 1664525 + 1013904223) % 2 ** 32) / 2 ** 32;
}

// A walk whose values change after one packet or several, and sometimes stand for seconds.
function walk(seed, count = 200) {
  const next = random(seed);
  const t = [0];
  const v = [next()];
  for (let packet = 0; t.length < count; ) {
    packet += next() < 0.05 ? 100 : 1 + Math.floor(next() * 3);
    t.push(packet * PACKET);
    v.push(v[v.length - 1] + next() - 0.5);
  }
  return { t, v };
}

function at({ t, v }, time) {
  const index = t.findLastIndex((each) => each <= time + 1e-9);
  return index < 0 ? undefined : v[index];
}

const close = (one, other, within = 1e-6) => assert.ok(Math.abs(one - other) <= within, `${one} and ${other}`);
const each = (check) => [1, 2, 3, 4, 5].forEach((seed) => check(walk(seed)));

test("a ramp has its slope, and a value that stands has none until the packet in which it moves", () => {
  const { t, v } = derivative({ t: [0, 0.02, 0.04, 2, 2.02], v: [0, 1, 2, 2.5, 2.5] });
  assert.deepEqual(rounded({ t, v }), [[0, 50], [0.02, 50], [0.04, 0], [1.98, 25], [2, 0], [2.02, 0], [2.13, 0]]);
});

test("where changes are missing, a long time without one is a slope", () => {
  assert.deepEqual(rounded(derivative({ t: [0, 2], v: [0, 4] }, 2)), [[0, 2], [2, 2], [2.11, 0]]);
});

test("a number after no number has no slope", () => {
  assert.deepEqual(derivative({ t: [0, 0.02, 0.04], v: [null, 1, 2] }).v.slice(0, 2), [null, 50]);
  assert.deepEqual(derivative({ t: [], v: [] }), { t: [], v: [] });
  assert.deepEqual(derivative({ t: [3], v: [1] }), { t: [3], v: [0] });
});

test("the integral of a derivative is the curve again", () => {
  each((curve) => {
    const again = integral(derivative(curve), curve.t.at(-1), curve.v[0]);
    curve.t.forEach((time, index) => close(at(again, time), curve.v[index]));
  });
});

test("an integral rises evenly while its value stands, until the present", () => {
  const { t, v } = integral({ t: [1, 3], v: [2, 0] }, 4);
  assert.deepEqual([t[0], v[0], t.at(-1), v.at(-1)], [1, 0, 4, 4]);
  close(at({ t, v }, 2), 2, 0.05);
  assert.ok(t.length < 5000);
  assert.deepEqual(integral({ t: [], v: [] }, 5), { t: [], v: [] });
});

test("integrals and derivatives follow scale and sum", () => {
  each((curve) => {
    const [double, end] = [mapped(curve, (value) => 2 * value), curve.t.at(-1)];
    derivative(curve).v.forEach((value, index) => close(2 * value, derivative(double).v[index], 1e-9));
    close(2 * integral(curve, end).v.at(-1), integral(double, end).v.at(-1));
  });
});

test("a difference is that of the values in force, at every moment", () => {
  each((curve) => {
    const other = walk(99);
    const found = difference(curve, other);
    for (let time = 0; time < 3; time += 0.013) close(at(found, time), at(curve, time) - at(other, time));
    assert.ok(difference(curve, curve).v.every((value) => value === 0));
    assert.deepEqual(found.t, [...new Set([...curve.t, ...other.t])].sort((a, b) => a - b));
  });
  assert.deepEqual(difference({ t: [0, 2], v: [5, 6] }, { t: [1], v: [1] }), { t: [1, 2], v: [4, 5] });
});

test("statistics weigh a value by how long it holds", () => {
  const found = statistics({ t: [0, 9], v: [1, 5] }, 0, 10);
  assert.deepEqual([found.min, found.max, found.mean], [1, 5, 1.4]);
  assert.deepEqual(statistics({ t: [0, 9], v: [1, 5] }, 9.5, 9.5).mean, 5);
  assert.equal(statistics({ t: [0], v: [null] }, 0, 1), null);
  assert.equal(statistics({ t: [5], v: [1] }, 0, 1), null);
});

test("statistics are those of the same curve sampled in each packet", () => {
  each((curve) => {
    const [from, to] = [0.5, 2.5];
    const samples = [];
    for (let packet = 25; packet < 125; packet++) samples.push(at(curve, packet * PACKET));
    const found = statistics(curve, from, to);
    close(found.mean, samples.reduce((sum, value) => sum + value, 0) / samples.length);
    close(found.min, Math.min(...samples));
    close(found.max, Math.max(...samples));
  });
});

test("a unit becomes another one and itself again", () => {
  for (const from of UNITS) {
    assert.equal(conversion(from, from), null);
    for (const to of unitsLike(from)) {
      if (to === from) continue;
      for (const value of [-40, 0, 1, 12.5]) close(conversion(to, from)(conversion(from, to)(value)), value);
    }
  }
});

test("known conversions", () => {
  for (const [value, from, to, expected] of [
    [1, "m", "ft", 3.28084], [12, "in", "ft", 1], [180, "°", "rad", Math.PI], [60, "rpm", "turns/s", 1],
    [100, "°C", "°F", 212], [-40, "°F", "°C", -40], [1, "g", "m/s²", 9.80665],
  ]) close(conversion(from, to)(value), expected, 1e-5);
  assert.equal(conversion("m", "rad"), null);
  assert.equal(conversion("furlong", "m"), null);
  assert.deepEqual(unitsLike("constructor"), []);
});

test("units over time", () => {
  const cases = [["m", 1, "m/s"], ["m/s", 1, "m/s²"], ["m/s²", -1, "m/s"], ["turns/s", -1, "turns"], ["A", -1, "A·s"], ["", 1, ""]];
  for (const [unit, order, expected] of cases) assert.equal(unitOverTime(unit, order), expected);
});
