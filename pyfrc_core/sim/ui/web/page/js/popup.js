// Lists and boxes of settings that open beside a button, above everything else on the page.
import { Component, Icon, classes, createRef, html } from "#js/view.js";

const GAP = 5; // pixels between the button and its list

// Show an element with popover="manual" below an anchor, or above it where there is more space.
function showBeside(popup, anchor) {
  if (!popup.matches(":popover-open")) popup.showPopover();
  const box = anchor.getBoundingClientRect();
  const { width } = popup.getBoundingClientRect();
  const below = innerHeight - box.bottom - 2 * GAP;
  const above = box.top - 2 * GAP;
  const up = below < Math.min(popup.scrollHeight, 320) && above > below;
  popup.style.maxHeight = `${up ? above : below}px`;
  popup.style.left = `${Math.max(Math.min(box.right - width, innerWidth - width - GAP), GAP)}px`;
  popup.style.top = up ? "auto" : `${box.bottom + GAP}px`;
  popup.style.bottom = up ? `${innerHeight - box.top + GAP}px` : "auto";
}

// A button, and a `.menu-list` that is rendered while it is open. A click elsewhere closes it.
export class Popup extends Component {
  state = { open: false };
  element = createRef();

  componentDidMount() {
    document.addEventListener("pointerdown", this.outside);
  }

  componentWillUnmount() {
    document.removeEventListener("pointerdown", this.outside);
  }

  // `opened` is called once each time.
  componentDidUpdate(_, before) {
    if (!this.state.open) return;
    const list = this.element.current.querySelector(".menu-list");
    showBeside(list, this.element.current);
    if (!before.open) this.opened(list);
  }

  opened(_list) {}

  toggle = () => this.setState({ open: !this.state.open });

  close = () => this.setState({ open: false });

  outside = (event) => {
    if (this.state.open && !this.element.current.contains(event.target)) this.close();
  };
}

// A button that opens a list of actions; arrow keys move in it.
export class Menu extends Popup {
  render({ label, title, items, icon, disabled }, { open }) {
    return html`<div class="menu" ref=${this.element} onKeyDown=${this.key}>
      <button class="quiet" aria-haspopup="menu" aria-expanded=${open} title=${title} disabled=${disabled} onClick=${this.toggle}>
        ${icon && html`<${Icon} name=${icon} />`}<span>${label}</span><i class="caret"></i></button>
      ${open && html`<ul class="menu-list" popover="manual" role="menu">
        ${items.map((item, index) => item.separator
          ? html`<li key=${index} class="menu-separator" role="separator"></li>`
          : html`<li key=${index} role="none"><button role=${item.checked === undefined ? "menuitem" : "menuitemcheckbox"}
              aria-checked=${item.checked} disabled=${item.disabled} onClick=${() => this.act(item)}>
              <i class=${classes({ tick: true, on: item.checked })}></i><span>${item.text}</span>
              ${item.note && html`<small>${item.note}</small>`}</button></li>`)}
      </ul>`}
    </div>`;
  }

  act(item) {
    this.close();
    item.act();
  }

  key = (event) => {
    if (!this.state.open) return;
    const buttons = [...this.element.current.querySelectorAll(".menu-list button:not(:disabled)")];
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (event.key === "Escape") {
      this.close();
      this.element.current.querySelector("button").focus();
    } else if (by) buttons[(buttons.indexOf(document.activeElement) + by + buttons.length) % buttons.length]?.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
}

// A button with a box of settings below it.
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
