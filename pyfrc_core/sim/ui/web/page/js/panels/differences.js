// Where another run differs from this one: first what could not be compared, then every value, and what moved the sensors.
// A click on a value shows it everywhere: its moment, its curves in both runs around it, and its row in a panel.
import { compared } from "#js/compare.js";
import { clock } from "#js/format.js";
import { goTo } from "#js/input/moment_keys.js";
import { showPanel } from "#js/layout/open.js";
import { model } from "#js/model.js";
import { plotFound } from "#js/plotting.js";
import { Live, html } from "#js/view.js";

const PANEL = "differences";
const NOT_COMPARED = [
  ["nothing", "Neither the log nor physics.py moves"],
  ["real time", "Simulated in real time, differs in each run:"],
  ["replay", "Only the replay of AdvantageKit or PyKit gives"],
];
const SOURCES = [["log", "From the log:"], ["physics", "From physics.py:"]];

export function showDifferences() {
  showPanel(PANEL, "joysticks");
}

// What is shown while there is no result.
export function waiting() {
  return model.status.state === "starting" ? "Compared when the replay has ended" : "Comparing with the log…";
}

function show(path, t) {
  showPanel(path.startsWith("nt:") ? "networktables" : "devices");
  showDifferences();
  plotFound(path, t);
  goTo(t);
}

// The path of a value as the command prints it, and as its options take it.
function pathText(path) {
  return path.replace(/^nt:(\/SmartDashboard\/|\/)?/, "");
}

// The sentence about the first difference, which a click shows.
export function FirstDifference({ first }) {
  const { t, paths, limits = [] } = first;
  const text = `${limits.length && first.compared ? "Partly compared. " : ""}${result(first)}`;
  return html`<button class="quiet first-difference" disabled=${t === null && !first.limits} title=${limits[0] ?? "Show the first value that differs, in both runs"}
      onClick=${() => (t === null ? showDifferences() : show(paths[0], t))}><span>${text}</span></button>`;
}

// What the comparison has found, up to when: "no difference" only where most of what a log has was compared.
function result({ t, paths, until, compared: count, mostly = true, by_rarity, count: differing }) {
  if (t !== null && by_rarity) return `${differing} ${differing === 1 ? "value differs" : "values differ"}: ${pathText(paths[0])} at ${clock(t)}`;
  if (t !== null) return `Differs first at ${clock(t)}, in ${pathText(paths[0])}`;
  const same = count === 0 ? "Nothing to compare" : mostly ? "No difference" : "What was compared does not differ";
  return `${same} up to ${clock(until)}`;
}

export class DifferencesPanel extends Live {
  parts = ["compared", "compared-series", "found", "branches"];

  render() {
    const { branch, first } = compared;
    if (!first && branch?.compared) return html`<div class="content"><p class="empty">${waiting()}</p></div>`;
    if (!first) return html`<div class="content"><p class="empty">Choose a former run, or the log that drives this one, under “Branches”.</p></div>`;
    const { others, slight = [], limits = [], sensors = {} } = first;
    const there = first.limits ? "log" : "there";
    return html`<div class="differences content scroll">
      ${limits.map((limit) => html`<p key=${limit} class="limit">${limit}.</p>`)}
      ${NOT_COMPARED.map((source) => html`<${Sensors} key=${source} source=${source} sensors=${sensors} kind="limit" />`)}
      <h3>${result(first)}</h3>
      ${first.by_rarity && others.length > 1 && html`<p class="faint">What changes rarely comes first.</p>`}
      <ul>${others.map(([path, t, before, here]) => html`<${Difference} key=${path} path=${path} t=${t}><small>${there} <b>${before}</b>, here <b>${here}</b></small><//>`)}</ul>
      ${slight.length > 0 && html`<h3>Differs slightly</h3>`}
      <ul>${slight.map(([path, share, t]) => html`<${Difference} key=${path} path=${path} t=${t}><small>At most by ${Number((share * 100).toPrecision(2))} % of its range</small><//>`)}</ul>
      ${SOURCES.map((source) => html`<${Sensors} key=${source} source=${source} sensors=${sensors} />`)}
    </div>`;
  }
}

function Sensors({ source: [source, text], sensors, kind = "" }) {
  const names = sensors[source];
  if (!names?.length) return null;
  return html`<details class=${kind}><summary>${text} ${names.length} ${source === "replay" ? "inputs" : source === "real time" ? "devices" : "values of sensors"}</summary>
    <ul>${names.map((name) => html`<li key=${name}>${name}</li>`)}</ul></details>`;
}

function Difference({ path, t, children }) {
  return html`<li><button aria-current=${model.found?.path === path} onClick=${() => show(path, t)} title="Show this value in both runs">
    <span class="row-label">${pathText(path)}</span><time>${clock(t)}</time>${children}</button></li>`;
}
