// A box for text that shows a changing value, but leaves what a person types alone.
import { Component, Icon, createRef, html } from "#js/view.js";

export class TextBox extends Component {
  element = createRef();

  componentDidMount() {
    this.element.current.value = this.props.text;
  }

  componentDidUpdate() {
    if (document.activeElement !== this.element.current) this.element.current.value = this.props.text;
  }

  render({ text: _, ...attributes }) {
    return html`<input type="text" ref=${this.element} ...${attributes} />`;
  }
}

export function SearchBox({ label, text, search }) {
  return html`<label class="search"><${Icon} name="search" /><input type="search" placeholder=${label} value=${text} aria-label=${label}
    onInput=${(event) => search(event.target.value)} /></label>`;
}
