// The choices before a match: alliance, game data, start, and the robot's choosers.
import { command } from "#js/connection.js";
import { model } from "#js/model.js";
import { TextBox } from "#js/text_box.js";
import { Live, html } from "#js/view.js";

export class MatchPanel extends Live {
  parts = ["station", "choosers", "hello"];
  state = { start: "" };

  render(_, { start }) {
    const { options, field } = model.hello;
    const { station } = model;
    const locked = !model.mayDrive;
    const starts = Object.keys(field.starts);
    return html`<div class="form scroll">
      <label>Alliance
        <select value=${station.alliance} disabled=${locked} class=${`alliance ${(station.alliance ?? "").slice(0, -1)}`}
          onChange=${(event) => command("alliance", { station: event.target.value })}>
          ${Object.entries(options.alliances).map(([name, value]) => html`<option key=${value} value=${value} selected=${value === station.alliance}>${name}</option>`)}
        </select></label>
      <label>Game data
        <${TextBox} list="game-messages" text=${station.game_message ?? ""} disabled=${locked} spellcheck="false"
          placeholder="none" onKeyDown=${commit} onChange=${(event) => command("game_message", { text: event.target.value })} />
        <datalist id="game-messages">${options.game_messages.map((text) => html`<option key=${text} value=${text}></option>`)}</datalist></label>
      ${starts.length > 0 && model.isDriven && html`<label>Start
        <span class="beside"><select value=${start || starts[0]} disabled=${locked} onChange=${(event) => this.choose(event.target.value)}>
          ${starts.map((name) => html`<option key=${name} value=${name}>${name}</option>`)}</select>
          <button disabled=${locked} title="Put the robot back to its start" onClick=${() => command("reset_position", { start: start || starts[0] })}>Reset</button></span></label>`}
      ${model.choosers.map((chooser) => html`<${Chooser} key=${chooser.name} chooser=${chooser} />`)}
    </div>`;
  }

  choose(start) {
    this.setState({ start });
    command("reset_position", { start });
  }
}

function commit(event) {
  event.stopPropagation();
  if (event.key === "Enter") event.target.blur();
}

export function Chooser({ chooser }) {
  const name = chooser.name.split("/").pop();
  return html`<label title=${chooser.name}><span>${name}</span>
    <select value=${chooser.active} disabled=${!model.mayWrite} aria-label=${name}
      onChange=${(event) => command("choose", { chooser: chooser.name, option: event.target.value })}>
      ${chooser.options.map((option) => html`<option key=${option} value=${option} selected=${option === chooser.active}>${option}</option>`)}
    </select></label>`;
}
