// A square (or a big round stick) that moves two axes, by mouse, finger or arrow keys; it returns when released.
import { write } from "#js/connection.js";
import { plain } from "#js/format.js";
import { model } from "#js/model.js";
import { Bound, createRef, html } from "#js/view.js";

export function axisTarget(stick, axis) {
  return `joysticks[${stick}].axes[${axis}]`;
}

export class StickPad extends Bound {
  element = createRef();

  get boundPath() {
    return `joysticks[${this.props.stick}].axes`;
  }

  paint(axes) {
    const { x, y } = this.props;
    if (!this.dragging) this.moveKnob(plain(axes?.[x]) ?? 0, plain(axes?.[y]) ?? 0);
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    if (this.dragging || this.pushed) this.move(0, 0);
  }

  moveKnob(x, y) {
    const knob = this.element.current.querySelector(".knob");
    knob.style.left = `${50 + x * 50}%`;
    knob.style.top = `${50 + y * 50}%`;
  }

  render({ round, label }) {
    return html`<div class=${round ? "stick round" : "stick"} ref=${this.element} tabindex="0" role="application" aria-label=${label}
      onPointerDown=${this.begin} onPointerMove=${this.drag} onPointerUp=${this.end} onPointerCancel=${this.end} onKeyDown=${this.key} onKeyUp=${this.keyUp} onBlur=${this.letGo}>
      <div class="area"><i class="knob"></i></div></div>`;
  }

  move(x, y) {
    const { stick, x: axisX, y: axisY } = this.props;
    this.moveKnob(x, y);
    write({ [axisTarget(stick, axisX)]: x, [axisTarget(stick, axisY)]: y });
  }

  begin = (event) => {
    if (!model.mayDrive) return;
    event.preventDefault();
    event.currentTarget.setPointerCapture(event.pointerId);
    this.dragging = true;
    this.drag(event);
  };

  drag = (event) => {
    if (!this.dragging) return;
    const box = this.element.current.querySelector(".area").getBoundingClientRect();
    let x = ((event.clientX - box.left) / box.width) * 2 - 1;
    let y = ((event.clientY - box.top) / box.height) * 2 - 1;
    if (this.props.round) {
      const far = Math.max(Math.hypot(x, y), 1);
      x /= far;
      y /= far;
    }
    const limited = (value) => Number(Math.min(Math.max(value, -1), 1).toFixed(3));
    this.move(limited(x), limited(y));
  };

  end = () => {
    if (!this.dragging) return;
    this.dragging = false;
    this.move(0, 0);
  };

  key = (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way || event.repeat || !model.mayDrive) return;
    event.preventDefault();
    event.stopPropagation();
    this.pushed = true;
    this.move(...way);
  };

  keyUp = (event) => {
    if (event.key.startsWith("Arrow")) this.letGo();
  };

  // Without the keyboard, it does not hear that the key goes up.
  letGo = () => {
    if (this.pushed) this.move(0, 0);
    this.pushed = false;
  };
}
