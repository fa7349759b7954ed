// A box for text that shows a changing value, but leaves what a person types alone.
import { Component, createRef, html } from "#js/view.js";

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
