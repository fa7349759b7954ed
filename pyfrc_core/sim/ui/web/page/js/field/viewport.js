// The part of the field that is visible, and its place on the screen. Places are in feet, y downwards on both.

const NEAREST = 24;
const FARTHEST = 0.5;
const MARGIN = 0.035;

export class Viewport {
  zoom = 1;
  turned = false; // half a turn, to see the field from the other alliance

  constructor(field) {
    this.field = field;
    this.center = [field.width / 2, field.height / 2];
    this.width = 1;
    this.height = 1;
  }

  reset() {
    this.zoom = 1;
    this.center = [this.field.width / 2, this.field.height / 2];
  }

  resize(width, height) {
    this.width = Math.max(width, 1);
    this.height = Math.max(height, 1);
  }

  // Pixels per foot.
  get scale() {
    return this.zoom * (1 - 2 * MARGIN) * Math.min(this.width / this.field.width, this.height / this.field.height);
  }

  toScreen([x, y]) {
    const { scale } = this;
    const way = this.turned ? -1 : 1;
    return [way * (x - this.center[0]) * scale + this.width / 2, way * (y - this.center[1]) * scale + this.height / 2];
  }

  toField(pixelX, pixelY) {
    const scale = this.scale * (this.turned ? -1 : 1);
    return [(pixelX - this.width / 2) / scale + this.center[0], (pixelY - this.height / 2) / scale + this.center[1]];
  }

  // Zoom in (a factor above 1) or out; the place at the pixel stays there.
  zoomAt(factor, pixelX, pixelY) {
    const before = this.toField(pixelX, pixelY);
    this.zoom = Math.min(Math.max(this.zoom * factor, FARTHEST), NEAREST);
    const after = this.toField(pixelX, pixelY);
    this.centerAt(this.center[0] + before[0] - after[0], this.center[1] + before[1] - after[1]);
  }

  pan(pixelsX, pixelsY) {
    const scale = this.scale * (this.turned ? -1 : 1);
    this.centerAt(this.center[0] - pixelsX / scale, this.center[1] - pixelsY / scale);
  }

  centerAt(x, y) {
    this.center = [Math.min(Math.max(x, 0), this.field.width), Math.min(Math.max(y, 0), this.field.height)];
  }
}
