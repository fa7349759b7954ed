// What robot code publishes for the field and of a swerve drive: objects of a Field2d, structs, or a table of the type "SwerveDrive".
import "./browser.js";
import assert from "node:assert/strict";
import { test } from "node:test";

const { model } = await import("#js/model.js");
const { fieldObjects } = await import("#js/field/published.js");
const { mechanisms } = await import("#js/panels/mechanism.js");
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

test("objects of fields are found, and poses in metres from the lower left become feet from the upper left", () => {
  const plan = "nt:/SmartDashboard/Plan";
  const own = "nt:/SmartDashboard/Field/Robot";
  const poses = (count, dx, dy) => Array.from({ length: count }, (_, n) => [n * dx, n * dy, 0]).flat();
  const solid = Object.entries({ w: Math.cos(0.25), x: 0, y: 0, z: Math.sin(0.25) }).map(([name, value]) => [`nt:/solid/rotation/q/${name}`, value]);
  const values = {
    [`${plan}/.type`]: "Field2d", [`${plan}/Robot`]: [0, 0, 0], [`${plan}/goal`]: [3.048, 1.524, 90], [`${plan}/path`]: poses(12, 0.5, 0.1), [`${plan}/tags`]: poses(8, 5, 1),
    "nt:/flat/translation/x": 0.3048, "nt:/flat/translation/y": 0, "nt:/flat/rotation/value": 1,
    "nt:/solid/translation/x": 0, "nt:/solid/translation/y": 0, "nt:/solid/translation/z": 2, ...Object.fromEntries(solid),
    "nt:/none": { $: "struct", type: "Pose2d", size: 3 },
    "nt:/SmartDashboard/Field/.type": "Field2d", [own]: [1, 2, 0],
  };
  publish(values, { "nt:/flat": "struct:Pose2d", "nt:/solid": "struct:Pose3d", "nt:/none": "struct:Pose2d" }, [1, 2, 0]);
  model.hello.options = { dashboard: { robot: own } };
  const found = () => fieldObjects(model.values, { height: 27 });
  const round = (pose) => pose.map((each) => Number(each.toFixed(6)));
  const shown = Object.fromEntries(found().map(({ name, poses, isPath }) => [name, [poses.length, isPath, round(poses[0])]]));
  assert.deepEqual(shown, {
    goal: [1, false, [10, 22, -1.570796]], path: [12, true, [0, 27, 0]], tags: [8, false, [0, 27, 0]],
    flat: [1, false, [1, 27, -1]], solid: [1, false, [0, 27, -0.5]],
  });
  // The physics' field has another name if robot code shows one of its own as "Field".
  publish({ "nt:/SmartDashboard/Field/.type": "Field2d", [own]: [1, 2, 0], "nt:/SmartDashboard/Field (physics)/.type": "Field2d", "nt:/SmartDashboard/Field (physics)/Robot": [1, 2, 0] }, {}, [1, 2, 0]);
  model.hello.options = { dashboard: { robot: own } };
  assert.deepEqual(found().map(({ path }) => path), [own]);
  publish({ "nt:/Elevator/Drawing/.type": "Mechanism2d", "nt:/Arm/Drawing/.type": "Mechanism2d" });
  assert.deepEqual(mechanisms(model.values).map(({ name }) => name), ["Elevator/Drawing", "Arm/Drawing"]);
});
