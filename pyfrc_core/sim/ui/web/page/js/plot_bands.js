// Booleans and texts over time, as bands below a plot.
import { font, sizeCanvas } from "#js/canvas.js";
import { valueText } from "#js/format.js";
import { nameOf } from "#js/names.js";
import { indexAfter } from "#js/times.js";
import { strokeOf } from "#js/curves.js";
import { color } from "#js/settings.js";

const GAP = 3; // pixels between bands

export function drawBands(canvas, bands, { width, inside, band, range: [from, to], now, past }) {
  const height = bands.length * (band + GAP) + GAP;
  const context = sizeCanvas(canvas, width, height);
  const x = (t) => inside.left + ((t - from) / (to - from)) * inside.width;
  context.textBaseline = "middle";
  context.font = font(11);
  bands.forEach((one, index) => {
    const top = GAP + index * (band + GAP);
    context.save();
    context.beginPath();
    context.roundRect(inside.left, top, inside.width, band, 4);
    context.fillStyle = color("track");
    context.fill();
    context.clip();
    drawBand(context, one, top, band, x, from, Math.min(to, now));
    context.restore();
  });
  if (past !== undefined && past >= from && past <= to) {
    context.fillStyle = color("past");
    context.fillRect(x(past) - 0.75, 0, 1.5, height);
  }
}

function drawBand(context, { series, color: number, path }, top, height, x, from, to) {
  const { t, v } = series;
  const seen = new Map();
  for (let index = Math.max(indexAfter(t, from) - 1, 0); index < t.length && t[index] <= to; index++) {
    const left = Math.max(x(t[index]), x(from));
    const right = Math.min(index + 1 < t.length ? x(t[index + 1]) : x(to), x(to));
    const value = v[index];
    if (value === false || value === null) continue;
    if (!seen.has(value)) seen.set(value, seen.size);
    context.globalAlpha = value === true ? 0.75 : 0.35 + 0.35 * (seen.get(value) % 2);
    context.fillStyle = strokeOf({ color: number });
    context.fillRect(left, top, Math.max(right - left - (value === true ? 0 : 1), 1), height);
    context.globalAlpha = 1;
    const text = value === true ? "" : valueText(value);
    if (text && context.measureText(text).width < right - left - 8) {
      context.fillStyle = color("text");
      context.textAlign = "left";
      context.fillText(text, left + 5, top + height / 2);
    }
  }
  if (series.kind !== "boolean") return;
  context.fillStyle = color("text");
  context.textAlign = "left";
  context.fillText(nameOf(path), x(from) + 6, top + height / 2);
}
