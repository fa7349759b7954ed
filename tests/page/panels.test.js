// What panels and their controls do, without a browser: what they render, and what they send to the server.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame, elements, serve } from "./browser.js";

const sent = serve();
const { model } = await import("#js/model.js");
const { connect } = await import("#js/connection.js");
const { PlotButton, Select, Switch, TextBox } = await import("#js/controls.js");
const { Dock } = await import("#js/layout/dock.js");
const { changeText } = await import("#js/format.js");
const { grouped } = await import("#js/panels/console.js");
const { FirstDifference } = await import("#js/panels/differences.js");
const { frontOf } = await import("#js/layout/open.js");
const { MatchPanel } = await import("#js/panels/match.js");
const { playback } = await import("#js/playback.js");
const { driveOn } = await import("#js/past.js");
const { Menu } = await import("#js/popup.js");
const { PlotPicker } = await import("#js/plot_picker.js");
const { addToPlot } = await import("#js/plotting.js");
const { unwatch, watch } = await import("#js/series.js");
const { settings } = await import("#js/settings.js");

connect(() => {}, () => {});
await new Promise((resolve) => setTimeout(resolve));

beforeEach(() => {
  model.show(null);
  model.take({
    type: "hello", readonly: false, t: 10, status: { length: 10 }, values: {}, marks: [], branches: [], known_from: 0, choosers: [],
    source: { drives: true, rewinds: true }, field: { starts: { left: [], right: [] } },
    options: { modes: {}, dashboard: { tables: [] }, alliances: { "Red 1": "red1", "Blue 2": "blue2" }, game_messages: [] },
    station: { alliance: "red1", game_message: "" },
  });
  settings.load({ version: 1, layout: "driving", trees: {}, plots: {} });
  sent.length = 0;
});

const render = (Kind, props = {}, state = undefined) => {
  const made = new Kind(props);
  return elements(made.render(props, state ?? made.state ?? {}));
};
const one = (found, type, props = {}) => found.find((each) => each.type === type && Object.entries(props).every(([name, value]) => each.props[name] === value));
const press = (key) => {
  const pressed = { key, done: [], preventDefault: () => pressed.done.push("prevented"), stopPropagation: () => pressed.done.push("stopped") };
  return pressed;
};

test("a box for text is left by Enter, and what was typed is taken over then", () => {
  const taken = [];
  const box = new TextBox({ text: "a" });
  let left = 0;
  box.element.current = { value: "typed", blur: () => (left += 1) };
  box.props = { text: "b" };
  document.activeElement = box.element.current;
  box.componentDidUpdate();
  assert.equal(box.element.current.value, "typed"); // while a person types
  document.activeElement = null;
  box.componentDidUpdate();
  assert.equal(box.element.current.value, "b");
  const [input] = elements(box.render({ text: "b", set: (text) => taken.push(text), placeholder: "none" }));
  input.props.onChange({ target: { value: "c" } });
  assert.deepEqual([taken, input.props.placeholder], [["c"], "none"]);
  for (const key of ["x", "Enter"]) input.props.onKeyDown(press(key));
  assert.equal(left, 1);
});

test("a list has its options, with the chosen one, and says what is chosen", () => {
  const taken = [];
  const found = elements(Select({ value: 2, options: [1, [2, "two"]], set: (value) => taken.push(value), "aria-label": "Number" }));
  const options = found.filter((each) => each.type === "option").map(({ props }) => [props.value, props.children, props.selected]);
  assert.deepEqual(options, [[1, 1, false], [2, "two", true]]);
  one(found, "select", { "aria-label": "Number" }).props.onChange({ target: { value: "1" } });
  assert.deepEqual(taken, ["1"]);
});

test("a switch says whether it is on", () => {
  const taken = [];
  const input = one(elements(Switch({ label: "Flag", on: true, disabled: false, set: (on) => taken.push(on) })), "input");
  assert.deepEqual([input.props.checked, input.props.disabled, input.props["aria-label"]], [true, false, "Flag"]);
  input.props.onChange({ target: { checked: false } });
  assert.deepEqual(taken, [false]);
});

test("the button beside a value plots it, once", () => {
  const button = one(elements(PlotButton({ name: "motors", paths: ["pwm[0].value", undefined, "pwm[1].value"] })), "button");
  for (let times = 0; times < 2; times++) button.props.onClick();
  assert.deepEqual(settings.get("plots")["plot:1"].curves.map(({ path, color }) => [path, color]), [["pwm[0].value", 0], ["pwm[1].value", 1]]);
  assert.deepEqual(settings.tree.children[1].children[1].active, "plot:1"); // and its panel is in front
});

