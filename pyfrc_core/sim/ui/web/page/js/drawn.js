// What is drawn on a canvas that fills the element around it.
import { ElementSize, Picture, sizeCanvas } from "#js/canvas.js";
import { Live, createRef } from "#js/view.js";

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
