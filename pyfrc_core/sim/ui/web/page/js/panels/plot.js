// Values over time. Curves are added by "+" or by dragging a value here; dragging in the plot or
// the wheel zooms, a double click follows again. In a log, a click goes to that moment; while a robot is driven, Alt and a click.
import { ElementSize, Picture } from "#js/canvas.js";
import { compared } from "#js/compare.js";
import { ask } from "#js/connection.js";
import { Computed, curveValue, isComputed, keyOf, pathsOf, titleOf, unitOf } from "#js/curves.js";
import { numberIn } from "#js/format.js";
import { gapsOf } from "#js/gaps.js";
import { goTo } from "#js/input/moment_keys.js";
import { model } from "#js/model.js";
import { length } from "#js/past.js";
import { buildChart } from "#js/plot_chart.js";
import { aligned, csvOf, download } from "#js/plot_data.js";
import { statistics } from "#js/plot_math.js";
import { drawBands, drawGaps, drawMoment } from "#js/plot_overlays.js";
import { PlotPicker } from "#js/plot_picker.js";
import { addCurve, addToPlot, carriedPath, changePlot, hasPath, plotOf } from "#js/plotting.js";
import { unwatch, watch } from "#js/series.js";
import { Icon, Live, classes, createRef, html } from "#js/view.js";
import { onWheel } from "#js/wheel.js";
import { AbsentCurves, isAbsent } from "#js/panels/absent_curves.js";
import { PlotAxes } from "#js/panels/plot_axes.js";
import { PlotLegend } from "#js/panels/plot_legend.js";

const SPANS = [[5, "5 s"], [20, "20 s"], [60, "1 min"], [0, "All"]];
const BAND = 20; // pixels of height for each boolean or text
const TABLE_INTERVAL = 150; // milliseconds between two tables of statistics
const LONG = 60; // seconds, of which a packet is less than a pixel
const AROUND = 2; // seconds that are shown before and after what a person is led to
const DETAIL = 8000; // points of a curve while a plot is zoomed

export class PlotPanel extends Live {
  parts = ["series", "t", "shown", "settings", "window", "compared-series", "compared", "found"];
  state = { over: false, at: null };
  area = createRef();
  bands = createRef();
  watched = new Map(); // path: series
  zoom = null; // [from, to] while zoomed in; otherwise the plot follows
  detail = new Map(); // path: series of the zoomed part, in detail
  others = new Map(); // path: series of the compared branch
  computed = new Computed();
  picture = new Picture();
  moment = new Picture();

  componentDidMount() {
    super.componentDidMount();
    this.modes = watch("sim.mode");
    this.size = new ElementSize(this.area.current, () => this.resize());
    this.update();
  }

  componentWillUnmount() {
    super.componentWillUnmount();
    this.size.disconnect();
    for (const path of ["sim.mode", ...this.watched.keys()]) unwatch(path);
    this.plot?.destroy();
    this.plot = null;
  }

  componentDidUpdate() {
    this.update();
  }

  // As the person has arranged it; or, in a widget, what its dashboard says.
  get config() {
    return this.props.plot ?? plotOf(this.props.id);
  }

  set(change) {
    if (!this.props.plot) changePlot(this.props.id, change);
  }

  get ranges() {
    return this.config.ranges ?? {};
  }

  // The curves that there are, without those of another log.
  get curves() {
    return this.config.curves.filter(({ path }) => !isAbsent(this.watched.get(path), this.others.get(path)));
  }

