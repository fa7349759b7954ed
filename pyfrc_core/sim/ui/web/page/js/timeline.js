// The timeline: modes as colours, marks, and the moment that the panels show.
import { Drawn, font } from "#js/canvas.js";
import { compared } from "#js/compare.js";
import { clockTick } from "#js/format.js";
import { gapsOf, hatch } from "#js/gaps.js";
import { lookByKey } from "#js/input/moment_keys.js";
import { momentText } from "#js/match_clock.js";
import { model } from "#js/model.js";
import { isForgotten, length, live, look } from "#js/past.js";
import { watch, unwatch } from "#js/series.js";
import { color } from "#js/settings.js";
import { html } from "#js/view.js";

const MODE_COLORS = { autonomous: "mode-auto", teleop: "mode-teleop", test: "mode-test" };
const MARK_COLORS = { failure: "red", error: "red", warning: "amber", overrun: "amber", press: "accent", own: "own", run: "muted" };
const NEAR = 5; // pixels between the pointer and a mark
const MOST_NAMED = 5; // marks beside the pointer
const EDGE = 8; // pixels at both ends
const LIVE_INTERVAL = 150; // milliseconds: the present moves slowly
const SHORTEST = 10; // seconds on the timeline at least, until it is over

export class Timeline extends Drawn {
  parts = ["t", "status", "shown", "series", "marks", "settings", "window", "branches", "compared", "known_from"];
  state = { hover: null };

  componentDidMount() {
    super.componentDidMount();
    this.modes = watch("sim.mode");
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    unwatch("sim.mode");
  }

  // It listens itself; the bar around it renders more often.
  shouldComponentUpdate(_, state) {
    return state !== this.state;
  }

  // Painted again only if something has moved by about a pixel.
  componentDidUpdate() {
    if (!this.size.width) return;
    const step = 2 ** Math.floor(Math.log2(this.whole / this.width)); // seconds: at most a pixel
    const moments = [length(), compared.end, model.knownFrom, model.past?.t ?? model.t].map((t) => Math.floor(t / step));
    const { marks, branches } = model;
    if (this.picture.changes(marks, branches, model.compared, Boolean(model.past), this.modes.t.length, this.modes.t[0], this.width, ...moments)) this.draw();
  }

  render(_, { hover }) {
    this.interval = model.past ? 0 : LIVE_INTERVAL;
    const t = model.past?.t ?? Math.floor(model.t);
    return html`<div class="timeline" role="slider" tabindex="0" aria-label="Timeline" aria-valuemin="0"
        aria-valuemax=${Math.ceil(length())} aria-valuenow=${t.toFixed(2)} aria-valuetext=${model.past ? momentText(t) : `live, ${clockTick(t)}`}
        onPointerDown=${this.begin} onPointerMove=${this.move} onPointerUp=${this.end} onPointerLeave=${this.leave} onKeyDown=${this.key}>
      <canvas ref=${this.canvas}></canvas>
      ${hover && html`<div class="timeline-tip column" style=${{ left: `${hover.left}px` }}>
        <b>${momentText(hover.t)}</b>${isForgotten(hover.t) && html`<span>Values forgotten</span>`}${this.marksNear(hover.t).map((mark, index) => html`<span key=${index} class=${`mark-${mark.kind}`}>${mark.text}</span>`)}</div>`}
    </div>`;
  }

  marksNear(t) {
    const reach = (NEAR / this.width) * this.whole;
    return model.marks.filter((mark) => Math.abs(mark.t - t) <= reach).slice(-MOST_NAMED);
  }

  // -- drawing

  get width() {
    return this.size.width;
  }

  get whole() {
    return Math.max(length(), compared.end, model.isOver ? 0.1 : SHORTEST);
  }

  x(t) {
    return EDGE + (t / this.whole) * (this.width - 2 * EDGE);
  }

  paint(context) {
    this.drawModes(context);
    this.drawMarks(context);
    this.drawTicks(context);
    this.drawHead(context);
  }

