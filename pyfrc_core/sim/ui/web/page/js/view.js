// What every panel is made of: `html` templates, and components that render again when the model changes.
import { Component, h } from "#vendor/preact/preact.mjs";
import htm from "#vendor/htm/htm.mjs";
import { model } from "#js/model.js";

export { Component };
export { render, createRef } from "#vendor/preact/preact.mjs";

// html`<b>${text}</b>`: values become text or attributes, never markup.
export const html = htm.bind(h);

// A component that renders again when one of these parts of the model has changed: `parts = ["station", "status"]`.
export class Live extends Component {
  parts = [];
  interval = 0; // milliseconds between two renderings at least, for what changes faster than anyone can read
  #renderedAt = 0;
  #timer = null;

  componentDidMount() {
    this.stopListening = model.listen((changed) => {
      if (this.parts.some((part) => changed.has(part))) this.#renderSoon();
    });
  }

  componentWillUnmount() {
    model.need(this, []);
    this.stopListening();
    clearTimeout(this.#timer);
  }

  #renderSoon() {
    if (this.#timer !== null) return;
    const wait = this.interval && this.#renderedAt + this.interval - performance.now();
    if (wait <= 0) this.#renderNow();
    else this.#timer = setTimeout(() => this.#renderNow(), wait);
  }

  #renderNow() {
    this.#timer = null;
    this.#renderedAt = performance.now();
    this.setState({});
  }
}

// A component that shows one value, by its path, and paints it whenever it changes.
export class Bound extends Component {
  componentDidMount() {
    this.follow();
  }

  componentDidUpdate() {
    if (this.boundPath !== this.followed) this.follow();
  }

  componentWillUnmount() {
    this.unbind();
  }

  follow() {
    this.unbind?.();
    this.followed = this.boundPath;
    this.unbind = model.bind(this.followed, (value) => this.paint(value));
  }

  get boundPath() {
    return this.props.path;
  }

  paint(_value) {
    this.setState({});
  }
}

// The names of the classes whose condition is true: classes({ button: true, active: isActive }).
export function classes(conditions) {
  return Object.keys(conditions).filter((name) => conditions[name]).join(" ");
}

