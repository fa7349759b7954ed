// A swerve drive from above: measured and wanted states of its modules, the chassis' speeds, the robot's heading.
import { Drawn } from "#js/canvas.js";
import { arrow } from "#js/field/draw.js";
import { swerveDrive, swerveNeeds } from "#js/field/swerve.js";
import { numberText } from "#js/format.js";
import { model } from "#js/model.js";
import { color } from "#js/settings.js";
import { html } from "#js/view.js";

const FASTEST = 4.5; // metres per second, unless the dashboard says otherwise
const STANDING = 0.01; // metres or radians per second: slower is no movement
const DEGREES = 180 / Math.PI;

export class SwervePanel extends Drawn {
  parts = ["values", "paths", "types", "robot", "shown", "settings", "window", "hello"];

  componentDidUpdate() {
    if (this.picture.changes(JSON.stringify([this.drive, this.props.fastest]))) this.draw();
  }

  // topics: the paths to show; of an empty list, the first ones that suit
  render({ topics = [] }) {
    model.need(this, swerveNeeds());
    this.drive = swerveDrive(model.shown, topics);
    const { measured, wanted, speeds, heading } = this.drive;
    const isEmpty = !measured && !wanted && !speeds;
    const facts = [
      ...(speeds ? [["vx", speeds.vx, "m/s"], ["vy", speeds.vy, "m/s"], ["ω", speeds.omega, "rad/s"]] : []),
      ...(heading === null ? [] : [["heading", heading * DEGREES, "°"]]),
    ];
    return html`<div class="swerve column">
      <div class="swerve-canvas fill"><canvas ref=${this.canvas} role="img" aria-label="Swerve drive from above"></canvas></div>
      ${isEmpty && html`<p class="empty">Publish an array of SwerveModuleState as a struct, or a table of the type “SwerveDrive”: it appears here.</p>`}
      ${!isEmpty && html`<div class="swerve-facts">${facts.map(([name, value, unit]) => html`<span key=${name}><i>${name}</i><b>${numberText(value, unit === "°" ? 1 : 2)}</b><small>${unit}</small></span>`)}
        ${measured && html`<span class="swerve-key"><i class="swatch measured"></i>measured</span>`}${wanted && html`<span class="swerve-key"><i class="swatch wanted"></i>wanted</span>`}</div>`}
    </div>`;
  }

  paint(context, width, height) {
    const { measured, wanted, speeds, heading } = this.drive;
    if (!measured && !wanted && !speeds) return;
    const half = Math.min(width, height) * 0.28; // of the robot
    context.translate(width / 2, height / 2);
    drawFrame(context, half, heading ?? 0, heading !== null);
    const places = placesOf((measured ?? wanted)?.length ?? 4, half * 0.78);
    const longest = half * 0.9;
    const fastest = this.props.fastest || FASTEST;
    // The robot's forward direction points upwards while its heading is 0.
    const way = (angle) => -Math.PI / 2 - (heading ?? 0) - angle;
    const modules = (states, name, size) => states.slice(0, places.length).forEach((state, index) => {
      const [x, y] = turned(places[index], -(heading ?? 0));
      drawModule(context, [x, y], way(state.angle), Math.min(Math.max(state.speed / fastest, -1), 1) * longest, name, size, half * 0.16);
    });
    if (measured) modules(measured, "swerve-measured", wanted ? 5 : 3.5);
    if (wanted) modules(wanted, "swerve-wanted", 2);
    if (speeds) drawSpeeds(context, speeds, way, half, fastest);
  }
}

// The places of modules in the order of WPILib's examples: front left, front right, back left, back right. Other numbers of
// modules are drawn around the centre.
/** @returns {[number, number][]} */
function placesOf(count, far) {
  if (count === 4) return [[-far, -far], [far, -far], [-far, far], [far, far]];
  return Array.from({ length: count }, (_, index) => {
    const angle = -Math.PI / 2 + ((index - 0.5) * 2 * Math.PI) / count;
    return [Math.cos(angle) * far * 1.2, Math.sin(angle) * far * 1.2];
  });
}

/** @returns {[number, number]} */
function turned([x, y], angle) {
  return [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
}

function drawFrame(context, half, heading, isKnown) {
  context.save();
  context.rotate(-heading);
  context.strokeStyle = color("edge");
  context.fillStyle = color("raised");
  context.lineWidth = 2;
  context.beginPath();
  context.roundRect(-half, -half, 2 * half, 2 * half, half * 0.14);
  context.fill();
  context.stroke();
  context.fillStyle = color(isKnown ? "text" : "muted"); // a triangle at the front
  context.beginPath();
  context.moveTo(0, -half * 0.96);
  context.lineTo(half * 0.12, -half * 0.74);
  context.lineTo(-half * 0.12, -half * 0.74);
  context.fill();
  context.restore();
}

// A wheel in its direction, and an arrow as long as it is fast.
function drawModule(context, [x, y], angle, reach, name, width, wheel) {
  context.save();
  context.strokeStyle = color(name);
  context.lineCap = "round";
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x - Math.cos(angle) * wheel, y - Math.sin(angle) * wheel);
  context.lineTo(x + Math.cos(angle) * wheel, y + Math.sin(angle) * wheel);
  context.stroke();
  context.beginPath();
  context.arc(x, y, width, 0, 2 * Math.PI);
  context.fillStyle = color(name);
  context.fill();
  if (Math.abs(reach) > wheel) arrow(context, [x, y], [x + Math.cos(angle) * reach, y + Math.sin(angle) * reach], 6 + width);
  context.restore();
}

// The chassis' velocity from the centre, and its turning as an arc around it.
function drawSpeeds(context, { vx, vy, omega }, way, half, fastest) {
  const speed = Math.hypot(vx, vy);
  context.save();
  context.strokeStyle = color("accent");
  context.lineWidth = 3;
  context.lineCap = "round";
  if (speed > STANDING) {
    const angle = way(Math.atan2(vy, vx));
    const reach = Math.min(speed / fastest, 1) * half;
    arrow(context, [0, 0], [Math.cos(angle) * reach, Math.sin(angle) * reach], 9);
  }
  if (Math.abs(omega) > STANDING) {
    const radius = half * 0.3;
    const begin = way(0);
    const end = begin - Math.min(Math.max(omega / (2 * Math.PI), -0.95), 0.95) * 2 * Math.PI;
    context.beginPath();
    context.arc(0, 0, radius, begin, end, omega > 0);
    context.stroke();
    const across = end + (omega > 0 ? -1 : 1) * (Math.PI / 2);
    /** @type {[number, number]} */
    const tip = [Math.cos(end) * radius, Math.sin(end) * radius];
    arrow(context, [tip[0] - Math.cos(across), tip[1] - Math.sin(across)], tip, 8);
  }
  context.restore();
}
