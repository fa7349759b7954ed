// The field: the season's picture, the robot, its path, and what robot code publishes. The wheel zooms, dragging moves.
import { Drawn, font } from "#js/canvas.js";
import { command } from "#js/connection.js";
import { numberText } from "#js/format.js";
import { COORDINATES, originOf, unitOf, written } from "#js/field/coordinates.js";
import * as draw from "#js/field/draw.js";
import { drawParts } from "#js/field/draw_parts.js";
import { fieldNeeds, fieldObjects, swerveStates } from "#js/field/published.js";
import { Viewport } from "#js/field/viewport.js";
import { Menu } from "#js/popup.js";
import { model } from "#js/model.js";
import { compared } from "#js/compare.js";
import { color, settings } from "#js/settings.js";
import { Icon, html } from "#js/view.js";
import { onWheel } from "#js/wheel.js";

const LAYERS = [
  ["trail", "Path of the robot"],
  ["former", "Earlier path"],
  ["drawings", "Drawings of the code"],
  ["objects", "Field2d objects"],
  ["swerve", "Swerve arrows"],
  ["tags", "AprilTags"],
  ["structures", "Structures of the season's field"],
];
const DEGREES = 180 / Math.PI;
const MOST_ROBOTS = 3; // of more poses, each is a small arrowhead
const LEAST_NAMED = 8; // pixels per foot: names would cover a smaller field
const TURN = 15; // degrees by an arrow key

// A robot elsewhere shows itself as an object of a Field2d.
const WITHOUT_POSE = { simulation: "No physics.py: pyfrc create-physics writes one", log: "Where the robot is, is not known" };

export class FieldPanel extends Drawn {
  parts = ["t", "robot", "shown", "values", "trail", "former_trail", "drawings", "targets", "hello", "field", "settings", "window", "compared", "compared-series"];

  componentDidMount() {
    super.componentDidMount();
    this.view = new Viewport(model.hello.field);
    onWheel(this.canvas.current, { zoom: this.zoomBy });
    this.loadImage();
  }

  componentDidUpdate() {
    this.loadImage();
    const { trail, formerTrail, drawings, targets, hello } = model;
    const moving = JSON.stringify([this.robots, this.swerve, this.objects, this.view.turned, this.coordinates]);
    if (this.picture.changes(moving, trail, formerTrail, drawings, targets, hello, settings.get("fieldLayers"))) this.draw();
  }

  shows(layer) {
    return settings.get("fieldLayers")[layer] !== false;
  }

  // How places are written: as the person has chosen, or the project's file says.
  get coordinates() {
    const chosen = settings.get("coordinates") || model.hello.field.coordinates;
    return chosen in COORDINATES ? chosen : "pyfrc";
  }

  // The menu's item for something that can be hidden.
  layer(name, text) {
    const shown = this.shows(name);
    return { text, checked: shown, act: () => settings.set("fieldLayers", { ...settings.get("fieldLayers"), [name]: !shown }) };
  }

