// One row of the devices: its label, its value drawn by kind, and for inputs the control that sets it.
import { write } from "#js/connection.js";
import { PlotButton, Switch } from "#js/controls.js";
import { numberText, plain, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { carryPath } from "#js/plotting.js";
import { ValueBox } from "#js/value_box.js";
import { Component, Icon, classes, createRef, html } from "#js/view.js";

export class DeviceRow extends Component {
  shouldComponentUpdate(next) {
    return next.pinned !== this.props.pinned || JSON.stringify(next.row) !== JSON.stringify(this.props.row);
  }

  render({ row, pinned, pin, named }) {
    if (row.isHeading) return html`<h4 class="device-heading" title=${row.tooltip}>${row.label}</h4>`;
    const path = row.paths[0];
    const Kind = KINDS[row.kind] ?? KINDS.text;
    const label = row.label.trim();
    const name = named && row.heading ? `${row.heading} ${label}` : label;
    return html`<div class=${classes({ row: true, flex: true, [`kind-${row.kind}`]: true, indented: row.label.startsWith(" ") && !named })}
        title=${row.tooltip} draggable="true" onDragStart=${(event) => carryPath(event, path)} data-path=${path}>
      <span class="row-label">${name}</span>
      <${Kind} row=${row} label=${name} />
      <span class="row-tools">
        <${PlotButton} name=${name} paths=${row.paths} />
        <button class=${classes({ tool: true, on: pinned })} title=${pinned ? "Unpin" : "Pin to the top"} aria-label=${`Pin ${name}`}
          aria-pressed=${pinned} onClick=${pin}><${Icon} name="pin" /></button>
      </span>
    </div>`;
  }
}

// A part of a row that draws a path's value in `paint(value)` whenever it changes.
export class Painted extends Component {
  element = createRef();
  name = ""; // the class of an element that has nothing in it at first

  paint(_value, _index) {}

  componentDidMount() {
    this.unbind = this.props.row.paths.map((path, index) => model.bind(path, (value) => this.paint(plain(value), index)));
  }

  componentWillUnmount() {
    this.unbind.forEach((end) => end());
  }

  componentDidUpdate() {
    this.props.row.paths.forEach((path, index) => this.paint(plain(model.shown.values.get(path)), index));
  }

  render() {
    return html`<span class=${this.name} ref=${this.element}></span>`;
  }
}

export class Meter extends Painted {
  paint(value) {
    const { low, high } = this.props.row;
    const [bar, text] = this.element.current.children;
    const zero = low < 0 ? -low / (high - low) : 0;
    const at = Math.min(Math.max(((value ?? 0) - low) / (high - low), 0), 1);
    const fill = bar.firstChild;
    fill.style.left = `${Math.min(zero, at) * 100}%`;
    fill.style.width = `${Math.abs(at - zero) * 100}%`;
    fill.classList.toggle("backwards", at < zero);
    text.textContent = typeof value === "number" ? numberText(value, this.props.row.decimals) : valueText(value);
  }

  render({ row }) {
    return html`<span class="meter flex" ref=${this.element}>
      <span class=${row.low < 0 ? "bar centered" : "bar"}><i></i></span><span class="number"></span><span class="unit">${row.unit}</span></span>`;
  }
}

class Lamp extends Painted {
  paint(value) {
    this.element.current.classList.toggle("on", Boolean(value));
    this.element.current.lastChild.textContent = value ? "on" : "off";
  }

  render() {
    return html`<span class="lamp-value" ref=${this.element}><i class="lamp"></i><span></span></span>`;
  }
}

class Lamps extends Painted {
  paint(value, index) {
    this.element.current.children[index]?.classList.toggle("on", Boolean(value));
  }

  render({ row }) {
    return html`<span class="lamps" ref=${this.element}>${row.paths.map((path, index) => html`<i key=${path} class="lamp" title=${String(index)}></i>`)}</span>`;
  }
}

class Relay extends Painted {
  name = "word";
  states = [false, false];

  paint(value, index) {
    this.states[index] = Boolean(value);
    const [forwards, backwards] = this.states;
    const text = forwards && backwards ? "on" : forwards ? "forward" : backwards ? "reverse" : "off";
    this.element.current.textContent = text;
    this.element.current.classList.toggle("on", forwards || backwards);
  }
}

// Call a function with each item of a list, and the style of its element.
function paintEach(element, value, paint) {
  const list = Array.isArray(value) ? value : [];
  while (element.children.length < list.length) element.append(document.createElement("i"));
  while (element.children.length > list.length) element.lastChild.remove();
  list.forEach((each, index) => paint(each, element.children[index].style));
}

class Bars extends Painted {
  name = "bars";

  paint(value) {
    const { high } = this.props.row;
    paintEach(this.element.current, value, (each, style) => {
      style.height = `${Math.min(Math.max(each / high, 0), 1) * 100}%`;
    });
  }
}

class Leds extends Painted {
  name = "leds";

  paint(value) {
    paintEach(this.element.current, value, (each, style) => {
      const { r = 0, g = 0, b = 0 } = Array.isArray(each) ? { r: each[0], g: each[1], b: each[2] } : (each ?? {});
      style.background = `rgb(${Number(r)}, ${Number(g)}, ${Number(b)})`;
    });
  }
}

class Text extends Painted {
  name = "text-value";

  paint(value) {
    this.element.current.textContent = this.element.current.title = valueText(value);
  }
}

export class Toggle extends Painted {
  paint(value) {
    this.element.current.checked = Boolean(value);
  }

  render({ row, label }) {
    return html`<${Switch} elementRef=${this.element} label=${label} disabled=${!model.mayWrite} set=${(on) => write({ [row.paths[0]]: on })} />`;
  }
}

function NumberBox({ row, label }) {
  return html`<span class="number-box"><${ValueBox} class="number" inputmode="decimal" path=${row.paths[0]} label=${label} /><span class="unit">${row.unit}</span></span>`;
}

// row: { paths, low, high, decimals, unit, step: any without it }
export class Slider extends Painted {
  paint(value) {
    const slider = this.element.current.firstElementChild;
    if (!this.dragging) slider.value = String(value ?? 0);
    const { low, high } = this.props.row;
    slider.style.setProperty("--filled", `${((Number(slider.value) - low) / (high - low)) * 100}%`);
  }

  render({ row, label }) {
    return html`<span class="slider flex" ref=${this.element}>
      <input type="range" min=${row.low} max=${row.high} step=${row.step ?? "any"} aria-label=${label} disabled=${!model.mayWrite}
        onPointerDown=${() => (this.dragging = true)} onPointerUp=${() => (this.dragging = false)} onInput=${this.slide} />
      <${ValueBox} class="number" inputmode="decimal" path=${row.paths[0]} label=${`${label}, as a number`} />
      <span class="unit">${row.unit}</span></span>`;
  }

  slide = (event) => {
    const { row } = this.props;
    write({ [row.paths[0]]: Number(Number(event.target.value).toFixed(row.decimals)) });
  };
}

const KINDS = {
  meter: Meter, lamp: Lamp, lamps: Lamps, relay: Relay, bars: Bars, leds: Leds, text: Text,
  switch: Toggle, slider: Slider, number: NumberBox,
};
