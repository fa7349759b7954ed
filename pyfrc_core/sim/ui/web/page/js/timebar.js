// Robot time, along the bottom: pause, step, speed, the timeline, and the way back from the past.
import { command } from "#js/connection.js";
import { askText, askWhether } from "#js/dialog.js";
import { BranchesMenu } from "#js/branches.js";
import { clock, speedText } from "#js/format.js";
import { link } from "#js/link.js";
import { Menu } from "#js/popup.js";
import { matchText, momentText } from "#js/match_clock.js";
import { model } from "#js/model.js";
import { commandLive, driveOn, live, lookByPackets } from "#js/past.js";
import { positionOf, speedAt } from "#js/speeds.js";
import { Timeline } from "#js/timeline.js";
import { Icon, Live, html } from "#js/view.js";

// The share of the speed slider that has speeds: beyond the fastest comes "as fast as possible".
const UNLIMITED = 0.94;
const LIVE_INTERVAL = 150; // milliseconds: the clock goes in step with the timeline, in the same frame of the screen
const FIGURES_INTERVAL = 500;

export class TimeBar extends Live {
  parts = ["status", "shown", "hello", "branches", "compared", "compared-series", "connection"];

  render() {
    const { status, past } = model;
    const locked = !model.mayDrive;
    const running = status.wants_to_run;
    return html`<footer class=${past ? "timebar past" : "timebar"}>
      <div class="transport flex">
        <button class="quiet" title="Look at the packet before" aria-label="Look at the packet before" onClick=${() => lookByPackets(-1)}><${Icon} name="stepBack" /></button>
        ${model.isDriven && html`<button class="play" disabled=${locked} title=${running ? "Pause: F5" : "Run: F5"} aria-label=${running ? "Pause" : "Run"}
          onClick=${() => command("toggle")}><${Icon} name=${running ? "pause" : "play"} /></button>`}
        <button class="quiet" title=${past || !model.isDriven ? "Look at the packet after" : "Step by one packet: F6"} aria-label="Step"
          disabled=${locked && !past} onClick=${() => (past ? lookByPackets(1) : command("step", { packets: 1 }))}><${Icon} name="step" /></button>
        <${Clock} />
        ${past
          ? html`<span class="past-actions">
              ${model.hello.source.rewinds && html`<button class="primary" disabled=${locked} onClick=${driveOn} title="Go back to this moment. What came later is kept as a branch.">Drive on from here</button>`}
              <${ToPresent} /></span>`
          : html`<${Present} />`}
        ${model.isDriven && html`<label class="speed" title="Robot seconds per second">Speed
          <input type="range" min="0" max="1" step="0.005" value=${sliderOf(status.speed ?? 1)} disabled=${locked}
            aria-label="Speed" aria-valuetext=${speedText(status.speed ?? 1)} onInput=${(event) => setSpeed(event.target)} />
          <b>${speedText(status.speed ?? 1)}</b></label>`}
        ${model.isDriven && status.speed !== 1 && html`<button class="quiet" disabled=${locked} onClick=${() => command("speed", { factor: 1 })}>Real time</button>`}
        <div class="spacer"></div>
        ${model.isDriven && html`<${Figures} />`}
        <${BranchesMenu} />
        <button class="quiet" disabled=${model.readonly} title="Set a mark at this moment" onClick=${mark}><${Icon} name="flag" /><span>Mark</span></button>
        <${RunMenu} />
      </div>
      <${Timeline} />
    </footer>`;
  }
}

class Clock extends Live {
  parts = ["t", "shown"];

  shouldComponentUpdate(_, state) {
    return state !== this.state;
  }

  render() {
    this.interval = model.past ? 0 : LIVE_INTERVAL;
    const t = model.past?.t ?? model.t;
    return html`<time class="clock" title="Robot time">${clock(t)}</time><span class="match-time" title="Since autonomous was enabled">${matchText(t)}</span>`;
  }
}

