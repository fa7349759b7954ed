// What robot code publishes over NetworkTables for a field: Field2d objects and swerve states.
import { plain } from "#js/format.js";
import { model } from "#js/model.js";

const FOOT = 0.3048; // metres
const FEWEST = 7; // poses of a trajectory
const STEP = 2.5; // feet between its poses, at most

// A pose of WPILib, in metres from the field's lower left corner, as x, y in feet and an angle in radians, clockwise.
function fromMetres(x, y, radians, field) {
  return [x / FOOT, field.height - y / FOOT, -radians];
}

// The poses of a value: numbers in threes as Field2d has them, or Pose2d structs.
function posesOf(value, field) {
  const list = Array.isArray(value) ? value : value === undefined || value === null ? [] : [value];
  if (list.length && list.every((each) => each?.$ === "struct" && each.type === "Pose2d" && each.value)) {
    return list.map(({ value: pose }) => fromMetres(pose.translation.x, pose.translation.y, angleOf(pose.rotation), field));
  }
  const numbers = list.map(plain);
  if (numbers.length % 3 || !numbers.every((each) => typeof each === "number")) return [];
  const poses = [];
  for (let index = 0; index < numbers.length; index += 3) {
    poses.push(fromMetres(numbers[index], numbers[index + 1], (numbers[index + 2] * Math.PI) / 180, field));
  }
  return poses;
}

function isCorner([x, y, angle], field) {
  return x === 0 && y === field.height && angle === 0;
}

function angleOf(rotation) {
  return rotation?.value ?? rotation?.radians ?? 0;
}

// Whether poses follow each other, as on a trajectory, or are places here and there, such as vision targets.
function isTrajectory(poses) {
  if (poses.length < FEWEST) return false;
  const steps = poses.slice(1).map(([x, y], index) => Math.hypot(x - poses[index][0], y - poses[index][1]));
  return steps.every((step) => step <= STEP);
}

// The pose of the robot that the physics publishes. Its field has the other name if robot code shows a "Field" of its own.
function physicsRobot(values) {
  const { robot } = model.hello.options.dashboard;
  const other = robot.replace("/Field/", "/Field (physics)/");
  return values.has(other) ? other : robot;
}

// The objects of every Field2d: { name, path, poses, isPath }.
export function fieldObjects(values, field) {
  const objects = [];
  const folders = [];
  const simulated = physicsRobot(values);
  for (const [path, type] of values) {
    if (!path.startsWith("nt:/") || !path.endsWith("/.type") || type !== "Field2d") continue;
    const folder = path.slice(0, -"/.type".length);
    folders.push(`${folder}/`);
    for (const [each, value] of values) {
      if (!each.startsWith(`${folder}/`)) continue;
      const name = each.slice(folder.length + 1);
      if (name.startsWith(".")) continue;
      if (each === simulated && model.shown.robot) continue; // the page draws it anyway
      // Nothing has moved this one yet: a Field2d begins with its robot in the corner.
      const poses = posesOf(value, field);
      if (name === "Robot" && poses.length === 1 && isCorner(poses[0], field)) continue;
      if (poses.length) objects.push({ name, path: each, poses, isPath: isTrajectory(poses) });
    }
  }
  for (const [path, value] of values) {
    // Poses that robot code publishes as structs, beside any Field2d.
    if (!path.startsWith("nt:/") || !/^(struct:)?Pose2d/.test(model.types[path] ?? "")) continue;
    if (folders.some((folder) => path.startsWith(folder))) continue;
    const poses = posesOf(value, field);
    if (poses.length) objects.push({ name: path.split("/").pop(), path, poses, isPath: isTrajectory(poses) });
  }
  return objects;
}

// The four states of swerve modules, front left first: { path, wanted, states: [{ speed in m/s, angle in radians }] }.
export function swerveStates(values) {
  const found = [];
  for (const [path, value] of values) {
    if (!path.startsWith("nt:/") || !Array.isArray(value) || value.length < 3) continue;
    const wanted = /target|desired|setpoint|wanted/i.test(path);
    if (value.every((each) => each?.$ === "struct" && each.type === "SwerveModuleState" && each.value)) {
      found.push({ path, wanted, states: value.map(({ value: state }) => ({ speed: state.speed, angle: angleOf(state.angle) })) });
    } else if (/swerve.*state|module.*state/i.test(path) && value.length === 8 && value.every((each) => typeof each === "number")) {
      // AdvantageScope's older form: angle, speed of each module.
      const states = [0, 1, 2, 3].map((module) => ({ angle: value[2 * module], speed: value[2 * module + 1] }));
      found.push({ path, wanted, states });
    }
  }
  return found;
}
