// Values over time. Curves are added by "+" or by dragging a value here; dragging in the plot zooms, a double click follows again.
import uPlot from "#vendor/uplot/uPlot.esm.js";
import { ElementSize, font } from "#js/canvas.js";
import { compared } from "#js/compare.js";
import { ask } from "#js/connection.js";
import { clockTick, shownNumber, valueText } from "#js/format.js";
import { model } from "#js/model.js";
import { nameOf } from "#js/names.js";
import { length, look } from "#js/past.js";
import { aligned, csvOf, download } from "#js/plot_data.js";
import { PlotPicker } from "#js/plot_picker.js";
import { drawBands } from "#js/plot_bands.js";
import { addToPlot, carriedPath, changePlot, hasPath, plotOf } from "#js/plotting.js";
import { unwatch, valueAt, watch } from "#js/series.js";
import { color } from "#js/settings.js";
import { Icon, Live, classes, createRef, html } from "#js/view.js";

const SPANS = [[5, "5 s"], [20, "20 s"], [60, "1 min"], [0, "All"]];
const BAND = 20; // pixels of height for each boolean or text
const sync = uPlot.sync("time"); // the cursor is at the same moment in every plot

export class PlotPanel extends Live {
  parts = ["series", "t", "shown", "settings", "window", "compared-series", "compared"];
  state = { over: false, at: null };
  area = createRef();
  bands = createRef();
  watched = new Map(); // path: series
  zoom = null; // [from, to] while zoomed in; otherwise the plot follows
  detail = new Map(); // path: series of the zoomed part, in detail
  others = new Map(); // path: series of the compared branch

  componentDidMount() {
    super.componentDidMount();
    this.size = new ElementSize(this.area.current, () => this.resize());
    this.update();
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    this.size.disconnect();
    for (const path of this.watched.keys()) unwatch(path);
    this.plot?.destroy();
    this.plot = null;
  }

  componentDidUpdate() {
    this.update();
  }

  get config() {
    return plotOf(this.props.id);
  }

  render({ id }, { over, at }) {
    const { curves, seconds } = this.config;
    const moment = at ?? model.past?.t ?? model.t;
    return html`<div class=${classes({ plot: true, over })} onDragOver=${this.over} onDragLeave=${() => this.setState({ over: false })} onDrop=${this.drop}>
      <div class="panel-tools">
        <div class="segments small" role="group" aria-label="Time that is shown">
          ${SPANS.map(([span, text]) => html`<button key=${span} class=${classes({ chosen: !this.zoom && seconds === span })} aria-pressed=${!this.zoom && seconds === span}
            onClick=${() => this.follow(span)}>${text}</button>`)}
        </div>
        ${this.zoom && html`<button class="quiet" onClick=${() => this.follow(seconds)}>Follow again</button>`}
        <div class="spacer"></div>
        <${PlotPicker} add=${(path) => addToPlot(path, id)} />
        <button class="quiet" title="Save the values as CSV" aria-label="Save the values as CSV" disabled=${!curves.length} onClick=${this.save}><${Icon} name="download" />CSV</button>
        <button class="quiet" title="Remove all curves" disabled=${!curves.length} onClick=${() => changePlot(id, { curves: [] })}>Clear</button>
      </div>
      <ul class="legend" aria-label="Curves">
        ${curves.map((curve) => html`<li key=${curve.path}>
          <i class="swatch" style=${{ background: `var(--curve-${curve.color})` }}></i>
          <span class="curve-name" title=${curve.path}>${nameOf(curve.path)}</span>
          <b class="number">${valueText(this.valueOf(curve.path, moment))}</b>
          ${this.isNumber(curve.path) && html`<button class="axis-choice" title="The axis of this curve: left or right" aria-label=${`Axis of ${curve.path}`} onClick=${() => this.switchAxis(curve)}>${curve.axis === "left" ? "L" : "R"}</button>`}
          <button class="tool" aria-label=${`Remove ${curve.path}`} title="Remove" onClick=${() => changePlot(id, { curves: curves.filter((each) => each !== curve) })}><${Icon} name="close" /></button>
        </li>`)}
      </ul>
      <div class="plot-area" ref=${this.area}>
        ${!curves.length && html`<p class="empty">Drag a value here, choose <b class="plus">+</b> beside it, or search with “Add value”.</p>`}
      </div>
      <canvas class="plot-bands" ref=${this.bands}></canvas>
    </div>`;
  }

  // -- what is plotted

  isNumber(path) {
    return (this.watched.get(path)?.kind ?? "number") === "number";
  }

  valueOf(path, t) {
    const detail = this.zoom && this.detail.get(path);
    const series = detail || this.watched.get(path);
    return series && t <= length() ? valueAt(series, t) : undefined;
  }

