// The curves of a plot whose values this log does not have: they are those of another log, which is arranged in the same
// place. They are not drawn, and kept for that log, unless a person removes them.
import { keyOf, titleOf } from "#js/curves.js";
import { Dropdown } from "#js/dropdown.js";
import { model } from "#js/model.js";
import { Icon, html } from "#js/view.js";

// Whether there is nothing to draw of a path, and never will be. `one` is its series, `other` that of the compared branch.
export function isAbsent(one, other) {
  return model.isOver && Boolean(one?.isLoaded) && !one.t.length && !other?.t.length;
}

export function AbsentCurves({ curves, remove }) {
  if (!curves.length) return null;
  return html`<${Dropdown} label=${html`<${Icon} name="warning" />${curves.length}<span> not in this log</span>`} name=${`${curves.length} not in this log`} title="Curves whose values this log does not have" className="quiet absent"
    content=${(close) => html`<div class="form"><ul class="absent-list">${curves.map((curve) => html`<li key=${keyOf(curve)} title=${curve.path}>${titleOf(curve)}</li>`)}</ul>
      <p class="faint">They are kept for logs that have them.</p>
      <button onClick=${() => { close(); remove(); }}>Remove ${curves.length === 1 ? "it" : "them"}</button></div>`} />`;
}
