// The chart of a plot, which uPlot draws: curves over time.
import uPlot from "#vendor/uplot/uPlot.esm.js";
import { font } from "#js/canvas.js";
import { dashOf, strokeOf } from "#js/curves.js";
import { clockTick, shownNumber } from "#js/format.js";
import { color } from "#js/settings.js";
import { onWheel } from "#js/wheel.js";

const sync = uPlot.sync("time"); // the cursor is at the same moment in every plot
const TIME_STEPS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 18000];
const SIDES = ["x", "left", "right"]; // uPlot's axes, in their order; the panel zooms time
const DASHED = [6, 4]; // of the compared branch

// Build a chart in an element.
// lines: curves, those of the branch with `other: true`
// ranges(): the limits that the person has set, by axis; setRange(axis, limits): others, or null for automatic ones
// hooks: uPlot's
export function buildChart(element, { width, height, lines, ranges, setRange, hooks, dblclick }, data) {
  const shown = lines.filter((line) => !line.hidden);
  const hasRight = shown.some((line) => line.axis === "right");
  const hasLeft = !hasRight || shown.some((line) => line.axis === "left");
  const axis = { stroke: color("muted"), font: font(11), grid: { stroke: color("grid"), width: 1 }, ticks: { stroke: color("grid"), width: 1, size: 4 } };
  const limited = (_, low, high, key) => ranges()[key] ?? padded(low, high);
  const chart = new uPlot(
    {
      width: Math.max(width, 80),
      height: Math.max(height, 60),
      legend: { show: false },
      cursor: { y: false, sync: { key: sync.key, setSeries: false }, drag: { x: true, y: false, setScale: false }, points: { size: 7 }, bind: { dblclick: () => dblclick } },
      scales: { x: { time: false, auto: false }, left: { range: limited }, right: { range: limited } },
      series: [{}, ...lines.map((line) => ({
        scale: line.axis,
        show: !line.hidden,
        stroke: strokeOf(line),
        width: line.other ? 1.25 : 1.75,
        alpha: line.other && dashOf(line).length ? 0.5 : 1,
        dash: dashOf(line).length ? dashOf(line) : line.other ? DASHED : undefined,
        paths: line.math ? uPlot.paths.linear() : uPlot.paths.stepped({ align: 1 }),
        points: { show: false },
        spanGaps: false,
      }))],
      axes: [
        { ...axis, size: 26, space: 60, incrs: TIME_STEPS, values: (_, ticks) => ticks.map(clockTick) },
        { ...axis, scale: "left", show: hasLeft, size: 56, space: tickSpace, values: tickTexts },
        { ...axis, scale: "right", side: 1, show: hasRight, size: 56, space: tickSpace, values: tickTexts, grid: { show: !hasLeft, stroke: color("grid"), width: 1 } },
      ],
      hooks: { ...hooks, ready: [(plot) => holdAxes(plot, setRange)] },
    },
    data,
    element,
  );
  return chart;
}

// An axis under the pointer: the wheel zooms, dragging moves, a double click makes it automatic again.
function holdAxes(plot, setRange) {
  const elements = plot.root.querySelectorAll(".u-axis");
  const axes = SIDES.filter((_, index) => plot.axes[index].show);
  axes.forEach((key, index) => {
    if (key === "x") return;
    const element = elements[index];
    const limits = () => [plot.scales[key].min, plot.scales[key].max];
    element.classList.add("axis-handle");
    element.title = "The wheel zooms this axis, dragging moves it, a double click makes it automatic";
    const zoom = (factor, event) => {
      const at = plot.posToVal(event.clientY - plot.over.getBoundingClientRect().top, key);
      setRange(key, limits().map((limit) => at + (limit - at) * factor));
    };
    onWheel(element, { zoom });
    element.addEventListener("pointerdown", (down) => {
      const before = limits();
      const move = (event) => {
        const by = ((event.clientY - down.clientY) / plot.over.clientHeight) * (before[1] - before[0]);
        setRange(key, before.map((limit) => limit + by));
      };
      element.setPointerCapture(down.pointerId);
      element.addEventListener("pointermove", move);
      element.addEventListener("lostpointercapture", () => element.removeEventListener("pointermove", move), { once: true });
    });
    element.addEventListener("dblclick", () => setRange(key, null));
  });
}

function tickTexts(_, ticks) {
  return ticks.map((tick) => (tick === null ? "" : shownNumber(tick)));
}

// How far apart numbers are on a vertical axis, in pixels: closer in a low plot, which has few of them.
function tickSpace(_plot, _axis, _low, _high, height) {
  return Math.min(24, Math.max(12, height / 3));
}

// A little free space above and below; a constant has some, too.
function padded(low, high) {
  if (low === null || high === null) return [-1, 1];
  const space = (high - low) * 0.06 || Math.max(Math.abs(low) * 0.1, 0.5);
  return [low - space, high + space];
}
