// Draws the field and what is on it. Each function draws one thing.
import { font } from "#js/canvas.js";
import { color } from "#js/settings.js";

const GRID = { ft: 5, m: 1 }; // between two lines
const FASTEST = 4.5; // metres per second: the longest arrow of a swerve module

export function tracePath(context, view, points, close = false) {
  context.beginPath();
  points.forEach((point, index) => {
    const [x, y] = view.toScreen(point);
    if (index) context.lineTo(x, y);
    else context.moveTo(x, y);
  });
  if (close) context.closePath();
}

// The place of a point given forwards and to the right of a pose.
export function beside([x, y, angle], forwards, right) {
  const cos = Math.cos(angle);
  const sin = Math.sin(angle);
  return [x + cos * forwards - sin * right, y + sin * forwards + cos * right];
}

export function drawCarpet(context, view, field, image, { feet, unit }, origin) {
  const corners = [[0, 0], [field.width, 0], [field.width, field.height], [0, field.height]];
  context.fillStyle = color("carpet");
  tracePath(context, view, corners, true);
  context.fill();
  if (image) {
    const [left, top] = view.toScreen([0, 0]);
    const size = view.scale * (view.turned ? -1 : 1);
    context.drawImage(image, left, top, field.width * size, field.height * size);
  } else drawGrid(context, view, field, GRID[unit] * feet, origin);
  for (const shape of field.objects) {
    tracePath(context, view, shape.points, true);
    context.fillStyle = shape.color;
    context.globalAlpha = 0.85;
    context.fill();
    context.globalAlpha = 1;
  }
  context.strokeStyle = color("edge");
  context.lineWidth = 1.5;
  tracePath(context, view, corners, true);
  context.stroke();
  drawWalls(context, view, field);
}

// Lines that count from the origin.
function drawGrid(context, view, field, wanted, [originX, originY]) {
  const step = Math.max(wanted, Math.max(field.width, field.height) / 60);
  context.strokeStyle = color("grid");
  context.lineWidth = 1;
  context.beginPath();
  const line = (from, to) => {
    context.moveTo(...view.toScreen(from));
    context.lineTo(...view.toScreen(to));
  };
  const at = (origin, each) => (origin ? origin - each : each);
  for (let x = step; x < field.width; x += step) line([at(originX, x), 0], [at(originX, x), field.height]);
  for (let y = step; y < field.height; y += step) line([0, at(originY, y)], [field.width, at(originY, y)]);
  context.stroke();
}

// The two alliances' walls, blue at the left as WPILib has them.
function drawWalls(context, view, field) {
  context.lineWidth = 4;
  for (const [x, name] of [[0, "blue"], [field.width, "alliance-red"]]) {
    context.strokeStyle = color(name);
    tracePath(context, view, [[x, 0], [x, field.height]]);
    context.stroke();
  }
}

const INSIDE = 8; // pixels from the walls

// The corner from which places count, and the directions in which x and y grow: inwards, along both walls.
export function drawOrigin(context, view, field, [x, y]) {
  const [cornerX, cornerY] = view.toScreen([x, y]);
  const [farX, farY] = view.toScreen([field.width - x, field.height - y]);
  const [wayX, wayY] = [Math.sign(farX - cornerX), Math.sign(farY - cornerY)];
  /** @type {[number, number]} */
  const corner = [cornerX + wayX * INSIDE, cornerY + wayY * INSIDE];
  const length = Math.min(4 * view.scale, 40);
  context.lineWidth = 2.5;
  context.lineCap = "round";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = font(11, "bold ");
  for (const name of ["x", "y"]) {
    const [right, down] = name === "x" ? [wayX, 0] : [0, wayY];
    const at = (pixels) => [corner[0] + right * pixels, corner[1] + down * pixels];
    context.strokeStyle = color(name === "x" ? "red" : "green");
    context.fillStyle = context.strokeStyle;
    const [toX, toY] = at(length);
    arrow(context, corner, [toX, toY], 7);
    const [textX, textY] = at(length + 9);
    context.fillText(name, textX, textY);
  }
}

export function drawTags(context, view, tags) {
  context.fillStyle = color("text");
  context.strokeStyle = color("text");
  context.lineWidth = 3;
  context.font = font(Math.min(Math.max(view.scale * 0.55, 9), 13));
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (const tag of tags) {
    /** @type {[number, number, number]} */
    const pose = [tag.x, tag.y, tag.angle];
    tracePath(context, view, [beside(pose, 0, -0.35), beside(pose, 0, 0.35)]);
    context.stroke();
    if (view.scale > 9) context.fillText(String(tag.number), ...view.toScreen(beside(pose, 0.9, 0)));
  }
}

export function drawTrail(context, view, points, name, width, dash = []) {
  if (points.length < 2) return;
  context.save();
  context.strokeStyle = color(name);
  context.lineWidth = width;
  context.lineJoin = "round";
  context.lineCap = "round";
  context.setLineDash(dash);
  tracePath(context, view, points);
  context.stroke();
  context.restore();
}

export function drawRobot(context, view, field, pose, { body = "accent", alpha = 1, outline = false } = {}) {
  const length = field.robot_length / 2;
  const width = field.robot_width / 2;
  const bumper = 0.18 * Math.min(length, width);
  const box = (by) => [[length - by, width - by], [length - by, by - width], [by - length, by - width], [by - length, width - by]].map(([f, r]) => beside(pose, f, r));
  context.save();
  context.globalAlpha = alpha;
  context.lineJoin = "round";
  tracePath(context, view, box(0), true);
  if (outline) {
    context.strokeStyle = color(body);
    context.lineWidth = 2;
    context.setLineDash([5, 4]);
    context.stroke();
  } else {
    context.fillStyle = color(body);
    context.fill();
    context.fillStyle = color("robot");
    tracePath(context, view, box(bumper), true);
    context.fill();
  }
  tracePath(context, view, [beside(pose, length - bumper * 1.7, 0), beside(pose, length * 0.15, width * 0.42), beside(pose, length * 0.15, -width * 0.42)], true);
  context.fillStyle = color(outline ? body : "robot-front");
  context.fill();
  context.restore();
}

