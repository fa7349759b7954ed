// A button with a box of settings below it. Escape or a click elsewhere closes it.
import { Popup } from "#js/popup.js";
import { html } from "#js/view.js";

export class Dropdown extends Popup {
  componentDidMount() {
    super.componentDidMount();
    document.addEventListener("keydown", this.key); // a list that was chosen from gives the keyboard back to driving
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    document.removeEventListener("keydown", this.key);
  }

  opened(box) {
    box.querySelector("select, input, button").focus();
  }

  // `content` returns what the box shows, and is given a function that closes it.
  render({ label, title, name, className = "quiet", content }, { open }) {
    return html`<div class="menu dropdown" ref=${this.element}>
      <button class=${className} aria-expanded=${open} aria-label=${name} title=${title} onClick=${this.toggle}>${label}</button>
      ${open && html`<div class="menu-list settings-box" popover="manual" role="group" aria-label=${title}>${content(this.close)}</div>`}
    </div>`;
  }

  key = (event) => {
    if (!this.state.open || event.key !== "Escape") return;
    event.preventDefault();
    this.close();
    this.element.current.querySelector("button").focus();
  };
}
