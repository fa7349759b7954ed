// Boxes, lists and switches that panels share.
import { addToPlot } from "#js/plotting.js";
import { Component, Icon, createRef, html } from "#js/view.js";

// A box for text that shows a changing value, but leaves what a person types alone. Enter leaves the box, and takes it over.
export class TextBox extends Component {
  element = createRef();

  componentDidMount() {
    this.element.current.value = this.props.text;
  }

  componentDidUpdate() {
    if (document.activeElement !== this.element.current) this.element.current.value = this.props.text;
  }

  key = (event) => {
    event.stopPropagation();
    if (event.key === "Enter") this.element.current.blur();
  };

  render({ text: _, set, ...attributes }) {
    return html`<input type="text" ref=${this.element} spellcheck="false" onKeyDown=${this.key} onChange=${(event) => set(event.target.value)} ...${attributes} />`;
  }
}

export function SearchBox({ label, text, search }) {
  return html`<label class="search flex"><${Icon} name="search" /><input type="search" placeholder=${label} value=${text} aria-label=${label}
    onInput=${(event) => search(event.target.value)} /></label>`;
}

// A list to choose from. options: values, or [value, text]
export function Select({ value, options, set, ...attributes }) {
  return html`<select value=${value} onChange=${(event) => set(event.target.value)} ...${attributes}>
    ${options.map((option) => {
      const [each, text] = Array.isArray(option) ? option : [option, option];
      return html`<option key=${each} value=${each} selected=${each === value}>${text}</option>`;
    })}
  </select>`;
}

// on: whether it is on; undefined where `elementRef` sets that
export function Switch({ label, on = undefined, disabled, set, elementRef = undefined, className = undefined }) {
  return html`<label class="switch"><input type="checkbox" role="switch" class=${className} ref=${elementRef} aria-label=${label} checked=${on} disabled=${disabled}
    onChange=${(event) => set(event.target.checked)} /><i></i></label>`;
}

// The button beside a value that plots it.
export function PlotButton({ name, paths, title = "Plot this value" }) {
  return html`<button class="tool to-plot" title=${title} aria-label=${`Plot ${name}`} onClick=${() => paths.forEach((path) => addToPlot(path))}><${Icon} name="plus" /></button>`;
}