// Whether what is shown is what the robot does now.
class Present extends Live {
  parts = ["connection", "status", "station"];

  shouldComponentUpdate(_, state) {
    return state !== this.state;
  }

  render() {
    const { text, kind } = link();
    return html`<span class=${`live-now ${kind}`}><i class="lamp"></i>${text}</span>`;
  }
}

// The way back to the present, or to the last that is known.
class ToPresent extends Live {
  parts = ["connection", "status", "station"];

  render() {
    const { text, kind } = link();
    const title = kind === "live" ? "Show the present" : `Show the last state that is known: ${text.toLowerCase()}`;
    return html`<button class=${`live ${kind}`} title=${title} onClick=${live}><i class="lamp"></i>Live</button>`;
  }
}

async function mark() {
  const t = model.past?.t ?? model.t;
  const text = await askText(`A mark at ${momentText(t)}`, "");
  if (text) command("mark", { t, text });
}

// How this computer keeps up. They change with every packet, and are read from time to time.
class Figures extends Live {
  parts = ["status"];
  interval = FIGURES_INTERVAL;

  shouldComponentUpdate(_, state) {
    return state !== this.state;
  }

  render() {
    return figures(model.status);
  }
}

function figures(status) {
  const milliseconds = (seconds) => `${((seconds ?? 0) * 1000).toFixed(1)} ms`;
  const reached = status.state === "running" ? `${(status.reached ?? 0).toFixed(status.speed === 0 ? 0 : 2)}×` : status.state;
  return html`<dl class="figures">
    <div title="How fast robot time really goes: 1× is as fast as real time"><dt>Actual speed</dt><dd>${reached}</dd></div>
    <div title=${`The time that this computer takes for a packet; the worst of the last second: ${milliseconds(status.worst_packet_seconds)}`}>
      <dt>Packet</dt><dd>${milliseconds(status.packet_seconds)}</dd></div>
    <div class=${status.overruns ? "warn" : ""} title=${`Turns of the robot's loop that took longer than its period; the longest: ${milliseconds(status.worst_loop_seconds)}`}>
      <dt>Overruns</dt><dd>${status.overruns ?? 0}</dd></div>
    ${status.network_address && html`<div title="The NetworkTables server, for dashboards"><dt>NT</dt><dd>${status.network_address}</dd></div>`}
  </dl>`;
}

function RunMenu() {
  const end = { text: model.isDriven ? "End the simulation" : "End this command", act: () => command("quit"), disabled: model.readonly };
  if (!model.isDriven) return html`<${Menu} label="Run" title="End" items=${[end]} />`;
  const items = [
    { text: "Restart the robot", note: "F9", act: () => commandLive("restart"), disabled: model.readonly },
    { text: "Load the code again", act: () => commandLive("reload"), disabled: model.readonly },
    { text: model.station.attached === false ? "Connect the driver station" : "Disconnect the driver station", note: "F8",
      act: () => command("attach", { attached: model.station.attached === false }), disabled: model.readonly },
    { separator: true },
    { text: "Save the recording…", act: save, disabled: model.readonly },
    end,
  ];
  return html`<${Menu} label="Run" title="Restart, save, end" items=${items} />`;
}

async function save() {
  const file = await askText("Save the recording in the project's directory as", "drive.jsonl");
  if (!file) return;
  let answer = await command("save", { file });
  if (answer?.exists && (await askWhether(`${answer.exists} exists. Replace it?`, "Replace"))) answer = await command("save", { file, replace: true });
  if (answer?.file) model.set("problem", `Saved ${answer.file}`);
}

function sliderOf(speed) {
  return speed === 0 ? 1 : positionOf(speed, UNLIMITED);
}

function speedOf(position) {
  return position >= (1 + UNLIMITED) / 2 ? 0 : speedAt(position, UNLIMITED);
}

function setSpeed(slider) {
  const factor = speedOf(Number(slider.value));
  if (factor !== model.status.speed) command("speed", { factor });
}
