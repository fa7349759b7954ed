// Widgets of a single value: number, text, box, lamp, switch, gauge.
import { write } from "#js/connection.js";
import { Switch } from "#js/controls.js";
import { numberText, plain, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { unitOfPath } from "#js/names.js";
import { valueIn } from "#js/parts.js";
import { boundPath } from "#js/dashboard/topics.js";
import { ValueBox } from "#js/value_box.js";
import { Bound, html } from "#js/view.js";

// Renders again whenever its value changes.
export class ValueWidget extends Bound {
  get boundPath() {
    return boundPath(this.props.path);
  }

  get value() {
    return plain(valueIn(model.shown.values, this.props.path));
  }

  get unit() {
    return this.props.widget.unit || unitOfPath(this.props.path);
  }
}

const SMALL = 0.1; // of which two decimals would show too little
const NARROW = 0.48; // of a digit's width: a point or a sign
const UNIT_SIZE = 0.6; // of a digit's width: a letter of the unit

// The text of a number whose digits stay where they are: with as many decimals as its values so far need.
class SteadyNumber {
  #isWhole = true;
  #largest = 0;
  #width = 1;

  text(value, decimals) {
    if (typeof value !== "number") return valueText(value);
    this.#isWhole &&= Number.isInteger(value);
    if (Number.isFinite(value)) this.#largest = Math.max(this.#largest, Math.abs(value));
    const text = numberText(value, decimals ?? (this.#isWhole ? 0 : this.#largest < SMALL ? 4 : 2));
    const digits = text.replace(/\D/g, "").length;
    this.#width = Math.max(this.#width, digits + NARROW * (text.length - digits));
    return text;
  }

  // The space that the number keeps: that of its longest text until now, in digits.
  get width() {
    return this.#width;
  }
}

export class NumberText extends ValueWidget {
  steady = new SteadyNumber();

  render({ widget }) {
    const text = this.steady.text(this.value, widget.decimals);
    const { unit } = this;
    const { width } = this.steady;
    const whole = Math.max(width, typeof this.value === "number" ? 0 : text.length) + unit.length * UNIT_SIZE;
    return html`<div class="big-number" style=${{ "--width": whole, "--digits": width }}><b>${text}</b>${unit && html`<small>${unit}</small>`}</div>`;
  }
}

export class Text extends ValueWidget {
  render() {
    const text = valueText(this.value);
    return html`<div class="big-text centered" style=${{ "--letters": Math.min(Math.max(text.length, 6), 24) }}>${text}</div>`;
  }
}

export class InputBox extends ValueWidget {
  render({ path, title }) {
    const { value } = this;
    if (typeof value === "boolean") return html`<${SwitchWidget} ...${this.props} />`;
    return html`<div class="input-widget centered"><${ValueBox} class=${typeof value === "number" ? "number" : ""} path=${path} label=${title} /></div>`;
  }
}

export class Lamp extends ValueWidget {
  render({ title }) {
    const on = Boolean(this.value);
    return html`<div class=${on ? "lamp-widget on" : "lamp-widget"} role="img" aria-label=${`${title}: ${on}`}>${String(on)}</div>`;
  }
}

export class SwitchWidget extends ValueWidget {
  render({ path, title }) {
    return html`<div class="switch-widget centered"><${Switch} label=${title} on=${Boolean(this.value)} disabled=${!model.mayWrite} set=${(on) => write({ [path]: on })} /></div>`;
  }
}

const TURN = Math.PI; // from the left end over the top to the right end

export class Gauge extends ValueWidget {
  steady = new SteadyNumber();

  render({ widget, title }) {
    const { min = 0, max = 1 } = widget;
    const value = typeof this.value === "number" ? this.value : NaN;
    const share = Math.min(Math.max((value - min) / (max - min || 1), 0), 1);
    const zero = Math.min(Math.max(-min / (max - min || 1), 0), 1);
    const text = this.steady.text(this.value, widget.decimals);
    const isOutside = value < min || value > max;
    return html`<svg class="gauge" viewBox="0 0 120 76" role="img" aria-label=${`${title}: ${text} ${this.unit}`}>
      <path class="gauge-track" d=${arcOf(0, 1)} />
      ${Number.isFinite(share) && html`<path class=${isOutside ? "gauge-value outside" : "gauge-value"} d=${arcOf(Math.min(zero, share), Math.max(zero, share))} />`}
      <text class="gauge-number" x="60" y="58" text-anchor="middle">${text}</text>
      <text class="gauge-unit" x="60" y="70" text-anchor="middle">${this.unit}</text>
      <text class="gauge-limit" x="14" y="74" text-anchor="middle">${valueText(min)}</text>
      <text class="gauge-limit" x="106" y="74" text-anchor="middle">${valueText(max)}</text>
    </svg>`;
  }
}

// The part of the gauge's arc between two shares of it.
function arcOf(from, to) {
  const [x1, y1] = onArc(from);
  const [x2, y2] = onArc(to);
  return `M${x1} ${y1}A46 46 0 0 1 ${x2} ${y2}`;
}

function onArc(share) {
  const angle = TURN * (1 - share);
  return [60 + 46 * Math.cos(angle), 62 - 46 * Math.sin(angle)].map((each) => each.toFixed(2));
}
