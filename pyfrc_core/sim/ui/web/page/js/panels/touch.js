// Two big sticks for a tablet: the left and the right stick of joystick 0, or Y of joysticks 0 and 1 for tank robots.
import { model } from "#js/model.js";
import { Live, html } from "#js/view.js";
import { Button } from "#js/panels/joysticks.js";
import { StickPad } from "#js/panels/stick_pad.js";

const KINDS = {
  gamepad: { title: "Gamepad", left: [0, 0, 1], right: [0, 4, 5] },
  two: { title: "Two joysticks", left: [0, 0, 1], right: [1, 0, 1] },
};

export class TouchPanel extends Live {
  parts = ["hello"];
  state = { kind: null };

  render(_, { kind }) {
    const first = model.hello.options.keyboard.chosen === "Gamepad" ? "gamepad" : "two";
    const chosen = kind ?? first;
    const [left, right] = [KINDS[chosen].left, KINDS[chosen].right];
    return html`<div class="touch">
      <${StickPad} key=${`left ${chosen}`} stick=${left[0]} x=${left[1]} y=${left[2]} round label="Left stick" />
      <div class="touch-middle">
        <select aria-label="What the sticks move" value=${chosen} onChange=${(event) => this.setState({ kind: event.target.value })}>
          ${Object.entries(KINDS).map(([name, each]) => html`<option key=${name} value=${name} selected=${name === chosen}>${each.title}</option>`)}
        </select>
        <div class="touch-buttons">${[1, 2, 3, 4].map((button) => html`<${Button} key=${button} stick=${0} button=${button} touch />`)}</div>
      </div>
      <${StickPad} key=${`right ${chosen}`} stick=${right[0]} x=${right[1]} y=${right[2]} round label="Right stick" />
    </div>`;
  }
}