  render({ id, plot: widget }, { over, at }) {
    const { seconds, table: isTable } = this.config;
    const { curves } = this;
    const absent = this.config.curves.filter((curve) => !curves.includes(curve));
    this.interval = isTable ? TABLE_INTERVAL : 0;
    const moment = at ?? model.past?.t ?? model.t;
    const isNumber = ({ path }) => this.isNumber(path);
    const plot = { curves, isNumber, change: this.change, remove: this.remove, copy: (curve) => addCurve(id, { ...curve, hidden: undefined }) };
    return html`<div class=${classes({ plot: true, content: true, column: true, over })} onDragOver=${this.over} onDragLeave=${() => this.setState({ over: false })} onDrop=${this.drop}>
      ${!widget && html`<div class="panel-tools flex">
        <div class="segments small" role="group" aria-label="Time that is shown">
          ${SPANS.map(([span, text]) => html`<button key=${span} class=${classes({ chosen: !this.zoom && seconds === span })} aria-pressed=${!this.zoom && seconds === span}
            onClick=${() => this.follow(span)}>${text}</button>`)}
        </div>
        ${this.zoom && html`<button class="quiet" onClick=${() => this.follow(seconds)}>Follow again</button>`}
        <div class="spacer"></div>
        <${AbsentCurves} curves=${absent} remove=${() => this.set({ curves: this.curves })} />
        <${PlotPicker} stays add=${(path) => addToPlot(path, id)} />
        ${curves.length > 0 && html`<${PlotAxes} axes=${this.axes()} ranges=${() => this.ranges} limits=${this.limits} setRange=${this.setRange}
          hold=${Boolean(this.zoom)} setHold=${(hold) => (hold ? this.zoomTo(...this.range()) : this.follow(seconds))} />
        <button class=${classes({ quiet: true, chosen: isTable })} aria-pressed=${Boolean(isTable)} title="Minimum, mean and maximum of what is in view" onClick=${() => this.set({ table: !isTable })}>Table</button>`}
        <button class="quiet" title="Save the values as CSV" aria-label="Save the values as CSV" disabled=${!curves.length} onClick=${this.save}><${Icon} name="download" />CSV</button>
        <button class="quiet" title="Remove all curves" disabled=${!curves.length} onClick=${() => this.set({ curves: absent, ranges: {} })}>Clear</button>
      </div>`}
      <${PlotLegend} plot=${plot} bare=${Boolean(widget)} isTable=${isTable && curves.length > 0} hasBranch=${compared.id !== null} isNumber=${isNumber}
        shownOf=${(curve) => this.valueOf(curve, moment)} statisticsOf=${(curve) => this.statisticsOf(curve)} />
      <div class="plot-area fill" ref=${this.area}>
        ${!curves.length && html`<p class="empty">Drag a value here, choose <b class="plus">+</b> beside it, or search with “Add value”.</p>`}
      </div>
      <canvas class="plot-bands" ref=${this.bands} onClick=${this.goToState}></canvas>
    </div>`;
  }

  change = (curve, changes) => {
    const changed = (each) => ({ ...each, ...(typeof changes === "function" ? changes(each) : changes) });
    this.set({ curves: this.config.curves.map((each) => (keyOf(each) === keyOf(curve) ? changed(each) : each)) });
  };

  remove = (curve) => {
    this.set({ curves: this.config.curves.filter((each) => keyOf(each) !== keyOf(curve)) });
  };

  setRange = (axis, limits) => {
    const { [axis]: _, ...others } = this.ranges;
    this.set({ ranges: limits ? { ...others, [axis]: limits } : others });
  };

  // The axes whose limits can be set, and what they show.
  axes() {
    const used = new Set(this.curves.filter(({ path }) => this.isNumber(path)).map((curve) => curve.axis));
    return ["left", "right"].filter((axis) => used.has(axis));
  }

  limits = (axis) => {
    const { min, max } = this.plot?.scales[axis] ?? {};
    return [min ?? 0, max ?? 1];
  };

  // -- what is plotted

  isNumber(path) {
    return (this.watched.get(path)?.kind ?? "number") === "number";
  }

  valueOf(curve, t) {
    return curve.other || t <= length() ? curveValue(this.seriesOf(curve), t) : undefined;
  }

  statisticsOf(curve) {
    const one = this.seriesOf(curve);
    const [from, to] = this.range();
    return one && statistics({ t: one.t, v: one.v.map(numberIn) }, from, Math.min(to, one.until ?? length()));
  }

  watchCurves() {
    const wanted = new Set(pathsOf(this.config.curves));
    for (const path of [...this.watched.keys()]) {
      if (wanted.has(path)) continue;
      unwatch(path);
      this.watched.delete(path);
    }
    for (const path of wanted) if (!this.watched.has(path)) this.watched.set(path, watch(path));
  }

  // Zoom in on a value that a person is led to.
  find() {
    const { found } = model;
    if (!found || found === this.found || !this.watched.has(found.path)) return;
    this.found = found;
    this.zoomTo(found.t - AROUND, found.t + AROUND);
  }

