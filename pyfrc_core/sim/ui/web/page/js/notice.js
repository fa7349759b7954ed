// One line for what the user should know: a lost connection, a command that failed, a note of the simulation.
import { model } from "#js/model.js";
import { Icon, Live, html } from "#js/view.js";

const LOST = {
  lost: "The connection to pyfrc sim was lost, reconnecting… The page shows the last state.",
  refused: "This address is not valid any more. Open the one that pyfrc sim prints.",
  closed: "The simulation was closed. This is its last state. Start pyfrc sim again, and open the address that it prints.",
};

export class Notice extends Live {
  parts = ["connection", "problem", "status"];
  seen = "";

  render() {
    const lost = LOST[model.connection];
    if (model.status.note !== this.note) {
      this.note = model.status.note;
      this.seen = "";
    }
    const note = model.problem || (model.status.note !== this.seen ? model.status.note : "");
    const text = lost ?? note;
    if (!text) return null;
    return html`<div class=${lost ? "notice bad" : "notice"} role="status">
      <${Icon} name="warning" /><span>${text}</span>
      ${!lost && html`<button class="quiet" aria-label="Hide this message" onClick=${this.hide}><${Icon} name="close" /></button>`}
    </div>`;
  }

  hide = () => {
    this.seen = model.status.note;
    model.set("problem", "");
  };
}
