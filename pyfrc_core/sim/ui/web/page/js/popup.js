// Lists that open beside a button, above everything else on the page.
import { Component, createRef } from "#js/view.js";

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
