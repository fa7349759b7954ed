// A button with a box of settings below it. Escape or a click elsewhere closes it.
import { showBeside } from "#js/popup.js";
import { Component, createRef, html } from "#js/view.js";

export class Dropdown extends Component {
  state = { open: false };
  element = createRef();

  componentDidMount() {
    document.addEventListener("pointerdown", this.outside);
    document.addEventListener("keydown", this.key); // a list that was chosen from gives the keyboard back to driving
  }

  componentWillUnmount() {
    document.removeEventListener("pointerdown", this.outside);
    document.removeEventListener("keydown", this.key);
  }

  componentDidUpdate(_, before) {
    if (!this.state.open) return;
    const box = this.element.current.querySelector(".menu-list");
    showBeside(box, this.element.current);
    if (!before.open) box.querySelector("select, input, button").focus();
  }

  outside = (event) => {
    if (this.state.open && !this.element.current.contains(event.target)) this.setState({ open: false });
  };

  // `content` returns what the box shows, and is given a function that closes it.
  render({ label, title, name, className = "quiet", content }, { open }) {
    return html`<div class="menu dropdown" ref=${this.element}>
      <button class=${className} aria-expanded=${open} aria-label=${name} title=${title} onClick=${() => this.setState({ open: !open })}>${label}</button>
      ${open && html`<div class="menu-list settings-box" popover="manual" role="group" aria-label=${title}>${content(() => this.setState({ open: false }))}</div>`}
    </div>`;
  }

  key = (event) => {
    if (!this.state.open || event.key !== "Escape") return;
    event.preventDefault();
    this.setState({ open: false });
    this.element.current.querySelector("button").focus();
  };
}
