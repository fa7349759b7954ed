// Canvases with sharp lines on dense screens.
import { isDark } from "#js/settings.js";
import { Live, createRef } from "#js/view.js";

// An element's size without its borders, in pixels of the page. Asking the element itself in each drawing would have the
// browser lay out the page at once, and again before it paints.
export class ElementSize {
  width = 0;
  height = 0;

  // Call `changed` when the size is known, and after each change.
  constructor(element, changed) {
    this.observer = new ResizeObserver(() => {
      this.width = element.clientWidth;
      this.height = element.clientHeight;
      changed();
    });
    this.observer.observe(element);
  }

  disconnect() {
    this.observer.disconnect();
  }
}

// What a canvas shows. Most updates bring only a later time, for which nothing has to be painted again.
export class Picture {
  #parts = [];

  // Whether a part of what is drawn is another one than at the last call. What changes in its place is given as text.
  changes(...parts) {
    const given = [...parts, isDark(), devicePixelRatio];
    const isOther = given.some((part, index) => part !== this.#parts[index]);
    this.#parts = given;
    return isOther;
  }
}

let texts = null; // the font of the page's texts; asking for it in each drawing would compute styles at once
addEventListener("resize", () => (texts = null));

// The font of texts in canvases, in pixels of an ordinary screen: larger on huge ones, like all texts of the page.
export function font(pixels, style = "") {
  if (!texts) {
    const { fontSize, fontFamily } = getComputedStyle(document.documentElement);
    texts = { scale: parseFloat(fontSize) / 13, family: fontFamily };
  }
  return `${style}${pixels * texts.scale}px ${texts.family}`;
}

// Give a canvas this size in pixels of the page, clear it, and return its context.
export function sizeCanvas(canvas, width, height) {
  const density = devicePixelRatio || 1;
  const pixelsWide = Math.max(Math.round(width * density), 1);
  const pixelsHigh = Math.max(Math.round(height * density), 1);
  if (canvas.width !== pixelsWide || canvas.height !== pixelsHigh) {
    canvas.width = pixelsWide;
    canvas.height = pixelsHigh;
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
  }
  const context = canvas.getContext("2d");
  context.setTransform(density, 0, 0, density, 0, 0);
  context.clearRect(0, 0, width, height);
  return context;
}

// What is drawn on a canvas that fills the element around it.
// Calls `draw`, and thereby `paint`, when its size has changed. `picture` says whether what it shows is something else than before.
export class Drawn extends Live {
  canvas = createRef();
  picture = new Picture();

  componentDidMount() {
    super.componentDidMount();
    this.size = new ElementSize(this.canvas.current.parentElement, () => this.draw());
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    this.size.disconnect();
  }

  draw() {
    const { width, height } = this.size ?? {};
    if (this.canvas.current && width && height) this.paint(sizeCanvas(this.canvas.current, width, height), width, height);
  }

  paint(_context, _width, _height) {}
}