  watchCurves() {
    const wanted = new Set(this.config.curves.map((curve) => curve.path));
    for (const path of [...this.watched.keys()]) {
      if (wanted.has(path)) continue;
      unwatch(path);
      this.watched.delete(path);
    }
    for (const path of wanted) if (!this.watched.has(path)) this.watched.set(path, watch(path));
  }

  update() {
    if (!this.area.current) return;
    this.watchCurves();
    if (compared.id !== this.otherId || [...this.watched.keys()].some((path) => !this.others.has(path))) this.loadOthers();
    const shape = JSON.stringify([this.config.curves, this.config.curves.map(({ path }) => this.isNumber(path)), document.documentElement.dataset.theme, compared.id]);
    if (shape !== this.shape) {
      this.shape = shape;
      this.build();
    }
    if (!this.plot) return this.drawBands();
    const [from, to] = this.range();
    this.plot.batch(() => {
      this.plot.setData(this.columns(this.plot.width), false);
      this.plot.setScale("x", { min: from, max: to });
    });
    this.drawBands();
  }

  // The columns for uPlot: the curves until now, and those of the branch until its end.
  columns(width) {
    const [from, to] = this.range();
    const curves = this.lines.map((line) => ({ until: length(), ...this.seriesOf(line) }));
    return aligned(curves, from, Math.min(to, this.end), width);
  }

  // The end of what there is.
  get end() {
    return Math.max(length(), compared.end);
  }

  seriesOf({ path, other }) {
    if (other) return this.others.get(path) ?? { t: [], v: [] };
    return (this.zoom && this.detail.get(path)) || this.watched.get(path);
  }

  range() {
    if (this.zoom) return this.zoom;
    const { seconds } = this.config;
    if (!seconds) return [0, Math.max(this.end, 1)];
    const end = Math.max(model.past?.t ?? model.t, seconds);
    return [end - seconds, end];
  }

  async loadOthers() {
    this.otherId = compared.id;
    this.others = new Map([...this.watched.keys()].map((path) => [path, { t: [], v: [] }]));
    if (compared.id === null || !this.watched.size) return;
    const until = compared.end;
    const answer = await ask("plot", { paths: [...this.watched.keys()], from: 0, to: until, points: 4000, branch: compared.id }).catch(() => null);
    if (!answer || this.otherId !== compared.id) return;
    this.others = new Map(Object.entries(answer.series).map(([path, one]) => [path, { ...one, until }]));
    model.announce("series");
  }

  // -- the plot

  build() {
    this.plot?.destroy();
    this.plot = null;
    const curves = this.config.curves.filter(({ path }) => this.isNumber(path));
    if (!curves.length) return;
    this.lines = [...curves, ...(compared.id === null ? [] : curves.map((curve) => ({ ...curve, other: true })))];
    const { width, height } = this.size;
    const hasLeft = curves.some((curve) => curve.axis === "left");
    const hasRight = curves.some((curve) => curve.axis === "right");
    const axis = { stroke: color("muted"), font: font(11), grid: { stroke: color("grid"), width: 1 }, ticks: { stroke: color("grid"), width: 1, size: 4 } };
    this.plot = new uPlot(
      {
        width: Math.max(width, 80),
        height: Math.max(height, 60),
        legend: { show: false },
        cursor: { y: false, sync: { key: sync.key, setSeries: false }, drag: { x: true, y: false, setScale: false }, points: { size: 7 }, bind: { dblclick: () => () => this.follow(this.config.seconds) } },
        scales: { x: { time: false, auto: false }, left: { range: padded }, right: { range: padded } },
        series: [{}, ...this.lines.map((line) => ({
          scale: line.axis,
          stroke: color(`curve-${line.color}`),
          width: line.other ? 1.25 : 1.75,
          dash: line.other ? [6, 4] : undefined,
          paths: uPlot.paths.stepped({ align: 1 }),
          points: { show: false },
          spanGaps: false,
        }))],
        axes: [
          { ...axis, size: 26, space: 60, values: (_, ticks) => ticks.map(clockTick) },
          { ...axis, scale: "left", show: hasLeft || !hasRight, size: 56, space: tickSpace, values: tickTexts },
          { ...axis, scale: "right", side: 1, show: hasRight, size: 56, space: tickSpace, values: tickTexts, grid: { show: !hasLeft, stroke: color("grid"), width: 1 } },
        ],
        hooks: {
          setSelect: [(plot) => this.select(plot)],
          setCursor: [(plot) => this.hover(plot)],
          draw: [(plot) => this.drawMoment(plot)],
        },
      },
      this.columns(width),
      this.area.current,
    );
    this.plot.over.addEventListener("wheel", this.wheel, { passive: false });
    this.plot.over.addEventListener("click", (event) => event.detail === 1 && event.altKey && look(this.plot.posToVal(event.offsetX, "x")));
  }

