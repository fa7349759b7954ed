// The page: the driver station above, the panels, the timeline below.
import { connect } from "./connection.js";
import { FailureBar } from "./failure.js";
import { startGamepads } from "./input/gamepads.js";
import { startKeys } from "./input/keys.js";
import { Dock } from "./layout/dock.js";
import { model } from "./model.js";
import { Notice } from "./notice.js";
import { isRecorded } from "./recorded.js";
import { RecordedTimeBar, startPlaybackKeys } from "./recorded_bar.js";
import { applyTheme, settings } from "./settings.js";
import { StationBar } from "./station.js";
import { TimeBar } from "./timebar.js";
import { Live, html, render } from "./view.js";

class App extends Live {
  parts = ["hello", "connection"];

  render() {
    if (!model.hello) return html`<p class="loading">${WAITING[model.connection] ?? WAITING.lost}</p>`;
    return html`
      <${StationBar} />
      <${Notice} />
      <${FailureBar} />
      <${Dock} />
      <${isRecorded ? RecordedTimeBar : TimeBar} />`;
  }
}

const WAITING = {
  connecting: "Connecting to the simulation…",
  lost: "There is no answer from pyfrc sim. Trying again…",
  refused: "This address is not valid any more. Open the one that pyfrc sim prints.",
  closed: "The simulation was closed.",
  unreadable: "This file is not complete, or this browser is too old to read it. A browser of 2023 or later is needed.",
};

function receive(message) {
  if (message.type === "problem") return model.set("problem", message.text);
  if (message.type === "hello" && !model.hello) {
    settings.load(message.layout);
    applyTheme();
    document.title = `${message.project.name} – ${isRecorded ? message.recorded.what : "pyfrc sim"}`;
  }
  model.take(message);
}

// A button that was clicked with the mouse does not keep the keyboard, so that the space bar stays the emergency stop.
document.addEventListener("click", (event) => {
  const control = event.target.closest?.("button, summary, input[type=checkbox], input[type=radio]");
  if (control && event.detail > 0) control.blur();
});
document.addEventListener("change", (event) => {
  if (event.target.matches("select")) event.target.blur();
});
document.addEventListener("pointerup", (event) => {
  if (event.target.matches?.('input[type="range"]')) event.target.blur();
});

applyTheme();
const root = document.getElementById("app");
root.replaceChildren();
render(html`<${App} />`, root);
if (isRecorded) startPlaybackKeys();
else {
  startKeys();
  startGamepads();
}
connect(receive, (state) => model.set("connection", state));