// A small arrowhead, for one of many poses.
export function drawPlace(context, view, pose, name) {
  context.fillStyle = color(name);
  tracePath(context, view, [beside(pose, 0.7, 0), beside(pose, -0.35, 0.45), beside(pose, -0.35, -0.45)], true);
  context.fill();
}

export function drawSwerve(context, view, field, pose, modules, name) {
  const length = field.robot_length * 0.36;
  const width = field.robot_width * 0.36;
  const places = [[length, -width], [length, width], [-length, -width], [-length, width]];
  const longest = Math.max(field.robot_length, field.robot_width) * 0.9;
  context.save();
  context.strokeStyle = color(name);
  context.fillStyle = color(name);
  // Thinner on a small field, where four thick arrows would be one blot.
  const size = Math.min(Math.max(view.scale * 0.45, 2.5), 6);
  context.lineWidth = size * 0.4;
  context.lineCap = "round";
  modules.slice(0, 4).forEach(({ speed, angle }, index) => {
    const [x, y] = beside(pose, ...places[index]);
    const way = pose[2] - angle; // WPILib's angles are counterclockwise
    const reach = Math.min(Math.max(speed / FASTEST, -1), 1) * longest;
    const end = [x + Math.cos(way) * reach, y + Math.sin(way) * reach];
    context.beginPath();
    context.arc(...view.toScreen([x, y]), size * 0.4, 0, 2 * Math.PI);
    context.fill();
    if (Math.abs(speed) > 0.02) arrow(context, view.toScreen([x, y]), view.toScreen(end), size);
  });
  context.restore();
}

export function arrow(context, [fromX, fromY], [toX, toY], size) {
  const angle = Math.atan2(toY - fromY, toX - fromX);
  context.beginPath();
  context.moveTo(fromX, fromY);
  context.lineTo(toX, toY);
  for (const side of [-0.5, 0.5]) {
    context.moveTo(toX, toY);
    context.lineTo(toX - size * Math.cos(angle + side), toY - size * Math.sin(angle + side));
  }
  context.stroke();
}

export function drawTargets(context, view, targets) {
  for (const target of targets) {
    context.beginPath();
    context.arc(...view.toScreen([target.x, target.y]), 6, 0, 2 * Math.PI);
    context.fillStyle = color(target.in_view ? "green" : "muted");
    context.fill();
  }
}

// A line or text that the robot's code has drawn.
export function drawDrawing(context, view, drawing) {
  context.save();
  if (drawing.kind === "line") drawLine(context, view, drawing);
  else drawText(context, view, drawing);
  context.restore();
}

const CAPS = { butt: "butt", projecting: "square", round: "round" };

function drawLine(context, view, drawing) {
  context.strokeStyle = drawing.color;
  context.lineWidth = drawing.width ?? 2;
  context.setLineDash(drawing.dash ?? []);
  context.lineCap = CAPS[drawing.cap] ?? "butt";
  context.lineJoin = drawing.join ?? "round";
  const points = drawing.points.map((point) => view.toScreen(point));
  if (points.length < 2) return;
  context.beginPath();
  context.moveTo(...points[0]);
  if (drawing.smooth && points.length > 2) {
    for (let index = 1; index < points.length - 1; index++) {
      const [x, y] = points[index];
      const [nextX, nextY] = points[index + 1];
      const last = index === points.length - 2;
      context.quadraticCurveTo(x, y, last ? nextX : (x + nextX) / 2, last ? nextY : (y + nextY) / 2);
    }
  } else points.slice(1).forEach((point) => context.lineTo(...point));
  context.stroke();
  if (drawing.arrow) {
    context.setLineDash([]);
    arrow(context, points[points.length - 2], points[points.length - 1], 9);
  }
}

function drawText(context, view, drawing) {
  const style = `${drawing.italic ? "italic " : ""}${drawing.bold ? "bold " : ""}`;
  const pixels = Math.min(Math.max((drawing.size * 4) / 3, 6), 96);
  context.font = font(pixels, style);
  // Black on a dark carpet cannot be read.
  context.fillStyle = drawing.color === "#000000" ? color("text") : drawing.color;
  context.translate(...view.toScreen([drawing.x, drawing.y]));
  context.rotate((-drawing.angle * Math.PI) / 180);
  const anchor = drawing.anchor === "center" ? "" : drawing.anchor;
  context.textAlign = anchor.includes("w") ? "left" : anchor.includes("e") ? "right" : "center";
  context.textBaseline = anchor.includes("n") ? "top" : anchor.includes("s") ? "bottom" : "middle";
  const lines = drawing.text.split("\n");
  lines.forEach((line, index) => context.fillText(line, 0, (index - (lines.length - 1) / 2) * pixels * 1.2));
}

const covers = (one, other) =>
  one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;

// Return the lower edge of a name that is to be here: moved up, above the names that were placed before.
export function placeLabel(placed, x, y, width, height) {
  const box = { left: x - width / 2, right: x + width / 2, top: y - height, bottom: y };
  for (let hidden = placed.find((each) => covers(each, box)); hidden; hidden = placed.find((each) => covers(each, box))) {
    box.bottom = hidden.top;
    box.top = box.bottom - height;
  }
  placed.push(box);
  return box.bottom;
}
