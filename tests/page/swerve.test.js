// What is published of a swerve drive: structs, or a table of the type "SwerveDrive".
import "./browser.js";
import assert from "node:assert/strict";
import { test } from "node:test";

const { model } = await import("#js/model.js");
const { swerveDrive, swerveNeeds } = await import("#js/field/swerve.js");

function publish(values, types = {}, robot = null) {
  model.take({ type: "hello", readonly: false, project: { root: "" }, field: {}, values, types, robot });
}

function states(path, speed, angle) {
  return Object.fromEntries([0, 1, 2, 3].flatMap((index) => [[`${path}/${index}/speed`, speed], [`${path}/${index}/angle/value`, angle]]));
}

const TYPE = "struct:SwerveModuleState[]";
const MEASURED = "nt:/Drive/Measured";
const TARGET = "nt:/Drive/Target";

test("measured and wanted states are found by their names, and the heading is the robot's", () => {
  const speeds = { "nt:/Drive/Speeds/vx": 1, "nt:/Drive/Speeds/vy": -2, "nt:/Drive/Speeds/omega": 0.5 };
  publish(
    { ...states(TARGET, 3, 0.1), ...states(MEASURED, 2, 0.2), ...speeds },
    { [TARGET]: TYPE, [MEASURED]: TYPE, "nt:/Drive/Speeds": "struct:ChassisSpeeds" },
    [1, 2, -0.7],
  );
  const drive = swerveDrive(model.shown);
  assert.deepEqual(drive.measured, Array(4).fill({ speed: 2, angle: 0.2 }));
  assert.deepEqual(drive.wanted, Array(4).fill({ speed: 3, angle: 0.1 }));
  assert.deepEqual(drive.speeds, { vx: 1, vy: -2, omega: 0.5 });
  assert.equal(drive.heading, 0.7);
  assert.deepEqual(swerveNeeds(), [`${TARGET}/`, `${MEASURED}/`, "nt:/Drive/Speeds/"]);
});

test("a widget's own topics come first", () => {
  const other = "nt:/Drive/Other";
  publish({ ...states(MEASURED, 2, 0), ...states(other, 5, 0), ...states(TARGET, 3, 0) }, { [MEASURED]: TYPE, [other]: TYPE, [TARGET]: TYPE });
  assert.equal(swerveDrive(model.shown, [other]).measured[0].speed, 5);
  assert.equal(swerveDrive(model.shown, [other]).wanted[0].speed, 3);
  assert.equal(swerveDrive(model.shown, [other, MEASURED]).wanted[0].speed, 2);
});

test("a table has four corners and an angle", () => {
  const table = "nt:/SmartDashboard/Swerve";
  const values = { [`${table}/.type`]: "SwerveDrive", [`${table}/Robot Angle`]: 1.5 };
  publish(values);
  assert.equal(swerveDrive(model.shown).measured, null);
  ["Front Left", "Front Right", "Back Left", "Back Right"].forEach((corner, index) => {
    values[`${table}/${corner} Velocity`] = index;
    values[`${table}/${corner} Angle`] = index / 10;
  });
  publish(values, {}, [0, 0, 9]);
  const drive = swerveDrive(model.shown);
  assert.deepEqual(drive.measured.map(({ speed, angle }) => [speed, angle]), [[0, 0], [1, 0.1], [2, 0.2], [3, 0.3]]);
  assert.equal(drive.heading, 1.5);
  assert.deepEqual([drive.wanted, drive.speeds], [null, null]);
  assert.deepEqual(swerveNeeds(), [`${table}/`]);
});

test("nothing is published", () => {
  publish({});
  assert.deepEqual(swerveDrive(model.shown), { measured: null, wanted: null, speeds: null, heading: null });
});