  drawModes(context) {
    const top = 6;
    const height = 16;
    context.fillStyle = color("track");
    context.beginPath();
    context.roundRect(EDGE - 4, top, this.width - 2 * EDGE + 8, height, 5);
    context.fill();
    context.save();
    context.clip();
    context.fillStyle = color("mode-disabled");
    const known = model.knownFrom ? this.x(model.knownFrom) : 0;
    context.fillRect(known, top, this.x(length()) + (length() >= this.whole ? EDGE : 0) - known, height);
    const { t, v } = this.modes;
    for (let index = 0; index < t.length; index++) {
      const name = MODE_COLORS[v[index]];
      if (!name) continue;
      const from = this.x(Math.max(t[index], model.knownFrom));
      const to = this.x(index + 1 < t.length ? t[index + 1] : length());
      context.fillStyle = color(name);
      if (to >= from) context.fillRect(from, top, Math.max(to - from, 1), height);
    }
    for (const [from, to] of gapsOf(this.modes, length())) hatch(context, this.x(from), top, Math.max(this.x(to) - this.x(from), 1), height);
    for (const branch of model.branches) {
      if (branch.id !== model.compared) continue;
      context.fillStyle = color("own");
      context.fillRect(this.x(branch.from), top, Math.max(this.x(branch.to) - this.x(branch.from), 2), 3);
    }
    context.restore();
  }

  drawMarks(context) {
    const lastX = {};
    for (const mark of model.marks) {
      const name = MARK_COLORS[mark.kind];
      if (!name) continue;
      const x = Math.round(this.x(mark.t));
      if (lastX[mark.kind] === x) continue; // many marks on one pixel
      lastX[mark.kind] = x;
      context.fillStyle = color(name);
      const small = mark.kind === "press" || mark.kind === "run";
      context.fillRect(x - 1, small ? 18 : 4, 2, small ? 6 : 20);
      if (mark.kind === "own" || mark.kind === "failure") {
        context.beginPath();
        context.moveTo(x - 4, 0);
        context.lineTo(x + 4, 0);
        context.lineTo(x, 6);
        context.fill();
      }
    }
  }

  drawTicks(context) {
    const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1800, 3600];
    const step = steps.find((each) => this.x(each) >= 64) ?? 7200;
    context.fillStyle = color("muted");
    context.font = font(10.5);
    context.textBaseline = "alphabetic";
    context.textAlign = "center";
    for (let t = 0; t <= this.whole; t += step) {
      const x = this.x(t);
      context.globalAlpha = 0.5;
      context.fillRect(Math.round(x), 24, 1, 4);
      context.globalAlpha = 1;
      context.textAlign = x < 20 ? "left" : x > this.width - 20 ? "right" : "center";
      context.fillText(`${Math.floor(t / 60)}:${String(t % 60).padStart(2, "0")}`, x, 40);
    }
  }

  drawHead(context) {
    const x = this.x(model.past?.t ?? model.t);
    context.fillStyle = color(model.past ? "past" : "text");
    context.fillRect(Math.round(x) - 1, 2, 2, 26);
    context.beginPath();
    context.arc(x, 14, 6, 0, 2 * Math.PI);
    context.fill();
    context.strokeStyle = color("surface");
    context.lineWidth = 2;
    context.stroke();
  }

  // -- the pointer and the keys

  timeAt(event) {
    const box = this.canvas.current.getBoundingClientRect();
    const share = (event.clientX - box.left - EDGE) / (box.width - 2 * EDGE);
    return Math.min(Math.max(share * this.whole, 0), length());
  }

  begin = (event) => {
    if (event.button !== 0) return;
    event.currentTarget.focus(); // the arrow keys go on from there
    event.currentTarget.setPointerCapture(event.pointerId);
    this.dragging = true;
    look(this.timeAt(event));
  };

  move = (event) => {
    const t = this.timeAt(event);
    if (this.dragging) look(t);
    const box = this.canvas.current.getBoundingClientRect();
    const left = Math.min(Math.max(event.clientX - box.left, 60), box.width - 60);
    this.setState({ hover: { t, left } });
  };

  end = () => {
    this.dragging = false;
  };

  leave = () => this.setState({ hover: null });

  key = (event) => {
    if (lookByKey(event)) return event.stopPropagation();
    if (event.key !== "Escape") return;
    event.stopPropagation();
    event.currentTarget.blur(); // the arrow keys drive again
    live();
  };
}
