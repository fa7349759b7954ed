// One line for what the user should know: a lost connection, a command that failed, a note of the simulation.
import { model } from "#js/model.js";
import { Icon, Live, html } from "#js/view.js";

const LOST = {
  lost: (command) => `The connection to ${command} was lost, reconnecting… The page shows the last state.`,
  refused: (command) => `This address is not valid any more. Open the one that ${command} prints.`,
  closed: (command) =>
    `${command === "pyfrc sim" ? "The simulation was closed" : `${command} has ended`}. This is its last state. Start ${command} again, and open the address that it prints.`,
};

export class Notice extends Live {
  parts = ["connection", "problem", "status"];
  seen = "";

  render() {
    const command = model.hello?.source?.kind === "simulation" ? "pyfrc sim" : "pyfrc view";
    const lost = LOST[model.connection]?.(command);
    if (model.status.note !== this.note) {
      this.note = model.status.note;
      this.seen = "";
    }
    const note = model.problem || (model.status.note !== this.seen ? model.status.note : "");
    const text = lost ?? note;
    if (!text) return null;
    return html`<div class=${lost ? "notice flex bad" : "notice flex"} role="status">
      <${Icon} name="warning" /><span>${text}</span>
      ${!lost && html`<button class="quiet" aria-label="Hide this message" onClick=${this.hide}><${Icon} name="close" /></button>`}
    </div>`;
  }

  hide = () => {
    this.seen = model.status.note;
    model.set("problem", "");
  };
}
