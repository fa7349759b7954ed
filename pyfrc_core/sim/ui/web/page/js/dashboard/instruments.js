// Widgets that are instruments: a slider, a gyro, a power distribution, colours.
import { valuesIn } from "#js/dashboard/topics.js";
import { ValueWidget } from "#js/dashboard/value_widgets.js";
import { colorsIn, numberIn, numberText, stepDecimals, valueText, wrapped } from "#js/format.js";
import { model } from "#js/model.js";
import { unitOfPath } from "#js/names.js";
import { Meter, Slider, Toggle } from "#js/panels/device_row.js";
import { conversion } from "#js/units.js";
import { html } from "#js/view.js";

// Sets a number, in steps that the settings say, or of about a hundredth of its range.
export function SliderWidget({ path, widget, title }) {
  const { min: low = 0, max: high = 1, step } = widget;
  const decimals = model.types[path] === "int" ? 0 : (widget.decimals ?? (step ? EXACT : stepDecimals(high - low)));
  const row = { paths: [path], low, high, step, decimals, unit: widget.unit || unitOfPath(path) };
  return html`<div class="slider-widget centered"><${Slider} key=${path} row=${row} label=${title} /></div>`;
}

const EXACT = 8; // decimals, which leave a step as it is, but not the errors of binary numbers

// The angle of a gyro, or of a number in degrees or radians. 0 is at the top.
export function GyroWidget(props) {
  const [angle] = valuesIn(props.path, ["Value"]);
  return html`<${Dial} ...${props} path=${angle ?? props.path} />`;
}

const MARKS = [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330];

class Dial extends ValueWidget {
  render({ widget, title }) {
    const value = numberIn(this.value);
    const degrees = value === null ? null : wrapped(conversion(this.unit, "°")?.(value) ?? value);
    const text = degrees === null ? valueText(this.value) : `${numberText(degrees, 1)}°`;
    const way = widget.counterclockwise ? -1 : 1; // on the screen, angles are clockwise
    return html`<svg class="dial" viewBox="-6 0 132 120" role="img" aria-label=${`${title}: ${text}`}>
      <circle cx="60" cy="60" r="44" />
      ${MARKS.map((mark) => html`<path key=${mark} class="dial-mark" d=${mark % 90 ? "M60 16v4" : "M60 16v8"} transform=${`rotate(${mark} 60 60)`} />`)}
      <text x="60" y="11">0</text><text x="114" y="63">${90 * way}</text><text x="60" y="118">180</text><text x="6" y="63">${-90 * way}</text>
      ${degrees !== null && html`<path class="dial-needle" d="M60 20l7 14h-14z" transform=${`rotate(${way * degrees} 60 60)`} />`}
      <text class="gauge-number" x="60" y="66">${text}</text>
    </svg>`;
  }
}

const CHANNELS = Array.from({ length: 24 }, (_, channel) => `Chan${channel}`);
const METERS = [
  ["Voltage", "Voltage", 14, "V"],
  ["TotalCurrent", "Total", 200, "A"],
  ...CHANNELS.map((name, channel) => [name, String(channel), 40, "A"]), // no channel has a larger breaker
];

export function PowerWidget({ path }) {
  const [switchable] = valuesIn(path, ["SwitchableChannel"]);
  return html`<div class="power scroll" tabindex="0">
    ${METERS.filter(([name]) => valuesIn(path, [name]).length).map(([name, label, high, unit]) => html`<div class="row flex" key=${`${path} ${name}`}>
      <span class="row-label">${label}</span><${Meter} row=${{ paths: [`${path}/${name}`], low: 0, high, decimals: 1, unit }} /></div>`)}
    ${switchable && html`<div class="row flex" key=${switchable}><span class="row-label">Switchable</span><${Toggle} row=${{ paths: [switchable] }} label="Switchable channel" /></div>`}
  </div>`;
}

// A colour as "#RRGGBB", or several, side by side.
export class ColorWidget extends ValueWidget {
  render({ title }) {
    const colors = colorsIn(this.value);
    const text = valueText(this.value);
    if (!colors.length) return html`<p class="missing"><span>No colour: <code>${text}</code></span></p>`;
    const background = colors.length === 1 ? colors[0] : `linear-gradient(to right, ${colors.join(", ")})`;
    return html`<div class="color-widget" role="img" aria-label=${`${title}: ${text}`} title=${text} style=${{ background }}></div>`;
  }
}
