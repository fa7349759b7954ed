// Looking at the past: one moment in every panel at once. Nothing is run, and nothing is lost.
import { ask, command } from "#js/connection.js";
import { clock } from "#js/format.js";
import { NO_CONNECTION } from "#js/gaps.js";
import { model } from "#js/model.js";
import { isRecorded } from "#js/recorded.js";

export const PACKET = 0.02; // seconds
const WITHOUT_STATION = { [NO_CONNECTION]: "No connection", "unknown mode": "Connected" };

let wanted = null;
let asking = false;
let hasOtherNeeds = false; // whether panels need other values than when they were asked for

export function length() {
  return Math.max(model.status.length ?? 0, model.t);
}

// Show the packet that is nearest to a moment. While an answer is on its way, only the newest wish counts.
export function look(t) {
  if (isForgotten(t)) {
    model.set("problem", `The values before ${clock(model.knownFrom)} were forgotten, since memory for them is limited.`);
  }
  const first = Math.ceil(model.knownFrom / PACKET) * PACKET;
  wanted = Math.min(Math.max(Math.round(t / PACKET) * PACKET, first), length());
  if (!asking) fetchWanted();
}

// Whether the values of a moment are no longer kept.
export function isForgotten(t) {
  return t < model.knownFrom;
}

export function lookBy(seconds) {
  look((wanted ?? model.past?.t ?? model.t) + seconds);
}

export function lookByPackets(count) {
  lookBy(count * PACKET);
}

async function fetchWanted() {
  asking = true;
  while (wanted !== null) {
    const t = wanted;
    hasOtherNeeds = false;
    try {
      const answer = await ask("values", { t, branch: null, shown: true });
      if (wanted !== null) show(t, new Map(Object.entries(answer.values)));
    } catch (error) {
      if (wanted === t) model.set("problem", error.message);
    }
    if (wanted === t && !hasOtherNeeds) break;
  }
  asking = false;
}

function show(t, values) {
  const mode = values.get("sim.mode") ?? "disabled";
  const enabled = !mode.startsWith("disabled") && !WITHOUT_STATION[mode];
  model.show({
    t,
    values,
    robot: values.get("sim.pose") ?? null,
    station: { ...model.station, mode, enabled, text: modeText(mode), kind: enabled ? "enabled" : "disabled" },
  });
}

function modeText(mode) {
  if (WITHOUT_STATION[mode]) return WITHOUT_STATION[mode];
  const chosen = mode === "disabled" ? "teleop" : mode.replace("disabled ", "");
  return `${model.hello.options.modes[chosen] ?? chosen} ${mode.startsWith("disabled") ? "disabled" : "enabled"}`;
}

// Panels that were opened need values of the moment, too: after the server has heard of them.
model.listen((changed) => {
  if (!changed.has("needs") || isRecorded) return;
  hasOtherNeeds = true;
  if (model.past) queueMicrotask(() => model.past && look(model.past.t));
});

// Show the present again.
export function live() {
  wanted = null;
  if (model.past) model.show(null);
}

// Carry out a command whose effect the person sees, also after a look at the past.
export function commandLive(name, fields = {}) {
  live();
  command(name, fields);
}

// Go back to the moment that is shown, and drive on from there. What came later is kept as a branch.
export function driveOn() {
  const t = model.past?.t;
  if (t !== undefined) commandLive("rewind", { t });
}