test("a difference is plotted and found in its panel, and the next one takes its place", () => {
  settings.set("plots", { "plot:1": { curves: [{ path: "battery", color: 0 }] } });
  const path = "nt:/SmartDashboard/Elevator/setpoint";
  const shown = [[path, 2.5], ["pwm[1].value", 3], ["battery", 4]].map(([first, t]) => {
    const button = one(elements(FirstDifference({ first: { t, paths: [first], others: [] } })), "button");
    button.props.onClick();
    const curves = settings.get("plots")["plot:1"].curves.map((curve) => curve.path);
    return [curves, model.found.t, settings.tree.children[0].active, settings.tree.children[2].children[1].active];
  });
  assert.deepEqual(shown, [
    [["battery", path], 2.5, "networktables", "differences"],
    [["battery", "pwm[1].value"], 3, "devices", "differences"],
    [["battery"], 4, "devices", "differences"],
  ]);
  // On a narrow screen, in other tabs.
  assert.deepEqual([["field", "plot:1"], ["devices", "differences"], ["match"]].map(frontOf), ["plot:1", "differences", undefined]);
});

test("what could not be compared comes before the result, and nothing is the same that was not compared", () => {
  const text = (first) => elements(FirstDifference({ first })).find((each) => each.type === "span").props.children;
  const none = { t: null, paths: [], others: [], until: 15, limits: ["no joysticks"], mostly: true, compared: 7 };
  assert.deepEqual(
    [none, { ...none, limits: [] }, { ...none, mostly: false }, { ...none, compared: 0 }, { ...none, t: 13, paths: ["nt:/a"] },
      { ...none, t: 13, paths: ["nt:/a"], by_rarity: true, count: 20, limits: [] }].map(text),
    ["Partly compared. No difference up to 0:15.00", "No difference up to 0:15.00", "Partly compared. What was compared does not differ up to 0:15.00",
      "Nothing to compare up to 0:15.00", "Partly compared. Differs first at 0:13.00, in a", "20 values differ: a at 0:13.00"],
  );
});

test("of a list, a change is that of its elements", () => {
  assert.equal(changeText(["Drive", "Hold", "Hold"], ["Drive", "Hold", "Lock"]), "2: Hold → Lock");
  assert.equal(changeText([false], [false, true]), "1: – → true");
  assert.equal(changeText(null, [1]), "– → [1]");
});

test("equal lines that follow each other soon are one, with their number and the last moment", () => {
  const lines = [[1, "a"], [1.2, "a"], [1.9, "a"], [2, "b"], [2.1, "a"], [4, "a"]].map(([t, text]) => ({ t, text, level: "warning" }));
  assert.deepEqual(grouped(lines).map(({ line, count, until }) => [line.t, line.text, count, until]), [[1, "a", 3, 1.9], [2, "b", 1, 2], [2.1, "a", 1, 2.1], [4, "a", 1, 4]]);
});

test("arrow keys move in a list, around its ends, and only while it is open", () => {
  const menu = new Menu({ items: [] });
  const items = [0, 1, 2].map((number) => ({ focus: () => (document.activeElement = items[number]) }));
  menu.element.current = { querySelectorAll: () => items };
  document.activeElement = items[2];
  menu.key(press("ArrowDown"), "");
  assert.equal(document.activeElement, items[2]);
  menu.state = { open: true };
  const seen = ["ArrowDown", "ArrowDown", "ArrowUp", "ArrowUp", "Escape"].map((key) => {
    const pressed = press(key);
    menu.key(pressed, "");
    return [items.indexOf(document.activeElement), pressed.done.length];
  });
  assert.deepEqual(seen, [[0, 2], [1, 2], [0, 2], [2, 2], [2, 0]]);
});

test("everything is asked for while a person searches", () => {
  const picker = new PlotPicker({});
  picker.state = { open: true, search: "" };
  picker.componentDidUpdate();
  assert.deepEqual(model.needs.beginnings, [""]);
  picker.state = { open: false, search: "" };
  picker.componentDidUpdate();
  assert.deepEqual(model.needs.beginnings, []);
});

