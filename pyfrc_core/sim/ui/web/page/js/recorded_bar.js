// The controls of what is over, a recorded run or a log: what it is, and its time.
import { BranchesMenu } from "#js/branches.js";
import { command } from "#js/connection.js";
import { clock, speedText } from "#js/format.js";
import { matchText } from "#js/match_clock.js";
import { model } from "#js/model.js";
import { live, look, lookByPackets } from "#js/past.js";
import { playback } from "#js/playback.js";
import { isRecorded } from "#js/recorded.js";
import { Timeline } from "#js/timeline.js";
import { Icon, Live, html } from "#js/view.js";

const KINDS = { simulation: "Recorded run", log: "Log", robot: "Robot" };

// Where there is nothing to drive: what it is.
export function SourceLabel() {
  const { source, version } = model.hello;
  const when = source.when ? new Date(source.when).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" }) : "";
  return html`<div class="recorded flex" title=${[source.title, source.when, `pyfrc ${version}`].filter(Boolean).join(", ")}>
    <span class="chip">${KINDS[source.kind]}</span><code>${source.title}</code>${when && html`<span>${when}</span>`}
    ${isRecorded && html`<span>pyfrc ${version}</span>`}</div>`;
}

export class RecordedTimeBar extends Live {
  parts = ["status", "shown", "hello", "playback", "branches", "compared", "compared-series", "series"];

  render() {
    const { past, status, hello: { source } } = model;
    const { playing, speed, position } = playback;
    const step = (packets) => () => {
      playback.pause();
      lookByPackets(packets);
    };
    return html`<footer class="timebar">
      <div class="transport flex">
        <button class="quiet" title="To the beginning" aria-label="To the beginning" onClick=${() => look(0)}><${Icon} name="first" /></button>
        <button class="quiet" title="Look at the packet before" aria-label="Look at the packet before" onClick=${step(-1)}><${Icon} name="stepBack" /></button>
        <button class="play" title=${playing ? "Pause: the space bar" : "Play: the space bar"} aria-label=${playing ? "Pause" : "Play"}
          onClick=${() => playback.toggle()}><${Icon} name=${playing ? "pause" : "play"} /></button>
        <button class="quiet" title="Look at the packet after" aria-label="Look at the packet after" onClick=${step(1)}><${Icon} name="step" /></button>
        <button class="quiet" title="To the end" aria-label="To the end" onClick=${toEnd}><${Icon} name="last" /></button>
        <time class="clock" title="Robot time">${clock(past ? past.t : model.t)}</time>
        <span class="run-end" title=${past && "Since autonomous was enabled"}>${past ? matchText(past.t) : source.kind === "log" ? "End of the log" : "End of the run"}</span>
        <label class="speed" title="Robot seconds per second">Speed
          <input type="range" min="0" max="1" step="0.005" value=${position} aria-label="Speed" aria-valuetext=${speedText(speed)}
            onInput=${(event) => { playback.position = Number(event.target.value); }} />
          <b>${speedText(speed)}</b></label>
        <div class="spacer"></div>
        ${source.replays && html`<button disabled=${model.readonly} onClick=${whatIf}
          title="Run this project’s code with the inputs of this log, and show where the two differ">What would my code have done?</button>`}
        <${BranchesMenu} />
        <dl class="figures">
          <div title="The length of the run, in robot time"><dt>Length</dt><dd>${clock(status.length)}</dd></div>
          ${source.kind === "simulation" && html`<div class=${status.overruns ? "warn" : ""} title="Turns of the robot's loop that took longer than its period">
            <dt>Overruns</dt><dd>${status.overruns ?? 0}</dd></div>`}
        </dl>
      </div>
      <${Timeline} />
    </footer>`;
  }
}

// The robot's code may take longer to start than a page waits for an answer, so it asks again until it has an address.
async function whatIf() {
  model.set("problem", "Starting your code…");
  let answer;
  do answer = await command("what_if");
  while (answer?.address === "");
  if (answer) location.href = answer.address;
}

function toEnd() {
  playback.pause();
  live();
}

// The space bar plays and pauses, except where it means something else.
export function startPlaybackKeys() {
  document.addEventListener("keydown", (/** @type {any} */ event) => {
    if (!model.isOver || event.key !== " " || event.repeat || event.target.closest?.("input, select, textarea, button, summary, a")) return;
    event.preventDefault();
    playback.toggle();
  });
}