  update() {
    if (!this.area.current) return;
    this.watchCurves();
    this.find();
    if (compared.key !== this.otherKey || [...this.watched.keys()].some((path) => !this.others.has(path))) this.loadOthers();
    const shape = JSON.stringify([this.curves, this.curves.map(({ path }) => this.isNumber(path)), document.documentElement.dataset.theme, compared.id]);
    if (shape !== this.shape) {
      this.shape = shape;
      this.build();
    }
    if (!this.plot) return this.drawBands();
    const isOther = this.picture.changes(...this.drawn());
    const isMoved = this.moment.changes(model.past?.t);
    if (isOther) this.drawCurves();
    else if (isMoved) this.plot.redraw(false);
    else return;
    this.drawBands();
  }

  // What the curves are drawn of: while only the moment that is shown moves, they stay as they are. A long time is drawn
  // again when it has moved by about a pixel, a short one with each change; what comes after it changes nothing.
  drawn() {
    const [from, to] = this.range();
    const { width, height } = this.plot;
    const step = 2 ** Math.floor(Math.log2((to - from) / width));
    const moments = [from, to, Math.min(length(), to)].map((t) => Math.floor(t / step));
    const series = [...this.watched.values(), this.modes];
    const lengths = to - from < LONG && to >= length() ? series.map(({ t }) => t.length) : [];
    return [this.plot, width, height, JSON.stringify(this.ranges), this.detail, this.others, model.run, ...moments, ...series.map(({ t }) => t), ...lengths];
  }

  drawCurves() {
    const [from, to] = this.range();
    this.plot.batch(() => {
      this.plot.setData(this.columns(this.plot.width), false);
      this.plot.setScale("x", { min: from, max: to });
    });
  }

  // The data for uPlot: the curves until now, and those of the branch until its end.
  columns(width) {
    const [from, to] = this.range();
    const curveOf = (line) => {
      const one = this.seriesOf(line) ?? { t: [], v: [] };
      return { ...one, until: one.until ?? length() };
    };
    return aligned(this.lines.map(curveOf), from, Math.min(to, this.end), width);
  }

  // The end of what there is.
  get end() {
    return Math.max(length(), compared.end);
  }

  seriesOf(curve) {
    const key = keyOf(curve);
    if (curve.other) return this.computed.of(curve, `${key} other`, (path) => this.others.get(path) ?? { t: [], v: [] }, this.end);
    const whole = (path) => this.watched.get(path);
    if (!this.zoom || !this.detail.has(curve.path)) return this.computed.of(curve, key, whole, length());
    const before = () => curveValue(this.computed.of(curve, key, whole, length()), this.zoom[0]) ?? 0;
    return this.computed.of(curve, `${key} detail`, (path) => this.detail.get(path) ?? whole(path), Math.min(length(), this.zoom[1]), before);
  }

  range() {
    if (this.zoom) return this.zoom;
    const { seconds } = this.config;
    if (!seconds) return [0, Math.max(this.end, 1)];
    const end = Math.max(model.past?.t ?? model.t, seconds);
    return [end - seconds, end];
  }

  async loadOthers() {
    this.otherKey = compared.key;
    this.others = new Map([...this.watched.keys()].map((path) => [path, { t: [], v: [] }]));
    if (compared.id === null || !this.watched.size) return;
    const until = compared.end;
    const answer = await ask("plot", { paths: [...this.watched.keys()], from: 0, to: until, points: 4000, branch: compared.id }).catch(() => null);
    if (!answer || this.otherKey !== compared.key) return;
    this.others = new Map(Object.entries(answer.series).map(([path, one]) => [path, { ...one, until }]));
    model.announce("series");
  }

  // -- the plot

