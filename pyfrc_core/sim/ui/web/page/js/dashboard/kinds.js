// What a widget may be: its title, its first size in cells, the settings that it has, and what draws it. What is
// published decides which kinds are suggested.
import {
  AlertsWidget, CameraWidget, ChooserWidget, CommandWidget, FieldWidget, GraphWidget, MatchTime, MechanismWidget, PidWidget,
  RobotState, SwerveWidget, ValuesWidget,
} from "#js/dashboard/panel_widgets.js";
import { ColorWidget, GyroWidget, PowerWidget, SliderWidget } from "#js/dashboard/instruments.js";
import { Gauge, InputBox, Lamp, NumberText, SwitchWidget, Text } from "#js/dashboard/value_widgets.js";
import { typeOf } from "#js/dashboard/topics.js";
import { colorsIn, plain } from "#js/format.js";
import { model } from "#js/model.js";
import { CAMERAS, cameraNames } from "#js/panels/cameras.js";
import { valueIn } from "#js/parts.js";

/** @type {Record<string, { title: string, size: [number, number], component: any, settings?: string[], alone?: boolean }>} */
export const KINDS = {
  number: { title: "Number", size: [2, 1], component: NumberText, settings: ["unit", "decimals"] },
  text: { title: "Text", size: [3, 1], component: Text },
  input: { title: "Box to type into", size: [3, 1], component: InputBox },
  lamp: { title: "Lamp", size: [1, 1], component: Lamp },
  switch: { title: "Switch", size: [2, 1], component: SwitchWidget },
  gauge: { title: "Gauge", size: [2, 2], component: Gauge, settings: ["min", "max", "unit", "decimals"] },
  slider: { title: "Slider", size: [3, 1], component: SliderWidget, settings: ["min", "max", "step", "unit", "decimals"] },
  gyro: { title: "Gyro", size: [2, 2], component: GyroWidget, settings: ["counterclockwise"] },
  power: { title: "Power distribution", size: [4, 4], component: PowerWidget },
  color: { title: "Colour", size: [1, 1], component: ColorWidget },
  graph: { title: "Graph", size: [4, 3], component: GraphWidget, settings: ["more", "seconds", "min", "max"] },
  chooser: { title: "Chooser", size: [3, 1], component: ChooserWidget },
  pid: { title: "PID controller", size: [3, 3], component: PidWidget },
  values: { title: "Table of values", size: [3, 3], component: ValuesWidget, settings: ["more"] },
  field: { title: "Field", size: [6, 4], component: FieldWidget, alone: true },
  mechanism: { title: "Mechanism", size: [3, 3], component: MechanismWidget, alone: true },
  swerve: { title: "Swerve drive", size: [3, 4], component: SwerveWidget, settings: ["more", "max"], alone: true },
  time: { title: "Match time", size: [2, 1], component: MatchTime, alone: true },
  state: { title: "Robot's mode", size: [3, 1], component: RobotState, alone: true },
  alerts: { title: "Alerts", size: [3, 2], component: AlertsWidget },
  command: { title: "Command", size: [2, 1], component: CommandWidget },
  camera: { title: "Camera", size: [4, 3], component: CameraWidget },
};

const CAMERA = /^nt:\/CameraPublisher\/[^/]+$/; // the table of one camera
const BY_TYPE = {
  "String Chooser": ["chooser"],
  Selectable: ["chooser"],
  PIDController: ["pid"],
  ProfiledPIDController: ["pid"],
  Field2d: ["field"],
  Mechanism2d: ["mechanism"],
  SwerveDrive: ["swerve", "values"],
  Gyro: ["gyro", "values"],
  PowerDistribution: ["power", "values"],
  Alerts: ["alerts"],
  Command: ["command"],
};
/** @type {[RegExp, string[]][]} */
const BY_STRUCT = [
  [/^struct:SwerveModule(State|Velocity)\[\]/, ["swerve", "values"]],
  [/^struct:Chassis(Speeds|Velocities)/, ["swerve", "values"]],
  [/^struct:Pose[23]d/, ["field", "values"]],
];

// The tables of cameras, and the structs that widgets show, such as an array of module states: { path, name, type }.
export function otherTables() {
  const cameras = cameraNames().map((name) => ({ path: `${CAMERAS}${name}`, name, type: "Camera" }));
  const paths = Object.keys(model.types).filter((path) => path.startsWith("nt:") && BY_STRUCT.some(([pattern]) => pattern.test(model.types[path])));
  return [...cameras, ...paths.map((path) => ({ path, name: path.split("/").pop(), type: model.types[path].replace("struct:", "") }))];
}

// The kinds that suit what is published at a path, the best first; all while that is not known.
export function kindsFor(path) {
  const value = plain(valueIn(model.shown.values, path));
  const type = typeOf(path);
  if (typeof value === "boolean") return ["lamp", "switch", "graph", "text"];
  if (typeof value === "number") return /match ?_?time/i.test(path) ? ["time", "number", "gauge"] : ["number", "gauge", "graph", "slider", "input", "gyro", "time"];
  if (colorsIn(value).length) return ["color", "text", "input"];
  if (typeof value === "string") return ["text", "input", "graph"];
  if (value !== undefined) return ["text", "input"];
  if (CAMERA.test(path)) return ["camera"];
  const struct = BY_STRUCT.find(([pattern]) => pattern.test(type));
  if (struct) return struct[1];
  if (type) return BY_TYPE[type] ?? ["values"];
  return Object.keys(KINDS);
}

// The settings of a new gauge or slider: limits of which its value is inside.
export function firstSettings(kind, path) {
  if (kind !== "gauge" && kind !== "slider") return {};
  const value = plain(valueIn(model.shown.values, path));
  const size = Math.abs(typeof value === "number" && Number.isFinite(value) ? value : 0);
  const max = size <= 1 ? 1 : 10 ** Math.ceil(Math.log10(size + 1e-9));
  return { min: value < 0 ? -max : 0, max };
}
