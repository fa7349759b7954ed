// Canvases with sharp lines on dense screens.
import { color } from "./settings.js";

// The font of texts in canvases, in pixels of an ordinary screen: larger on huge ones, like all texts of the page.
export function font(pixels, style = "") {
  const scale = parseFloat(getComputedStyle(document.documentElement).fontSize) / 13;
  return `${style}${pixels * scale}px ${color("font")}`;
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