// The drawings of the icons, on a square of 16.
const ICONS = {
  layout: "M2 2h12v12H2zM3.5 3.5v9h3v-9zM8 3.5v4h4.5v-4zM8 9v3.5h4.5V9z",
  board: "M2 2h5v5H2zm7 0h5v5H9zM2 9h5v5H2zm8.3 0h2.4v1.3H14v2.4h-1.3V14h-2.4v-1.3H9v-2.4h1.3z",
  panels: "M2 3.5h12v1.7H2zM2 7.2h12v1.7H2zM2 10.8h12v1.7H2z",
  play: "M4.5 2.8v10.4l9-5.2z",
  pause: "M4 2.5h3v11H4zM9 2.5h3v11H9z",
  step: "M3 2.8v10.4L10 8zM11 3h2.2v10H11z",
  stepBack: "M13 2.8v10.4L6 8zM2.8 3H5v10H2.8z",
  first: "M12.5 2.8v10.4L6 8zM3.5 3h2v10h-2z",
  last: "M3.5 2.8v10.4L10 8zM10.5 3h2v10h-2z",
  plus: "M7 2.5h2V7h4.5v2H9v4.5H7V9H2.5V7H7z",
  close: "M4 2.9 8 6.9l4-4L13.1 4 9.1 8l4 4-1.1 1.1-4-4-4 4L2.9 12l4-4-4-4z",
  pin: "M9.8 1.6 14.4 6.2l-1 1-.7-.2-2.6 2.6.1 2.4-1.1 1.1-3-3L2.6 13.6l-.2-.2 3.5-3.5-3-3L4 5.8l2.4.1L9 3.3l-.2-.7z",
  search: "M6.8 2a4.8 4.8 0 1 0 2.9 8.6l3.2 3.2 1-1-3.2-3.2A4.8 4.8 0 0 0 6.8 2m0 1.5a3.3 3.3 0 1 1 0 6.6 3.3 3.3 0 0 1 0-6.6",
  download: "M7.2 2h1.6v6l2.2-2.2 1.1 1.1L8 11 3.9 6.9 5 5.8 7.2 8zM3 12.2h10v1.6H3z",
  sun: "M8 4.8a3.2 3.2 0 1 0 0 6.4 3.2 3.2 0 0 0 0-6.4M7.3 1h1.4v2.2H7.3zm0 11.8h1.4V15H7.3zM1 7.3h2.2v1.4H1zm11.8 0H15v1.4h-2.2zM2.6 3.6l1-1 1.6 1.6-1 1zm8.2 8.2 1-1 1.6 1.6-1 1zM2.6 12.4l1.6-1.6 1 1-1.6 1.6zm8.2-8.2 1.6-1.6 1 1-1.6 1.6z",
  moon: "M6.2 1.8a6.4 6.4 0 1 0 8 8A5.2 5.2 0 0 1 6.2 1.8",
  fit: "M2 2h4.5v1.5h-3v3H2zm7.5 0H14v4.5h-1.5v-3h-3zM2 9.5h1.5v3h3V14H2zm10.5 0H14V14H9.5v-1.5h3z",
  flag: "M3 1.8h1.5v.7c2.8-1.3 4.6 1.3 8 0v6.6c-3.4 1.3-5.2-1.3-8 0v5.1H3z",
  branch: "M4.5 1.5a1.9 1.9 0 0 0-.7 3.6v5.8a1.9 1.9 0 1 0 1.5 0V9.6c.5-.9 1.5-1 2.9-1.1 1.8-.1 3.7-.4 4-3.3a1.9 1.9 0 1 0-1.5 0c-.2 1.6-1.1 1.7-2.6 1.8-1 0-2 .1-2.8.5V5.1a1.9 1.9 0 0 0-.8-3.6",
  undo: "M6.2 2 7.3 3.1 5 5.4h4.5a4 4 0 0 1 0 8H6v-1.6h3.5a2.4 2.4 0 0 0 0-4.8H5l2.3 2.3-1.1 1.1L2 6.2z",
  redo: "M9.8 2 8.7 3.1 11 5.4H6.5a4 4 0 0 0 0 8H10v-1.6H6.5a2.4 2.4 0 0 1 0-4.8H11L8.7 9.3l1.1 1.1L14 6.2z",
  restart: "M8 2.5a5.5 5.5 0 1 0 5.3 7h-1.6A4 4 0 1 1 8 4c1.2 0 2.1.5 2.9 1.2L9 7h4.8V2.2l-1.8 1.9A5.5 5.5 0 0 0 8 2.5",
  warning: "M8 1.6 15 14H1zM7.2 6v4h1.6V6zm0 5.2v1.6h1.6v-1.6z",
  chevron: "M5.5 3 10.5 8l-5 5-1.1-1.1L8.3 8 4.4 4.1z",
  gear: "M6.9 1.5h2.2l.3 1.8 1.1.5 1.5-1.1 1.6 1.6-1.1 1.5.5 1.1 1.8.3v2.2l-1.8.3-.5 1.1 1.1 1.5-1.6 1.6-1.5-1.1-1.1.5-.3 1.8H6.9l-.3-1.8-1.1-.5L4 12.3l-1.6-1.6 1.1-1.5L3 8.1l-1.8-.3V5.6L3 5.3l.5-1.1-1.1-1.5L4 1.1l1.5 1.1 1.1-.5zM8 5.2a2.6 2.6 0 1 0 0 5.2 2.6 2.6 0 0 0 0-5.2",
};

export function Icon({ name }) {
  return html`<svg class="icon" viewBox="0 0 16 16" aria-hidden="true"><path d=${ICONS[name]} fill-rule="evenodd" /></svg>`;
}
