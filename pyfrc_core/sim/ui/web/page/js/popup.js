// Lists and boxes of settings that open beside a button, above everything else on the page. The browser closes them by
// Escape and by a click elsewhere, and gives the keyboard back.
import { Component, Icon, classes, createRef, html } from "#js/view.js";

const GAP = 5; // pixels between the button and its list
let count = 0;

// Place an open popover below an anchor, or above it where there is more space.
function placeBeside(popup, anchor) {
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

// A button with `popovertarget=${this.id}`, and beside it an element with the attributes `list`, whose content is rendered
// while it is open.
export class Popup extends Component {
  state = { open: false };
  id = `popup${count++}`;
  element = createRef(); // has both

  get list() {
    return { id: this.id, popover: "auto", onBeforeToggle: this.begin, onToggle: this.end };
  }

  get popover() {
    return this.element.current.querySelector("[popover]");
  }

  begin = (event) => event.newState === "open" && this.setState({ open: true });

  // When it is closed, and not before: the browser has given the keyboard back then.
  end = (event) => event.newState === "closed" && this.setState({ open: false });

  // Its size is known when the browser shows it, before it is painted, and changes with its content.
  #sizes = new ResizeObserver(() => this.#place());
  #isPlaced = false;

  componentDidMount() {
    this.#sizes.observe(this.popover);
  }

  componentWillUnmount() {
    this.#sizes.disconnect();
  }

  #place() {
    const isNew = !this.#isPlaced;
    this.#isPlaced = this.popover.matches(":popover-open");
    if (!this.#isPlaced) return;
    placeBeside(this.popover, this.element.current);
    if (isNew) this.opened(this.popover);
  }

  // Called once each time.
  opened(_list) {}

  close = () => this.popover.hidePopover();

  // Do something that a person has chosen.
  choose(act) {
    this.close();
    act();
  }

  // Arrow keys move among the elements that a selector finds.
  key(event, selector) {
    const items = [...this.element.current.querySelectorAll(selector)];
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!this.state.open || !by) return;
    items[(items.indexOf(document.activeElement) + by + items.length) % items.length]?.focus();
    event.preventDefault();
    event.stopPropagation();
  }
}

// A button that opens a list of actions.
export class Menu extends Popup {
  render({ label, title, items, icon, disabled }, { open }) {
    return html`<div class="menu" ref=${this.element} onKeyDown=${(event) => this.key(event, ".menu-list button:not(:disabled)")}>
      <button class="quiet" aria-haspopup="menu" aria-expanded=${open} title=${title} disabled=${disabled} popovertarget=${this.id}>
        ${icon && html`<${Icon} name=${icon} />`}<span>${label}</span><i class="caret"></i></button>
      <ul class="menu-list" role="menu" ...${this.list}>
        ${open && items.map((item, index) => item.separator
          ? html`<li key=${index} class="menu-separator" role="separator"></li>`
          : html`<li key=${index} role="none"><button role=${item.checked === undefined ? "menuitem" : "menuitemcheckbox"}
              aria-checked=${item.checked} disabled=${item.disabled} onClick=${() => this.choose(item.act)}>
              <i class=${classes({ tick: true, on: item.checked })}></i><span>${item.text}</span>
              ${item.note && html`<small>${item.note}</small>`}</button></li>`)}
      </ul>
    </div>`;
  }
}

// A button with a box of settings below it. `content` returns what the box shows, and is given a function that closes it.
export class Dropdown extends Popup {
  opened(box) {
    box.querySelector("select, input, button").focus();
  }

  render({ label, title, name, className = "quiet", content }, { open }) {
    return html`<div class="menu dropdown" ref=${this.element}>
      <button class=${className} aria-expanded=${open} aria-label=${name} title=${title} popovertarget=${this.id}>${label}</button>
      <div class="menu-list" ...${this.list}>
        ${open && html`<div class="settings-box" role="group" aria-label=${title}>${content(this.close)}</div>`}</div>
    </div>`;
  }
}
