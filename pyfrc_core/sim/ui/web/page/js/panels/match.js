// The choices before a match: alliance, game data, start, and the robot's choosers.
import { command } from "#js/connection.js";
import { Select, TextBox } from "#js/controls.js";
import { model } from "#js/model.js";
import { Live, html } from "#js/view.js";

export class MatchPanel extends Live {
  parts = ["station", "choosers", "hello"];
  state = { start: "" };

  render(_, { start }) {
    const { options, field } = model.hello;
    const { station } = model;
    const locked = !model.mayDrive;
    const starts = Object.keys(field.starts);
    return html`<div class="form  scroll">
      <label>Alliance
        <${Select} class=${`alliance ${(station.alliance ?? "").slice(0, -1)}`} value=${station.alliance} disabled=${locked}
          options=${Object.entries(options.alliances).map(([name, value]) => [value, name])} set=${(value) => command("alliance", { station: value })} /></label>
      <label>Game data
        <${TextBox} list="game-messages" text=${station.game_message ?? ""} disabled=${locked} placeholder="none" set=${(text) => command("game_message", { text })} />
        <datalist id="game-messages">${options.game_messages.map((text) => html`<option key=${text} value=${text}></option>`)}</datalist></label>
      ${starts.length > 0 && model.isDriven && html`<label>Start
        <span class="beside"><${Select} value=${start || starts[0]} options=${starts} disabled=${locked} set=${(name) => this.choose(name)} />
          <button disabled=${locked} title="Put the robot back to its start" onClick=${() => command("reset_position", { start: start || starts[0] })}>Reset</button></span></label>`}
      ${model.choosers.map((chooser) => html`<${Chooser} key=${chooser.name} chooser=${chooser} />`)}
    </div>`;
  }

  choose(start) {
    this.setState({ start });
    command("reset_position", { start });
  }
}

export function Chooser({ chooser }) {
  const name = chooser.name.split("/").pop();
  return html`<label title=${chooser.name}><span>${name}</span>
    <${Select} aria-label=${name} value=${chooser.active} options=${chooser.options} disabled=${!model.mayWrite} set=${(option) => command("choose", { chooser: chooser.name, option })} /></label>`;
}
