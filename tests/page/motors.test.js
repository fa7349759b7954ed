// Which devices are motors, and which of their rows the table shows.
import assert from "node:assert/strict";
import { test } from "node:test";
import { motorsOf } from "#js/motors.js";

const heading = (label) => ({ kind: "text", label, paths: [] });
const row = (device, name, kind = "number") => ({ kind, label: `   ${name}`, paths: [`CAN["${device}"]["${name}"]`] });
const names = (motor) => ["output", "current", "velocity", "temperature"].map((each) => motor[each]?.paths[0]);

const SPARK = (number, label = "") => [
  heading(`SPARK MAX [${number}]${label && `  ${label}`}`),
  ...["Velocity", "Applied Output", "Motor Temperature", "Motor Current"].map((name) => row(`SPARK MAX [${number}]`, name)),
  heading(`SPARK MAX [${number}] RELATIVE ENCODER`),
  row(`SPARK MAX [${number}] RELATIVE ENCODER`, "Velocity"),
];

test("a SPARK has all four, and the name that the project gives it", () => {
  const [motor] = motorsOf([{ rows: SPARK(3, "front left") }]);
  assert.deepEqual([motor.name, motor.device], ["front left", "SPARK MAX [3]"]);
  assert.deepEqual(names(motor), ["Applied Output", "Motor Current", "Velocity", "Motor Temperature"].map((each) => `CAN["SPARK MAX [3]"]["${each}"]`));
});

test("a Talon FX has its velocity in its rotor sensor, and no temperature", () => {
  const rows = [
    heading("Talon FX [1] Rotor Sensor"),
    row("rotor", "velocity"),
    heading("Talon FX [1]  shooter"),
    ...["supplyVoltage", "dutyCycle", "torqueCurrent", "supplyCurrent"].map((name) => row("talon", name)),
  ];
  const motors = motorsOf([{ rows }]);
  assert.equal(motors.length, 1);
  assert.deepEqual(names(motors[0]), ['CAN["talon"]["dutyCycle"]', 'CAN["talon"]["torqueCurrent"]', 'CAN["rotor"]["velocity"]', undefined]);
});

test("motors are in the order of their numbers; encoders, and rows without a heading, are none", () => {
  const rows = [{ kind: "meter", label: "0", paths: ["pwm[0].value"] }, heading("CANcoder [4]"), row("coder", "velocity"), ...SPARK(10), ...SPARK(2)];
  assert.deepEqual(motorsOf([{ rows }]).map(({ name }) => name), ["SPARK 2", "SPARK 10"]);
  assert.deepEqual(motorsOf([]), []);
});
