// Draws the season's structures and lines, as `season` has them: no picture of anyone's.
import { font } from "#js/canvas.js";
import { tracePath } from "#js/field/draw.js";
import { color } from "#js/settings.js";

const LEAST_NAMED = 13; // pixels per foot: on a smaller field, names would cover it
const NEAR_TAG = 42; // pixels
const BELOW_TAG = 17;
const FILLS = { solid: 0.55, ramp: 0.22, arch: 0.1, floor: 0.1 };
const DASHES = { arch: [5, 4], floor: [2, 3] };

// What stands above the robot, such as a trench, is drawn like the rest, but dashed: one sees what is below it.
export function drawParts(context, view, { parts, tags }) {
  context.save();
  for (const part of parts) {
    const name = { blue: "blue", red: "alliance-red" }[part.alliance] ?? "edge";
    context.strokeStyle = color(name);
    context.fillStyle = color(name);
    context.setLineDash(DASHES[part.kind] ?? []);
    context.lineWidth = part.kind === "line" ? 1.5 : 1;
    tracePath(context, view, part.points, part.kind !== "line");
    if (part.kind !== "line") {
      context.globalAlpha = FILLS[part.kind];
      context.fill();
    }
    context.globalAlpha = 0.7;
    context.stroke();
    if (part.kind === "ramp") drawSlope(context, view, part.points);
  }
  context.restore();
  if (view.scale >= LEAST_NAMED) drawNames(context, view, parts, tags);
}

// A ramp's top, between its two slopes.
function drawSlope(context, view, points) {
  const [left, right] = [Math.min(...points.map(([x]) => x)), Math.max(...points.map(([x]) => x))];
  const [top, bottom] = [Math.min(...points.map(([, y]) => y)), Math.max(...points.map(([, y]) => y))];
  const middle = (left + right) / 2;
  tracePath(context, view, [[middle, top], [middle, bottom]]);
  context.stroke();
}

// Below the numbers of tags that are in the way.
function drawNames(context, view, parts, tags) {
  context.save();
  context.font = font(10);
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (const { name, kind, points } of parts) {
    if (!name || kind === "line") continue;
    const middle = [0, 1].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
    const [x, y] = view.toScreen(middle);
    context.fillStyle = color(kind === "solid" ? "text" : "muted");
    const isNear = (tag) => Math.hypot(...view.toScreen([tag.x, tag.y]).map((each, axis) => each - [x, y][axis])) < NEAR_TAG;
    context.fillText(name, x, tags.some(isNear) ? y + BELOW_TAG : y);
  }
  context.restore();
}
