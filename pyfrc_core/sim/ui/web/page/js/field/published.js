// What robot code publishes over NetworkTables for a field: Field2d objects and swerve states.
import { plain } from "#js/format.js";
import { model } from "#js/model.js";
import { tablesOf } from "#js/tables.js";
import { FOOT } from "#js/units.js";

const FEWEST = 7; // poses of a trajectory
const STEP = 2.5; // feet between its poses, at most

// A pose of WPILib, in metres from the field's lower left corner, as x, y in feet and an angle in radians, clockwise.
function fromMetres(x, y, radians, field) {
  return [x / FOOT, field.height - y / FOOT, -radians];
}

// The poses of a topic: numbers in threes as Field2d has them, or structs, which come as their parts.
function posesOf(values, path, field) {
  const pose = poseAt(values, path, field);
  if (pose) return [pose];
  const poses = [];
  for (let next; (next = poseAt(values, `${path}/${poses.length}`, field)); ) poses.push(next);
  const numbers = values.get(path);
  if (!Array.isArray(numbers) || numbers.length % 3) return poses;
  const plainNumbers = numbers.map(plain);
  if (!plainNumbers.every((each) => typeof each === "number")) return poses;
  for (let index = 0; index < numbers.length; index += 3) {
    poses.push(fromMetres(plainNumbers[index], plainNumbers[index + 1], (plainNumbers[index + 2] * Math.PI) / 180, field));
  }
  return poses;
}

// The pose whose parts begin with a path; null if there is none.
function poseAt(values, path, field) {
  const x = plain(values.get(`${path}/translation/x`));
  const y = plain(values.get(`${path}/translation/y`));
  const angle = angleAt(values, `${path}/rotation`);
  return [x, y, angle].every((each) => typeof each === "number") ? fromMetres(x, y, angle, field) : null;
}

// An angle in radians: that of a Rotation2d, or a Rotation3d's yaw.
function angleAt(values, path) {
  const angle = plain(values.get(`${path}/value`));
  if (angle !== undefined) return angle;
  const [w, x, y, z] = ["w", "x", "y", "z"].map((each) => plain(values.get(`${path}/q/${each}`)));
  return typeof w === "number" ? Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) : undefined;
}

function isCorner([x, y, angle], field) {
  return x === 0 && y === field.height && angle === 0;
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

// The folders of every Field2d, each with a slash at its end.
function fieldFolders(values) {
  return tablesOf(values, "Field2d").map((path) => `${path}/`);
}

export function swerveTables() {
  return tablesOf(model.values, "SwerveDrive");
}

const CORNERS = ["Front Left", "Front Right", "Back Left", "Back Right"];

// The states in a table of the type "SwerveDrive", whose angles are in radians; null while some are missing.
function statesIn(values, table) {
  const states = CORNERS.map((corner) => ({ speed: plain(values.get(`${table}/${corner} Velocity`)), angle: plain(values.get(`${table}/${corner} Angle`)) }));
  return states.every(({ speed, angle }) => typeof speed === "number" && typeof angle === "number") ? states : null;
}

const POSES = /^struct:Pose[23]d/;
export const MODULES = /^struct:SwerveModule(State|Velocity)\[\]$/;
export const WANTED = /target|desired|setpoint|wanted/i; // in the name of a topic
const MODULES_AS_NUMBERS = /swerve.*state|module.*state/i;

export function topicsOf(types) {
  return Object.keys(model.types).filter((path) => path.startsWith("nt:") && types.test(model.types[path]));
}

// The beginnings of the paths of all values that a field may show.
export function fieldNeeds() {
  const structs = [...topicsOf(POSES), ...topicsOf(MODULES)].map((path) => `${path}/`);
  return [...fieldFolders(model.values), ...swerveTables().map((path) => `${path}/`), ...structs, ...topicsOf(/^double\[\]$/).filter((path) => MODULES_AS_NUMBERS.test(path))];
}

// The objects of every Field2d: { name, path, poses, isPath }.
export function fieldObjects(values, field) {
  const objects = [];
  const folders = fieldFolders(values);
  const simulated = physicsRobot(values);
  const structs = topicsOf(POSES);
  const lists = [...values.keys()].filter((path) => folders.some((folder) => path.startsWith(folder)) && Array.isArray(values.get(path)));
  for (const path of new Set([...lists, ...structs])) {
    const folder = folders.find((each) => path.startsWith(each));
    const name = folder ? path.slice(folder.length) : path.split("/").pop();
    if (name.startsWith(".")) continue;
    if (path === simulated && model.shown.robot) continue; // the page draws it anyway
    const poses = posesOf(values, path, field);
    // Nothing has moved this one yet: a Field2d begins with its robot in the corner.
    if (folder && name === "Robot" && poses.length === 1 && isCorner(poses[0], field)) continue;
    if (poses.length) objects.push({ name, path, poses, isPath: isTrajectory(poses) });
  }
  const names = objects.map(({ name }) => name);
  return objects.map((object) => (names.filter((name) => name === object.name).length > 1 ? { ...object, name: shortest(object, objects) } : object));
}

// The name of an object with as many of its tables as tell it apart from the others.
function shortest({ path }, objects) {
  const parts = path.replace(/^nt:/, "").split("/");
  const others = objects.filter((other) => other.path !== path);
  for (let count = 2; count < parts.length; count++) {
    const end = parts.slice(-count).join("/");
    if (!others.some((other) => `/${other.path.replace(/^nt:/, "")}`.endsWith(`/${end}`))) return end;
  }
  return parts.join("/");
}

// The four states of swerve modules, front left first: { path, wanted, states: [{ speed in m/s, angle in radians }] }.
export function swerveStates(values) {
  const found = [];
  const add = (path, states) => found.push({ path, wanted: WANTED.test(path), states });
  for (const path of topicsOf(MODULES)) {
    const states = [];
    for (let speed; (speed = speedAt(values, `${path}/${states.length}`)) !== undefined; ) {
      states.push({ speed, angle: angleAt(values, `${path}/${states.length}/angle`) ?? 0 });
    }
    if (states.length >= 3) add(path, states);
  }
  for (const table of swerveTables()) {
    const states = statesIn(values, table);
    if (states) add(table, states);
  }
  for (const path of topicsOf(/^double\[\]$/)) {
    const value = MODULES_AS_NUMBERS.test(path) ? values.get(path) : undefined;
    // AdvantageScope's older form: angle, speed of each module.
    if (value?.length !== 8 || !value.every((each) => typeof each === "number")) continue;
    add(path, [0, 1, 2, 3].map((module) => ({ angle: value[2 * module], speed: value[2 * module + 1] })));
  }
  return found;
}

function speedAt(values, path) {
  return plain(values.get(`${path}/speed`) ?? values.get(`${path}/velocity`));
}
