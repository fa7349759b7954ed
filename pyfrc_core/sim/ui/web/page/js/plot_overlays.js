// What is drawn over the curves of a plot: times without values, and the moment that is shown.
import { strokeOf } from "#js/curves.js";
import { hatch } from "#js/gaps.js";
import { model } from "#js/model.js";
import { color } from "#js/settings.js";

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

// Where curves over another one are at the moment that is shown: pointOf(line) returns x and y, null where it has none.
export function drawPoints(plot, lines, pointOf) {
  const { left, top, width, height } = plot.bbox;
  for (const line of lines.filter((each) => !each.hidden)) {
    const [x, y] = pointOf(line);
    if (x === null || y === null) continue;
    const place = [plot.valToPos(x, "x", true), plot.valToPos(y, line.axis, true)];
    if (place[0] < left || place[0] > left + width || place[1] < top || place[1] > top + height) continue;
    plot.ctx.fillStyle = strokeOf(line);
    plot.ctx.beginPath();
    plot.ctx.arc(...place, 4.5 * devicePixelRatio, 0, 2 * Math.PI);
    plot.ctx.fill();
  }
}
