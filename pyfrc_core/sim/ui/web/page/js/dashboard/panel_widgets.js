// Widgets that are the page's own panels without their tools.
import { pathOf } from "#js/dashboard/topics.js";
import { Camera } from "#js/panels/cameras.js";
import { FieldPanel } from "#js/panels/field.js";
import { MechanismPanel } from "#js/panels/mechanism.js";
import { PlotPanel } from "#js/panels/plot.js";
import { SwervePanel } from "#js/panels/swerve.js";
import { html } from "#js/view.js";

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
