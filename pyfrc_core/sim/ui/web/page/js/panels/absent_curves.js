// The curves of a plot whose values this log or robot does not have: they are those of another log or of the simulation,
// arranged in the same place. They are not drawn, and kept for what has them, unless a person removes them.
import { keyOf, titleOf } from "#js/curves.js";
import { Dropdown } from "#js/popup.js";
import { model } from "#js/model.js";
import { Icon, html } from "#js/view.js";

// Whether there is nothing to draw of a path, and never will be. `one` is its series, `other` that of the compared branch.
export function isAbsent(one, other) {
  // A robot publishes its values sooner or later; it has no devices and no place of a simulation.
  const isNever = model.isOver || (model.hello.source?.kind === "robot" && one && !one.path.startsWith("nt:"));
  return isNever && Boolean(one?.isLoaded) && !one.t.length && !other?.t.length;
}

export function AbsentCurves({ curves, remove }) {
  if (!curves.length) return null;
  const [where, what] = model.isOver ? ["in this log", "log"] : ["from this robot", "robot"];
  return html`<${Dropdown} label=${html`<${Icon} name="warning" />${curves.length}<span> not ${where}</span>`} name=${`${curves.length} not ${where}`} title=${`Curves whose values this ${what} does not have`} className="quiet absent"
    content=${(close) => html`<div class="form "><ul class="absent-list">${curves.map((curve) => html`<li key=${keyOf(curve)} title=${curve.path}>${titleOf(curve)}</li>`)}</ul>
      <p class="faint">They are kept for ${model.isOver ? "logs that have them" : "the simulation, or a log"}.</p>
      <button onClick=${() => { close(); remove(); }}>Remove ${curves.length === 1 ? "it" : "them"}</button></div>`} />`;
}
