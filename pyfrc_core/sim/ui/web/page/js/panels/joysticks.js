// The six joysticks: their gamepads, axes, buttons and POV.
import { command, write } from "#js/connection.js";
import { Select } from "#js/controls.js";
import { numberText, plain } from "#js/format.js";
import { assignedTo, gamepads, labelOf, padName } from "#js/input/gamepads.js";
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";
import { Bound, Live, classes, createRef, html } from "#js/view.js";
import { StickPad, axisTarget } from "#js/panels/stick_pad.js";

const BUTTONS = 12;
const POVS = [315, 0, 45, 270, -1, 90, 225, 180, 135];
const ARROWS = { 315: "↖", 0: "↑", 45: "↗", 270: "←", 90: "→", 225: "↙", 180: "↓", 135: "↘" };

export class JoysticksPanel extends Live {
  parts = ["gamepads", "settings", "hello", "paths", "shown"];
  state = { stick: 0 };

  render(_, { stick }) {
    const { axes, buttons } = model.hello.options.joysticks[stick];
    const plugged = model.shown.values.has(`joysticks[${stick}].axes`);
    const axisNumbers = Object.keys(axes).map(Number);
    const { first } = model.hello.options.buttons;
    const buttonNumbers = [...new Set([...Array.from({ length: BUTTONS }, (_, index) => first + index), ...Object.keys(buttons).map(Number)])].sort((one, other) => one - other);
    return html`<div class="joysticks content column">
      <div class="segments small" role="tablist" aria-label="Joystick">
        ${[0, 1, 2, 3, 4, 5].map((number) => html`<button key=${number} role="tab" aria-selected=${number === stick}
          class=${classes({ chosen: number === stick, has: assignedTo(number) !== null })} onClick=${() => this.setState({ stick: number })}>${number}</button>`)}
      </div>
      <div class="scroll fill" key=${stick}>
        ${model.isDriven && html`<${GamepadChoice} stick=${stick} plugged=${plugged} />`}
        <div class="stick-row flex">
          <${StickPad} stick=${stick} x=${0} y=${1} label="Axes 0 and 1" />
          <${Pov} stick=${stick} />
        </div>
        ${axisNumbers.map((axis) => html`<${Axis} key=${axis} stick=${stick} axis=${axis} label=${axes[axis]} />`)}
        <div class="buttons">
          ${buttonNumbers.map((button) => html`<${Button} key=${button} stick=${stick} button=${button} label=${buttons[button] ?? ""} />`)}
        </div>
      </div>
    </div>`;
  }
}

function GamepadChoice({ stick, plugged }) {
  const pads = gamepads();
  const assigned = assignedTo(stick, pads);
  const choose = (given) => {
    const { [stick]: _, ...others } = settings.get("gamepads");
    settings.set("gamepads", given === "auto" ? others : { ...others, [stick]: given });
  };
  const chosen = settings.get("gamepads")[stick] ?? "auto";
  const options = [
    ["auto", assigned && chosen === "auto" ? padName(assigned) : "Automatic: no gamepad"],
    ["none", "Keyboard and mouse only"],
    ...pads.map((pad) => [labelOf(pad, pads), padName(pad)]),
  ];
  if (!options.some(([value]) => value === chosen)) options.push([chosen, `${chosen} (not connected)`]);
  return html`<div class="gamepad flex">
    <label class="check"><input type="checkbox" checked=${plugged} disabled=${!model.mayDrive}
      onChange=${(event) => command("plug", { stick, plugged: event.target.checked })} />Plugged in</label>
    <${Select} aria-label=${`Gamepad of joystick ${stick}`} value=${chosen} options=${options} set=${choose} disabled=${!model.mayDrive} /></div>`;
}

class Axis extends Bound {
  element = createRef();

  get boundPath() {
    return `joysticks[${this.props.stick}].axes`;
  }

  paint(axes) {
    const value = plain(axes?.[this.props.axis]) ?? 0;
    const [slider, text] = this.element.current.children[1].children;
    if (document.activeElement !== slider) slider.value = String(value);
    text.textContent = numberText(value, 2);
  }

  render({ stick, axis, label }) {
    return html`<label class="axis flex" ref=${this.element}><span class="row-label">${label}</span><span class="slider flex">
      <input type="range" min="-1" max="1" step="0.01" aria-label=${`Axis ${label}`} disabled=${!model.mayDrive}
        onInput=${(event) => write({ [axisTarget(stick, axis)]: Number(event.target.value) })}
        onDblClick=${() => write({ [axisTarget(stick, axis)]: 0 })} />
      <span class="number"></span></span></label>`;
  }
}

// What a button does while the mouse, a finger, Space or Enter holds it.
function whileHeld(hold, letGo) {
  const isKey = (event) => [" ", "Enter"].includes(event.key);
  return {
    onPointerDown(event) {
      if (event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      hold();
    },
    onPointerUp: letGo,
    onPointerCancel: letGo,
    onBlur: letGo,
    onKeyDown(event) {
      if (!isKey(event) || event.repeat) return;
      event.preventDefault();
      event.stopPropagation();
      hold();
    },
    onKeyUp: (event) => isKey(event) && letGo(),
  };
}

export class Button extends Bound {
  element = createRef();

  get boundPath() {
    return `joysticks[${this.props.stick}].buttons`;
  }

  paint(buttons) {
    this.pressed = Boolean(buttons?.[this.props.button]);
    this.element.current.classList.toggle("pressed", this.pressed);
    this.element.current.setAttribute("aria-pressed", String(this.pressed));
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    this.letGo();
  }

  press(pressed) {
    const { stick, button } = this.props;
    this.pressed = pressed; // until the robot's next update: a click that follows at once must not undo another one
    command("button", { stick, button, pressed });
  }

  render({ button, label, touch }) {
    const title = touch ? `Button ${button}` : `${label || `Button ${button}`}: the right mouse button keeps it pressed`;
    return html`<button ref=${this.element} class="stick-button" title=${title}
      disabled=${!model.mayDrive} onContextMenu=${this.keep} ...${whileHeld(this.hold, this.letGo)}><b>${button}</b><small>${label}</small></button>`;
  }

  hold = () => {
    this.holding = true;
    this.press(true);
  };

  letGo = () => {
    if (this.holding) this.press(false);
    this.holding = false;
  };

  keep = (event) => {
    event.preventDefault();
    if (!this.props.touch) this.press(!this.pressed); // a long touch is none of the right mouse button
  };
}

class Pov extends Bound {
  element = createRef();

  get boundPath() {
    return `joysticks[${this.props.stick}].povs`;
  }

  paint(povs) {
    this.angle = povs?.[0] ?? -1;
    [...this.element.current.children].forEach((button, index) => button.classList.toggle("pressed", this.angle !== -1 && POVS[index] === this.angle));
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    this.letGo();
  }

  hold(angle) {
    this.holding = true;
    this.turn(angle);
  }

  letGo = () => {
    if (this.holding) this.turn(-1);
    this.holding = false;
  };

  turn(angle) {
    command("pov", { stick: this.props.stick, pov: 0, angle });
  }

  render() {
    return html`<div class="pov" role="group" aria-label="POV" ref=${this.element}>
      ${POVS.map((angle) => angle === -1
        ? html`<i key=${angle}>POV</i>`
        : html`<button key=${angle} aria-label=${`POV ${angle}°`} disabled=${!model.mayDrive}
          onContextMenu=${(event) => (event.preventDefault(), this.turn(this.angle === angle ? -1 : angle))}
          ...${whileHeld(() => this.hold(angle), this.letGo)}>${ARROWS[angle]}</button>`)}
    </div>`;
  }
}