  // bare: without the line below; only: the beginning of the paths of the only objects to show
  render({ bare, only }) {
    const { values, station } = model.shown;
    const objects = fieldObjects(values, model.hello.field);
    const chosen = model.isDriven ? undefined : objects.find(({ path, poses }) => path === settings.get("fieldRobot") && poses.length === 1);
    const robot = chosen ? chosen.poses[0] : model.shown.robot;
    this.robots = {
      chosen: chosen?.path,
      robot,
      now: !chosen && model.past && !model.isOver && model.robot, // behind the robot of the moment that is shown
      compared: compared.poseAt(model.past?.t ?? model.t),
      alliance: station.alliance ?? model.station.alliance ?? "",
    };
    model.need(this, fieldNeeds());
    this.swerve = robot ? swerveStates(values) : [];
    /** @type {any[]} */
    const layers = LAYERS.map(([layer, text]) => this.layer(layer, text));
    this.objects = objects.filter((one) => one !== chosen && (!only || one.path === only || one.path.startsWith(`${only}/`)));
    if (this.objects.length) layers.push({ separator: true }, ...this.objects.map(({ path, name }) => this.layer(path, name)));
    const mayBe = model.isDriven ? [] : objects.filter(({ poses }) => poses.length === 1);
    if (mayBe.length) {
      const choice = (path, text) => ({ text, checked: path === (chosen?.path ?? ""), act: () => settings.set("fieldRobot", path) });
      layers.push({ separator: true }, choice("", "Robot: as found by pyfrc"), ...mayBe.map(({ path, name }) => choice(path, `Robot: ${name}`)));
    }
    const { coordinates } = this;
    const pose = robot && written(robot, model.hello.field, coordinates, this.robots.alliance);
    const choices = Object.entries(COORDINATES).map(([name, text]) => ({ text, checked: name === coordinates, act: () => settings.set("coordinates", name) }));
    layers.push({ separator: true }, ...choices);
    layers.push({ separator: true }, { text: "Turn the field round", checked: Boolean(this.view?.turned), act: this.turnRound });
    return html`<div class="field column">
      <div class="field-canvas fill" tabindex="0" role="application" aria-label="Field. Arrow keys move the robot, with Shift they turn it"
        onPointerDown=${this.begin} onPointerMove=${this.drag} onPointerUp=${this.end} onPointerCancel=${this.end}
        onDblClick=${this.whole} onContextMenu=${(event) => event.preventDefault()} onKeyDown=${this.key}>
        <canvas ref=${this.canvas}></canvas>
      </div>
      ${!bare && html`<div class="field-line flex">
        <span class="pose" title=${COORDINATES[coordinates]}>${pose ? html`<i>x</i><b>${numberText(pose.x)} ${pose.unit}</b><i>y</i><b>${numberText(pose.y)} ${pose.unit}</b><i class="long">heading</i><b>${numberText(pose.degrees, 1)}°</b>` : WITHOUT_POSE[model.hello.source?.kind] ?? ""}</span>
        <button class="quiet" title="Show the whole field: double click" aria-label="Show the whole field" onClick=${this.whole}><${Icon} name="fit" /></button>
        <${Menu} label="Show" title="What is drawn" items=${layers} />
      </div>`}
    </div>`;
  }

  // -- drawing

  loadImage() {
    const address = model.hello.field.image;
    if (address === this.imageAddress) return;
    this.imageAddress = address;
    this.image = null;
    if (!address) return;
    const image = new Image();
    image.onload = () => {
      this.image = image;
      this.draw();
    };
    image.src = address;
  }

  paint(context, width, height) {
    const { view } = this;
    const { field } = model.hello;
    view.field = field;
    view.resize(width, height);
    const { coordinates } = this;
    const origin = originOf(field, coordinates, this.robots.alliance);
    draw.drawCarpet(context, view, field, this.image, unitOf(coordinates), origin);
    if (this.shows("structures")) drawParts(context, view, field);
    if (coordinates !== "pyfrc") draw.drawOrigin(context, view, field, origin);
    if (this.shows("tags")) draw.drawTags(context, view, field.tags);
    if (this.shows("former")) draw.drawTrail(context, view, model.formerTrail, "former", 2, [7, 5]);
    if (this.shows("trail") && !this.robots.chosen) { // it is that of the other pose
      context.globalAlpha = model.past ? 0.35 : 1;
      draw.drawTrail(context, view, model.trail, "accent", 2.5);
      context.globalAlpha = 1;
    }
    if (this.shows("drawings")) for (const drawing of model.drawings) draw.drawDrawing(context, view, drawing);
    draw.drawTargets(context, view, model.targets);
    if (this.shows("objects")) this.drawObjects(context, field);
    this.drawRobots(context, field);
  }

  drawObjects(context, field) {
    const labels = [];
    this.objects.forEach((object, index) => {
      if (!this.shows(object.path)) return;
      const name = `curve-${(index + 2) % 8}`;
      if (object.isPath) draw.drawTrail(context, this.view, object.poses, name, 2);
      else if (object.poses.length > MOST_ROBOTS) for (const pose of object.poses) draw.drawPlace(context, this.view, pose, name);
      else for (const pose of object.poses) draw.drawRobot(context, this.view, field, pose, { body: name, alpha: 0.8, outline: true });
      if (this.view.scale < LEAST_NAMED || isUnderRobot(object, this.robots.robot, field)) return;
      const [x, y] = this.view.toScreen(object.poses[0]);
      const above = object.isPath || object.poses.length > MOST_ROBOTS ? 8 : (Math.hypot(field.robot_length, field.robot_width) / 2) * this.view.scale + 2;
      context.fillStyle = color(name);
      context.font = font(11);
      context.textAlign = "center";
      context.textBaseline = "bottom";
      const { width, fontBoundingBoxAscent: ascent, fontBoundingBoxDescent: descent } = context.measureText(object.name);
      const half = width / 2 + 2;
      const middle = Math.min(Math.max(x, half), this.view.width - half);
      const bottom = draw.placeLabel(labels, middle, y - above, 2 * half, ascent + descent);
      context.strokeStyle = color("carpet"); // lines and tags behind it would make it hard to read
      context.lineWidth = 3;
      context.lineJoin = "round";
      context.strokeText(object.name, middle, bottom);
      context.fillText(object.name, middle, bottom);
    });
  }

