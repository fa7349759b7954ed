// Two big sticks for a tablet: the left and the right stick of joystick 0, or Y of joysticks 0 and 1 for tank robots.
import { Select } from "#js/controls.js";
import { model } from "#js/model.js";
import { Live, html } from "#js/view.js";
import { Button } from "#js/panels/joysticks.js";
import { StickPad } from "#js/panels/stick_pad.js";

const KINDS = [["gamepad", "Gamepad"], ["two", "Two joysticks"]];

export class TouchPanel extends Live {
  parts = ["hello"];
  state = { kind: null };

  render(_, { kind }) {
    const first = model.hello.options.keyboard.chosen === "Gamepad" ? "gamepad" : "two";
    const chosen = kind ?? first;
    const { gamepad, buttons } = model.hello.options;
    const left = [0, 0, 1];
    const right = chosen === "gamepad" ? [0, gamepad.axes.indexOf("right_x"), gamepad.axes.indexOf("right_y")] : [1, 0, 1];
    return html`<div class="touch">
      <${StickPad} key=${`left ${chosen}`} stick=${left[0]} x=${left[1]} y=${left[2]} round label="Left stick" />
      <div class="touch-middle column">
        <${Select} aria-label="What the sticks move" value=${chosen} options=${KINDS} set=${(each) => this.setState({ kind: each })} />
        <div class="touch-buttons">${[0, 1, 2, 3].map((index) => buttons.first + index).map((button) => html`<${Button} key=${button} stick=${0} button=${button} touch />`)}</div>
      </div>
      <${StickPad} key=${`right ${chosen}`} stick=${right[0]} x=${right[1]} y=${right[2]} round label="Right stick" />
    </div>`;
  }
}
