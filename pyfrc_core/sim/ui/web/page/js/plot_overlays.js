// What is drawn beside and over the curves of plots: booleans and texts as bands below them, times without values, and the
// moment that is shown.
import { font, sizeCanvas } from "#js/canvas.js";
import { valueText } from "#js/format.js";
import { nameOf } from "#js/names.js";
import { indexAfter } from "#js/times.js";
import { strokeOf } from "#js/curves.js";
import { color } from "#js/settings.js";
import { model } from "#js/model.js";
import { hatch } from "#js/gaps.js";

const GAP = 3; // pixels between bands
const FAINT = 0.55; // how much weaker the bands of the branch are
const CAPTION = 15; // pixels of height for the name of the branch

// bands: curves with their `series`; those of the compared branch, below the run's, with its name as `other`, which is
// written above them all: in a band it would cover its states
export function drawBands(canvas, bands, { width, inside, band, range: [from, to], now, past }) {
  const other = bands.find((one) => one.other !== undefined)?.other;
  const begin = other === undefined ? GAP : GAP + CAPTION;
  const height = begin + bands.length * (band + GAP);
  const context = sizeCanvas(canvas, width, height);
  const x = (t) => inside.left + ((t - from) / (to - from)) * inside.width;
  context.textBaseline = "middle";
  context.font = font(11);
  if (other !== undefined) write(context, `The paler bands are from ${other}`, inside.left + 6, GAP + CAPTION / 2, inside.width - 12);
  let seen = new Map(); // value: its number; a state looks the same in both
  bands.forEach((one, index) => {
    const top = begin + index * (band + GAP);
    context.save();
    context.beginPath();
    context.roundRect(inside.left, top, inside.width, band, 4);
    context.fillStyle = color("track");
    context.fill();
    context.clip();
    if (one.other === undefined) seen = new Map();
    drawBand(context, one, top, band, x, [from, Math.min(to, one.series.until ?? now)], seen);
    context.restore();
  });
  if (past !== undefined && past >= from && past <= to) {
    context.fillStyle = color("past");
    context.fillRect(x(past) - 0.75, 0, 1.5, height);
  }
}

function drawBand(context, { series, color: number, path, kind, other }, top, height, x, [from, to], seen) {
  const { t, v } = series;
  const strength = other === undefined ? 1 : FAINT;
  for (let index = Math.max(indexAfter(t, from) - 1, 0); index < t.length && t[index] <= to; index++) {
    const left = Math.max(x(t[index]), x(from));
    const end = Math.min(index + 1 < t.length ? x(t[index + 1]) : x(to), x(to));
    const value = v[index];
    if (value === false || value === null) continue;
    if (!seen.has(value)) seen.set(value, seen.size);
    context.globalAlpha = strength * (value === true ? 0.75 : 0.35 + 0.35 * (seen.get(value) % 2));
    context.fillStyle = strokeOf({ color: number });
    context.fillRect(left, top, Math.max(end - left - (value === true ? 0 : 1), 1), height);
    context.globalAlpha = 1;
    const text = value === true ? "" : valueText(value);
    if (text && context.measureText(text).width < end - left - 8) write(context, text, left + 5, top + height / 2);
  }
  if (kind === "boolean") write(context, nameOf(path), x(from) + 6, top + height / 2);
}

function write(context, text, left, middle, most = undefined) {
  context.fillStyle = color("text");
  context.textAlign = "left";
  context.fillText(text, left, middle, most);
}

export function drawGaps(plot, gaps) {
  const { left, top, width, height } = plot.bbox;
  for (const gap of gaps) {
    const [from, to] = gap.map((t) => Math.min(Math.max(plot.valToPos(t, "x", true), left), left + width));
    if (to > from) hatch(plot.ctx, from, top, to - from, height, devicePixelRatio);
  }
}

export function drawMoment(plot) {
  if (!model.past) return;
  const x = plot.valToPos(model.past.t, "x", true);
  const { left, top, width, height } = plot.bbox;
  if (x < left || x > left + width) return;
  plot.ctx.fillStyle = color("past");
  plot.ctx.fillRect(x - devicePixelRatio / 2, top, Math.max(devicePixelRatio, 1.5), height);
}
