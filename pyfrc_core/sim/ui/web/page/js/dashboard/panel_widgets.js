// Widgets that show more than one value: the page's own panels without their tools, and cards of what robot code publishes.
import { command, write } from "#js/connection.js";
import { Select } from "#js/controls.js";
import { boundPath, pathOf, topicOf, typeOf, valuesIn } from "#js/dashboard/topics.js";
import { countdown, plain } from "#js/format.js";
import { robotState } from "#js/link.js";
import { model } from "#js/model.js";
import { Camera } from "#js/panels/cameras.js";
import { FieldPanel } from "#js/panels/field.js";
import { MechanismPanel } from "#js/panels/mechanism.js";
import { PlotPanel } from "#js/panels/plot.js";
import { SwervePanel } from "#js/panels/swerve.js";
import { Alerts, CommandCard, ValuesCard } from "#js/panels/widgets.js";
import { valueIn } from "#js/parts.js";
import { Live, html } from "#js/view.js";

const LATE = 30; // seconds at the end of a match, in another colour
const NO_MATCH = -1; // what robot code reads without a match

// The time that robot code publishes; without a topic, that of the practice match.
export class MatchTime extends Live {
  parts = ["station", "shown", "values", "t"];
  interval = 100;

  render({ path, widget }) {
    const seconds = widget.topic ? plain(valueIn(model.shown.values, path)) : practiceLeft();
    if (widget.topic) model.need(this, [boundPath(path)]);
    const isKnown = typeof seconds === "number" && seconds > NO_MATCH;
    return html`<div class=${isKnown && seconds <= LATE ? "big-number late" : "big-number"} style=${{ "--width": 3.5, "--digits": 3.5 }}>
      <b>${isKnown ? countdown(seconds) : "–:––"}</b></div>`;
  }
}

function practiceLeft() {
  const { practice_since: since, match_left: left } = model.station;
  return model.past || since === null || since === undefined ? undefined : left;
}

export class RobotState extends Live {
  parts = ["station", "shown", "connection"];

  render() {
    const { text, kind } = robotState();
    return html`<div class=${`robot-state centered ${kind}`}><i class="lamp"></i><b>${(text ?? "").replace(/, -?\d+ s$/, "")}</b></div>`;
  }
}

// -- panels

const SECONDS = 20; // of a graph, unless it says otherwise

export function GraphWidget({ id, widget }) {
  const { topic, more = [], seconds = SECONDS, min, max } = widget;
  const curves = [topic, ...more].filter(Boolean).map((each, color) => ({ path: pathOf(each), axis: "left", color }));
  const ranges = min === undefined || max === undefined ? {} : { left: [min, max] };
  return html`<${PlotPanel} id=${id} plot=${{ curves, seconds, ranges }} />`;
}

// All objects on the field; with a topic, only those of this Field2d, or this pose.
export function FieldWidget({ widget }) {
  return html`<${FieldPanel} bare=${true} only=${widget.topic && pathOf(widget.topic)} />`;
}

export function MechanismWidget({ widget }) {
  return html`<${MechanismPanel} only=${widget.topic && pathOf(widget.topic)} />`;
}

// The topic is the camera's table, /CameraPublisher/NAME.
export function CameraWidget({ widget }) {
  return html`<${Camera} name=${widget.topic.split("/").pop()} />`;
}

export function SwerveWidget({ widget }) {
  const { topic, more = [], max } = widget;
  return html`<${SwervePanel} bare=${true} topics=${[topic, ...more].filter(Boolean).map(pathOf)} fastest=${max} />`;
}

// -- tables

// A widget that `content({ path, name, type }, values, listed)` renders whenever a value of its table has changed, or of its
// list of paths.
const tableWidget = (content) =>
  class extends Live {
    parts = ["values", "paths", "shown", "hello", "choosers"];
    interval = 80;

    render({ path, title, widget }) {
      const listed = widget.more?.length ? widget.more.map(pathOf) : null;
      model.need(this, listed ?? [`${path}/`]);
      return content({ path, name: title, type: typeOf(path) }, model.shown.values, listed);
    }
  };

// From 2027 on, a ProfiledPIDController has most of them in a table of its own.
const GAINS = ["p", "i", "d", "f", "setpoint", "goal", "measurement", "error"].flatMap((name) => [name, `controller/${name}`]);

export const ValuesWidget = tableWidget((folder, values, listed) => html`<${ValuesCard} folder=${folder} values=${values} paths=${listed} />`);
export const PidWidget = tableWidget((folder, values) => html`<${ValuesCard} folder=${folder} values=${values} paths=${valuesIn(folder.path, GAINS)} />`);
export const AlertsWidget = tableWidget((folder, values) => html`<${Alerts} folder=${folder} values=${values} />`);
export const CommandWidget = tableWidget((folder, values) => html`<${CommandCard} folder=${folder} values=${values} />`);
export const ChooserWidget = tableWidget(({ path, name }, values) => {
  const chooser = model.past ? null : model.choosers.find((each) => each.name === topicOf(path));
  const options = chooser?.options ?? plain(values.get(`${path}/options`)) ?? [];
  const published = ["active", "selected/value", "default"].map((name) => values.get(`${path}/${name}`)); // the last two from 2027 on
  const active = chooser?.active ?? published.find((each) => each !== undefined) ?? "";
  const choose = (option) => (chooser ? command("choose", { chooser: chooser.name, option }) : write({ [`${path}/${model.hello.options.dashboard.choice}`]: option }));
  return html`<div class="chooser-widget centered"><${Select} aria-label=${name} value=${active} options=${options} disabled=${!model.mayWrite} set=${choose} /></div>`;
});