  drawRobots(context, field) {
    const { robot, now, compared, alliance } = this.robots;
    if (compared) draw.drawRobot(context, this.view, field, compared, { body: "own", alpha: 0.75 });
    if (now) draw.drawRobot(context, this.view, field, now, { body: "muted", alpha: 0.35 });
    if (!robot) return;
    draw.drawRobot(context, this.view, field, robot, { body: alliance.startsWith("red") ? "alliance-red" : "blue" });
    if (!this.shows("swerve")) return;
    for (const { states, wanted } of this.swerve) {
      draw.drawSwerve(context, this.view, field, robot, states, wanted ? "swerve-wanted" : "swerve");
    }
  }

  // -- the pointer and the keys

  place(event) {
    const box = this.canvas.current.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  onRobot(place) {
    const { robot, field } = { robot: model.robot, field: model.hello.field };
    if (!robot || model.past || !model.mayDrive) return false;
    return Math.hypot(place[0] - robot[0], place[1] - robot[1]) < Math.max(field.robot_length, field.robot_width) / 2;
  }

  begin = (event) => {
    const place = this.view.toField(...this.place(event));
    event.currentTarget.setPointerCapture(event.pointerId);
    if (this.onRobot(place)) {
      const kind = event.button === 2 || event.shiftKey ? "turn" : "move";
      this.held = { kind, by: [model.robot[0] - place[0], model.robot[1] - place[1]] };
    } else this.held = { kind: "pan", last: this.place(event) };
  };

  drag = (event) => {
    const pixel = this.place(event);
    const place = this.view.toField(...pixel);
    if (!this.held) {
      event.currentTarget.style.cursor = this.onRobot(place) ? "grab" : "default";
      return;
    }
    event.currentTarget.style.cursor = "grabbing";
    const { kind, last, by } = this.held;
    const { robot } = model;
    if (kind === "pan") {
      this.view.pan(pixel[0] - last[0], pixel[1] - last[1]);
      this.held.last = pixel;
      this.draw();
    } else if (kind === "move") {
      command("place", { x: place[0] + by[0], y: place[1] + by[1], degrees: robot[2] * DEGREES });
    } else {
      command("place", { x: robot[0], y: robot[1], degrees: Math.atan2(place[1] - robot[1], place[0] - robot[0]) * DEGREES });
    }
  };

  end = (event) => {
    this.held = null;
    event.currentTarget.blur();
  };

  zoomBy = (factor, event) => {
    this.view.zoomAt(1 / factor, ...this.place(event));
    this.draw();
  };

  whole = () => {
    this.view.reset();
    this.draw();
  };

  turnRound = () => {
    this.view.turned = !this.view.turned;
    this.setState({});
  };

  key = (event) => {
    const way = { ArrowLeft: [-0.25, 0], ArrowRight: [0.25, 0], ArrowUp: [0, -0.25], ArrowDown: [0, 0.25] }[event.key];
    const { robot } = model;
    if (!way || !robot || model.past || !model.mayDrive) return;
    event.preventDefault();
    event.stopPropagation();
    const degrees = robot[2] * DEGREES;
    if (event.shiftKey) command("place", { x: robot[0], y: robot[1], degrees: degrees + Math.sign(way[0] + way[1]) * TURN });
    else command("place", { x: robot[0] + way[0], y: robot[1] + way[1], degrees });
  };
}

// Whether an object's name would cover the robot, such as that of the pose which robot code measures.
function isUnderRobot({ poses: [[x, y]], isPath }, robot, field) {
  return Boolean(robot) && !isPath && Math.hypot(x - robot[0], y - robot[1]) < Math.min(field.robot_length, field.robot_width) / 2;
}
