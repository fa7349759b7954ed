// The Mechanism2d drawings that robot code publishes.
import { Drawn, font } from "#js/canvas.js";
import { plain } from "#js/format.js";
import { model } from "#js/model.js";
import { color } from "#js/settings.js";
import { tablesOf } from "#js/tables.js";
import { html } from "#js/view.js";

export class MechanismPanel extends Drawn {
  parts = ["values", "paths", "shown", "settings", "window", "hello"];

  componentDidUpdate() {
    if (this.picture.changes(JSON.stringify(this.found))) this.draw();
  }

  // only: the table of the only one to show
  render({ only }) {
    this.found = mechanisms(model.shown.values).filter(({ folder }) => !only || folder === only);
    model.need(this, this.found.map(({ folder }) => `${folder}/`));
    return html`<div class="mechanism"><canvas ref=${this.canvas} role="img" aria-label=${this.found.map((each) => each.name).join(", ") || "No mechanism"}></canvas>
      ${!this.found.length && html`<p class="empty">A Mechanism2d that the robot publishes with ${model.hello.options.dashboard.publishing} appears here.</p>`}</div>`;
  }

  paint(context, width, height) {
    const { found } = this;
    const columns = Math.ceil(Math.sqrt(found.length)) || 1;
    const rows = Math.ceil(found.length / columns) || 1;
    found.forEach((mechanism, index) => {
      const box = {
        x: ((index % columns) * width) / columns + 10,
        y: (Math.floor(index / columns) * height) / rows + 10,
        width: width / columns - 20,
        height: height / rows - 20,
      };
      drawMechanism(context, mechanism, box);
    });
  }
}

// Every Mechanism2d as a tree of its folder: { folder, name, tree }.
export function mechanisms(values) {
  const found = tablesOf(values, "Mechanism2d").map((folder) => ({ folder, name: lastParts(folder, 1), tree: treeOf(values, folder) }));
  const names = found.map(({ name }) => name);
  const isOne = (name) => names.indexOf(name) === names.lastIndexOf(name);
  return found.map((each) => (isOne(each.name) ? each : { ...each, name: lastParts(each.folder, 2) }));
}

function lastParts(folder, count) {
  return folder.split("/").slice(-count).join("/");
}

function treeOf(values, folder) {
  const tree = { values: {}, children: {} };
  for (const [path, value] of values) {
    if (!path.startsWith(`${folder}/`)) continue;
    const parts = path.slice(folder.length + 1).split("/");
    let node = tree;
    for (const part of parts.slice(0, -1)) node = node.children[part] ??= { values: {}, children: {} };
    node.values[parts[parts.length - 1]] = plain(value);
  }
  return tree;
}

function drawMechanism(context, { name, tree }, box) {
  const [width, height] = tree.values.dims ?? [1, 1];
  const caption = 18;
  const scale = Math.min(box.width / width, (box.height - caption) / height);
  const left = box.x + (box.width - width * scale) / 2;
  const bottom = box.y + box.height;
  context.fillStyle = tree.values.backgroundColor ?? color("track");
  context.beginPath();
  context.roundRect(left, bottom - height * scale, width * scale, height * scale, 8);
  context.fill();
  context.save();
  context.clip();
  for (const root of Object.values(tree.children)) {
    const [x, y] = root.values.position ?? [root.values.x ?? 0, root.values.y ?? 0]; // from 2027 on in one value
    /** @type {[number, number]} */
    const at = [left + x * scale, bottom - y * scale];
    for (const child of Object.values(root.children)) drawLigament(context, child, at, 0, scale);
    context.beginPath();
    context.arc(...at, 4, 0, 2 * Math.PI);
    // The background is the robot code's own colour, in both themes.
    context.fillStyle = "#fff";
    context.strokeStyle = "#000";
    context.lineWidth = 1;
    context.fill();
    context.stroke();
  }
  context.restore();
  context.fillStyle = color("muted");
  context.font = font(12);
  context.textAlign = "center";
  context.textBaseline = "bottom";
  context.fillText(name, box.x + box.width / 2, bottom - height * scale - 3);
}

// A ligament begins where its parent ends, and turns by its angle against it.
function drawLigament(context, node, [x, y], parentAngle, scale) {
  const angle = parentAngle + ((node.values.angle ?? 0) * Math.PI) / 180;
  const length = (node.values.length ?? 0) * scale;
  /** @type {[number, number]} */
  const end = [x + Math.cos(angle) * length, y - Math.sin(angle) * length];
  context.strokeStyle = node.values.color ?? color("accent");
  context.lineWidth = Math.max(node.values.weight ?? 6, 1);
  context.lineCap = "round";
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(...end);
  context.stroke();
  for (const child of Object.values(node.children)) drawLigament(context, child, end, angle, scale);
}