  resize() {
    const { width, height } = this.size;
    if (this.plot && width > 40 && height > 40) this.plot.setSize({ width, height });
    this.drawBands();
  }

  select(plot) {
    const { left, width } = plot.select;
    if (width < 4) return;
    this.zoomTo(plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
    plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  }

  hover(plot) {
    const { left, idx } = plot.cursor;
    const at = left >= 0 && idx !== null && idx !== undefined ? plot.posToVal(left, "x") : null;
    if (at !== this.state.at) this.setState({ at });
  }

  wheel = (event) => {
    event.preventDefault();
    const [from, to] = this.range();
    const at = this.plot.posToVal(event.offsetX, "x");
    const factor = Math.exp(event.deltaY * 0.0015);
    this.zoomTo(at - (at - from) * factor, at + (to - at) * factor);
  };

  zoomTo(from, to) {
    const end = Math.max(this.end, 0.1);
    this.zoom = [Math.max(from, 0), Math.min(Math.max(to, from + 0.04), end)];
    clearTimeout(this.detailTimer);
    this.detailTimer = setTimeout(() => this.loadDetail(), 120);
    this.setState({});
  }

  async loadDetail() {
    if (!this.zoom || !this.watched.size) return;
    const [from, to] = this.zoom;
    const points = Math.max(this.plot?.width ?? 400, 200) * 2;
    const answer = await ask("plot", { paths: [...this.watched.keys()], from, to, points, branch: null }).catch(() => null);
    if (!answer || !this.zoom || this.zoom[0] !== from || this.zoom[1] !== to) return;
    this.detail = new Map(Object.entries(answer.series));
    this.setState({});
  }

  follow(seconds) {
    this.zoom = null;
    this.detail = new Map();
    changePlot(this.props.id, { seconds });
    this.setState({});
  }

  drawMoment(plot) {
    if (!model.past) return;
    const x = plot.valToPos(model.past.t, "x", true);
    const { left, top, width, height } = plot.bbox;
    if (x < left || x > left + width) return;
    plot.ctx.fillStyle = color("past");
    plot.ctx.fillRect(x - devicePixelRatio / 2, top, Math.max(devicePixelRatio, 1.5), height);
  }

  drawBands() {
    const canvas = this.bands.current;
    if (!canvas || !this.size.width) return;
    const curves = this.config.curves.filter(({ path }) => !this.isNumber(path));
    canvas.style.display = curves.length ? "block" : "none";
    if (!curves.length) return;
    const { width } = this.size;
    const inside = this.plot ? { left: this.plot.bbox.left / devicePixelRatio, width: this.plot.bbox.width / devicePixelRatio } : { left: 8, width: width - 16 };
    const bands = curves.map((curve) => ({ ...curve, series: this.seriesOf(curve) }));
    drawBands(canvas, bands, { width, inside, band: BAND, range: this.range(), now: length(), past: model.past?.t });
  }

  switchAxis(curve) {
    const axis = curve.axis === "left" ? "right" : "left";
    changePlot(this.props.id, { curves: this.config.curves.map((each) => (each === curve ? { ...each, axis } : each)) });
  }

  save = async () => {
    const paths = [...this.watched.keys()];
    const [from, to] = this.zoom ?? [0, length()];
    const answer = await ask("plot", { paths, from, to, points: 200000, branch: null }).catch((error) => model.set("problem", error.message));
    if (answer?.series) download(`${this.props.id.replace(":", "-")}.csv`, csvOf(paths, answer.series), "text/csv");
  };

  over = (event) => {
    if (!hasPath(event)) return;
    event.preventDefault();
    if (!this.state.over) this.setState({ over: true });
  };

  drop = (event) => {
    this.setState({ over: false });
    const path = carriedPath(event);
    if (!path) return;
    event.preventDefault();
    addToPlot(path, this.props.id);
  };
}

function tickTexts(_, ticks) {
  return ticks.map((tick) => (tick === null ? "" : shownNumber(tick)));
}

// How far apart numbers are on a vertical axis, in pixels: closer in a low plot, which has few of them.
function tickSpace(_plot, _axis, _low, _high, height) {
  return Math.min(24, Math.max(12, height / 3));
}

// A little free space above and below; a constant has some, too.
function padded(_, low, high) {
  if (low === null || high === null) return [-1, 1];
  const space = (high - low) * 0.06 || Math.max(Math.abs(low) * 0.1, 0.5);
  return [low - space, high + space];
}