test("what can be plotted is offered: what there was at the moment that is shown, and a list of texts whole", () => {
  const offered = (search) => render(PlotPicker, { add() {} }, { open: true, search }).filter((each) => each.type === "button" && each.props.title).map(({ props }) => props.title);
  Object.assign(model.hello.options, { buttons: { first: 1 } });
  model.take({ type: "update", values: { "nt:/Names": [], "nt:/Ids": [], "nt:/Modes": ["a"], "nt:/Pose": [1, 2], "joysticks[0].buttons": [false, false, true] } });
  assert.deepEqual(offered("names"), ["nt:/Names"]); // empty at the end
  model.show({ t: 4, values: new Map(Object.entries({ "nt:/Names": ["Score"], "nt:/Ids": [7], "nt:/Gone": 1 })) });
  assert.deepEqual(offered("nt: "), ["nt:/Names", "nt:/Names[0]", "nt:/Ids[0]", "nt:/Modes", "nt:/Modes[0]", "nt:/Pose[0]", "nt:/Pose[1]", "nt:/Gone"]);
  assert.deepEqual(offered("button"), ["joysticks[0].buttons[1]", "joysticks[0].buttons[2]"]);
});

test("a click leaves the list of values open, and a key closes it", () => {
  const done = [];
  const picker = new PlotPicker({});
  picker.close = () => done.push("closed");
  model.take({ type: "update", values: { "nt:/Speed": 1 } });
  const button = one(elements(picker.render({ stays: true, add: (path) => done.push(path) }, { open: true, search: "speed" })), "button", { title: "nt:/Speed" });
  for (const detail of [1, 0]) button.props.onClick({ detail });
  assert.deepEqual(done, ["nt:/Speed", "closed", "nt:/Speed"]);
});

test("values whose units are known to differ have an axis of their own", () => {
  for (const name of ["Yaw", "Arm/goalRad", "HeadingDeg", "pose/rotation/value", "Gyro/Degrees", "Heading (deg)", "Battery"]) addToPlot(`nt:/${name}`);
  assert.deepEqual(settings.get("plots")["plot:1"].curves.map(({ axis }) => axis), ["left", "left", "right", "left", "right", "right", "left"]);
});

test("the panels are as they were arranged, unless the window is narrow or low", () => {
  for (const [width, height, isStacked] of [[1366, 768, false], [901, 481, false], [900, 768, true], [1366, 480, true]]) {
    Object.assign(globalThis, { innerWidth: width, innerHeight: height });
    const [, node] = render(Dock);
    assert.equal(node.props.node !== settings.tree, isStacked, `${width} x ${height}`);
    assert.equal(node.props.narrow, isStacked);
  }
});

test("the choices before a match are commands", () => {
  const found = render(MatchPanel);
  const lists = found.filter((each) => each.type === Select);
  assert.deepEqual(lists[0].props.options, [["red1", "Red 1"], ["blue2", "Blue 2"]]);
  lists[0].props.set("blue2");
  lists[1].props.set("right");
  one(found, TextBox).props.set("LRL");
  const commands = sent.map(({ id: _, type: __, ...fields }) => fields);
  assert.deepEqual(commands, [{ station: "blue2", name: "alliance" }, { start: "right", name: "reset_position" }, { text: "LRL", name: "game_message" }]);
});

test("from a moment of the past the robot is driven on, and not from the present", () => {
  driveOn();
  assert.deepEqual(sent, []);
  model.show({ t: 4.2, values: new Map() });
  driveOn();
  assert.equal(model.past, null);
  assert.deepEqual(sent.map(({ name, t }) => [name, t]), [["rewind", 4.2]]);
});

test("a run plays until it is paused", async () => {
  playback.toggle();
  assert.ok(playback.playing);
  playback.toggle();
  assert.ok(!playback.playing);
  await new Promise((resolve) => setTimeout(resolve));
  drawFrame();
  assert.equal(drawFrame(), 0); // no further frame is asked for
});

test("every change of a watched value is asked for, as long as something watches it", () => {
  const one = watch("pwm[0].value");
  assert.equal(watch("pwm[0].value"), one);
  watch("dio[3].value");
  unwatch("pwm[0].value");
  unwatch("dio[3].value");
  unwatch("pwm[0].value");
  const paths = sent.filter(({ type }) => type === "subscribe").map((each) => each.paths);
  assert.deepEqual(paths, [["pwm[0].value"], ["pwm[0].value", "dio[3].value"], ["pwm[0].value"], []]);
});