  build() {
    this.plot?.destroy();
    this.plot = null;
    const curves = this.curves.filter(({ path }) => this.isNumber(path));
    if (!curves.length) return;
    this.lines = [...curves, ...(compared.id === null ? [] : curves.map((curve) => ({ ...curve, other: true })))];
    const { width, height } = this.size;
    this.plot = buildChart(
      this.area.current,
      {
        width,
        height,
        lines: this.lines,
        ranges: () => this.ranges,
        setRange: this.setRange,
        dblclick: () => this.follow(this.config.seconds),
        hooks: {
          setSelect: [(plot) => this.select(plot)],
          setCursor: [(plot) => this.hover(plot)],
          drawAxes: [(plot) => drawGaps(plot, gapsOf(this.modes, length()))],
          draw: [drawMoment],
        },
      },
      this.columns(width),
    );
    onWheel(this.plot.over, { zoom: this.zoomBy, move: this.moveBy });
    this.plot.over.addEventListener("click", (event) => isMeant(event) && goTo(this.plot.posToVal(event.offsetX, "x")));
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

  zoomBy = (factor, event) => {
    const [from, to] = this.range();
    const at = this.plot.posToVal(event.offsetX, "x");
    this.zoomTo(at - (at - from) * factor, at + (to - at) * factor);
  };

  // By as many pixels, as far as there is something.
  moveBy = (pixels) => {
    const [from, to] = this.range();
    const by = (pixels / this.plot.over.clientWidth) * (to - from);
    const inside = Math.max(-from, Math.min(by, Math.max(this.end - to, 0)));
    if (inside) this.zoomTo(from + inside, to + inside);
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
    const answer = await ask("plot", { paths: [...this.watched.keys()], from, to, points: DETAIL, branch: null }).catch(() => null);
    if (!answer || !this.zoom || this.zoom[0] !== from || this.zoom[1] !== to) return;
    this.detail = new Map(Object.entries(answer.series).map(([path, one]) => [path, { ...one, exactFrom: one.thinned ? to : 0 }]));
    this.setState({});
  }

  follow(seconds) {
    this.zoom = null;
    this.detail = new Map();
    this.set({ seconds });
    this.setState({});
  }

  // Where time is, across the panel.
  get inside() {
    if (!this.plot) return { left: 8, width: this.size.width - 16 };
    return { left: this.plot.bbox.left / devicePixelRatio, width: this.plot.bbox.width / devicePixelRatio };
  }

  goToState = (event) => {
    const { left, width } = this.inside;
    const share = (event.offsetX - left) / width;
    const [from, to] = this.range();
    if (isMeant(event) && share >= 0 && share <= 1) goTo(from + share * (to - from));
  };

  drawBands() {
    const canvas = this.bands.current;
    if (!canvas || !this.size.width) return;
    const curves = this.curves.filter(({ path, hidden }) => !hidden && !this.isNumber(path));
    canvas.style.display = curves.length ? "block" : "none";
    if (!curves.length) return;
    const { width } = this.size;
    const { inside } = this;
    const withOther = (curve) => [curve, ...(compared.id === null ? [] : [{ ...curve, other: compared.branch?.name || "branch" }])];
    const bands = curves.flatMap(withOther).map((curve) => ({ ...curve, series: this.seriesOf(curve), kind: this.watched.get(curve.path)?.kind }));
    drawBands(canvas, bands, { width, inside, band: BAND, range: this.range(), now: length(), past: model.past?.t });
  }

  save = async () => {
    const paths = [...this.watched.keys()];
    const [from, to] = this.zoom ?? [0, length()];
    const answer = await ask("plot", { paths, from, to, points: 200000, branch: null }).catch((error) => model.set("problem", error.message));
    if (!answer?.series) return;
    const rawOf = (path) => ({ ...answer.series[path], exactFrom: answer.series[path].thinned ? to : 0 });
    const before = (curve) => () => (from ? (curveValue(this.computed.of(curve, keyOf(curve), (path) => this.watched.get(path), length()), from) ?? 0) : 0);
    const columns = this.curves.map((curve) => [
      isComputed(curve) ? [titleOf(curve), unitOf(curve)].filter(Boolean).join(", ") : curve.path,
      new Computed().of(curve, "saved", rawOf, Math.min(to, length()), before(curve)),
    ]);
    download(`${this.props.id.replace(":", "-")}.csv`, csvOf(columns.map(([name]) => name), Object.fromEntries(columns)), "text/csv");
  };

  over = (event) => {
    if (!hasPath(event) || this.props.plot) return;
    event.preventDefault();
    if (!this.state.over) this.setState({ over: true });
  };

  drop = (event) => {
    this.setState({ over: false });
    const path = carriedPath(event);
    if (!path || this.props.plot) return;
    event.preventDefault();
    addToPlot(path, this.props.id);
  };
}

// Whether a click asks for its moment. While a robot is driven, a slip of the hand must not lead to the past.
function isMeant(event) {
  return event.detail === 1 && (event.altKey || !model.isDriven);
}
