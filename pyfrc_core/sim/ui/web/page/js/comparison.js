// Where the log that drives this run differs from it, and what moves the robot's sensors: a sentence, and a list.
import { compared } from "#js/compare.js";
import { clock } from "#js/format.js";
import { goTo } from "#js/input/moment_keys.js";
import { html, render } from "#js/view.js";

const SOURCES = [
  ["log", "From the log"],
  ["physics", "From physics.py"],
  ["nothing", "Neither: not simulated"],
  ["real time", "Simulated in real time: differs in each run"],
  ["replay", "Only by the replay of AdvantageKit or PyKit"],
];

// The path of a value as the command prints it, and as its options take it.
function pathText(path) {
  return path.replace(/^nt:(\/SmartDashboard\/|\/)?/, "");
}

// The sentence about the first difference, which a click goes to.
export function FirstDifference({ difference, found }) {
  if (difference === null && !found) return html`<button class="quiet" disabled>No difference</button>`;
  if (!found) {
    return html`<button class="quiet" onClick=${() => goTo(difference)} title="The first moment at which the branch differs from this run">
      Differs at ${clock(difference)}</button>`;
  }
  const { limits } = found;
  const text = `${limits.length && found.compared ? "Partly compared. " : ""}${result(difference, found)}`;
  const title = limits[0] ?? "The first moment at which the log differs from what the code does now";
  return html`<button class="quiet first-difference" disabled=${difference === null && !limits.length}
      onClick=${() => (difference === null ? showComparison() : goTo(difference))} title=${title}><span>${text}</span></button>`;
}

// What the comparison has found, up to when: "no difference" only where most of what the log has was compared.
function result(difference, { paths, until, compared: count, mostly }) {
  if (difference !== null) return `Differs first at ${clock(difference)}, in ${pathText(paths[0])}`;
  const same = count === 0 ? "Nothing to compare" : mostly ? "No difference" : "What was compared does not differ";
  return `${same} up to ${clock(until)}`;
}

// Show all values that differ, and what moves the sensors.
export function showComparison() {
  const dialog = document.createElement("dialog");
  dialog.className = "comparison";
  const { branch, found } = compared;
  const closeAt = (t) => () => {
    dialog.close();
    goTo(t);
  };
  render(
    html`<form method="dialog">
      <h2>${branch.name} and today’s code</h2>
      ${found.limits.map((limit) => html`<p key=${limit}>${limit}.</p>`)}
      ${found.others.length === 0 && html`<p>${result(null, found)}.</p>`}
      ${found.others.length > 0 && html`<table><thead><tr><th>Differs first at</th><th>Value</th><th>In the log</th><th>Here</th></tr></thead>
        <tbody>${found.others.map(([path, t, there, here]) => html`<tr key=${path}>
          <td><button type="button" class="quiet" onClick=${closeAt(t)}>${clock(t)}</button></td><td>${pathText(path)}</td><td>${there}</td><td>${here}</td></tr>`)}</tbody></table>`}
      ${found.slight.length > 0 && html`<table><thead><tr><th>Differs most at</th><th>Differs slightly</th><th>At most, of its range</th></tr></thead>
        <tbody>${found.slight.map(([path, share, t]) => html`<tr key=${path}>
          <td><button type="button" class="quiet" onClick=${closeAt(t)}>${clock(t)}</button></td><td>${pathText(path)}</td><td>${Number((share * 100).toPrecision(2))} %</td></tr>`)}</tbody></table>`}
      <table><thead><tr><th>Sensors</th><th>Value</th></tr></thead>
        <tbody>${SOURCES.flatMap(([source, text]) => found.sensors[source].map((path) => html`<tr key=${path}><td>${text}</td><td>${path}</td></tr>`))}</tbody></table>
      <div class="dialog-buttons"><button class="primary" value="ok">Close</button></div>
    </form>`,
    dialog,
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
