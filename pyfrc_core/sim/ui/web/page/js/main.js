// The page: the driver station above, the panels, the timeline below.
import { connect } from "#js/connection.js";
import { FailureBar } from "#js/failure.js";
import { startGamepads } from "#js/input/gamepads.js";
import { startKeys } from "#js/input/keys.js";
import { startMomentKeys } from "#js/input/moment_keys.js";
import { Dock } from "#js/layout/dock.js";
import { model } from "#js/model.js";
import { Notice } from "#js/notice.js";
import { startDrops } from "#js/open_log.js";
import { PACKET, look } from "#js/past.js";
import { RecordedTimeBar, startPlaybackKeys } from "#js/recorded_bar.js";
import { applyTheme, settings } from "#js/settings.js";
import { StationBar } from "#js/station.js";
import { TimeBar } from "#js/timebar.js";
import { Live, html, render } from "#js/view.js";

class App extends Live {
  parts = ["hello", "connection"];

  render() {
    if (!model.hello) return html`<p class="loading">${WAITING[model.connection] ?? WAITING.lost}</p>`;
    return html`
      <${StationBar} />
      <${Notice} />
      <${FailureBar} />
      <${Dock} />
      <${model.isOver ? RecordedTimeBar : TimeBar} />`;
  }
}

const WAITING = {
  connecting: "Connecting to the simulation…",
  lost: "There is no answer from pyfrc. Trying again…",
  refused: "This address is not valid any more. Open the one that pyfrc prints.",
  closed: "The simulation was closed.",
  unreadable: "This file is not complete, or this browser is too old to read it. A browser of May 2024 or later is needed.",
};

function receive(message) {
  if (message.type === "problem") return model.set("problem", message.text);
  const isFirst = message.type === "hello" && !model.hello;
  if (isFirst) {
    settings.load(message.layout);
    applyTheme();
    document.title = `${message.project.name} – ${message.source.title}`;
  } else if (message.type === "hello") settings.saveUnsaved();
  model.take(message);
  if (isFirst && message.source.begins !== null) look(message.source.begins + PACKET);
}

// A button that was clicked with the mouse does not keep the keyboard, so that the space bar stays the emergency stop.
document.addEventListener("click", (/** @type {any} */ { target, detail }) => {
  const control = target.closest?.("button, summary, input[type=checkbox], input[type=radio]");
  if (control && detail > 0) control.blur();
});
document.addEventListener("change", (/** @type {any} */ { target }) => {
  if (target.matches("select")) target.blur();
});
document.addEventListener("pointerup", (/** @type {any} */ { target }) => {
  if (target.matches?.('input[type="range"]')) target.blur();
});

applyTheme();
const root = document.getElementById("app");
root.replaceChildren();
render(html`<${App} />`, root);
startPlaybackKeys();
startMomentKeys();
startDrops();
startKeys();
startGamepads();
connect(receive, (state) => model.set("connection", state));
