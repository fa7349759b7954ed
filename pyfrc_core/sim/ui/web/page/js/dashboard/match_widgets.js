// Widgets of the match: the time that is left, and what the robot is doing.
import { countdown, plain } from "#js/format.js";
import { boundPath } from "#js/dashboard/topics.js";
import { robotState } from "#js/link.js";
import { model } from "#js/model.js";
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
    return html`<div class=${`robot-state ${kind}`}><i class="lamp"></i><b>${(text ?? "").replace(/, -?\d+ s$/, "")}</b></div>`;
  }
}
