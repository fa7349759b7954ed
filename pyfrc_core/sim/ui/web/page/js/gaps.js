// Where a robot elsewhere was not connected: nothing is known of that time.
import { color } from "#js/settings.js";

export const NO_CONNECTION = "no connection";

const STEP = 6; // pixels between the lines

// The parts of a series of modes without a connection, as [from, to], until `end`.
export function gapsOf({ t, v }, end) {
  const found = [];
  for (let index = 0; index < t.length; index++) if (v[index] === NO_CONNECTION) found.push([t[index], t[index + 1] ?? end]);
  return found;
}

// Hatch a rectangle of a canvas, whose pixels are `scale` of the page's.
export function hatch(context, left, top, width, height, scale = 1) {
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.fillStyle = color("surface");
  context.fill();
  context.clip();
  context.beginPath();
  for (let x = left - height; x < left + width; x += STEP * scale) {
    context.moveTo(x, top + height);
    context.lineTo(x + height, top);
  }
  context.strokeStyle = color("strong-border");
  context.lineWidth = scale;
  context.stroke();
  context.restore();
}
