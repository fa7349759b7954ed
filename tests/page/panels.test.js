// What panels and their controls do, without a browser: what they render, and what they send to the server.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame, elements, serve } from "./browser.js";

const sent = serve();
const { model } = await import("#js/model.js");
const { connect } = await import("#js/connection.js");
const { PlotButton, Select, Switch, TextBox } = await import("#js/controls.js");
const { DevicesPanel } = await import("#js/panels/devices.js");
const { FieldPanel } = await import("#js/panels/field.js");
const { Dock } = await import("#js/layout/dock.js");
const { changeText } = await import("#js/format.js");
const { FailureBar } = await import("#js/failure.js");
const { ConsolePanel, grouped } = await import("#js/panels/console.js");
const { FirstDifference } = await import("#js/panels/differences.js");
const { frontOf } = await import("#js/layout/open.js");
const { Chooser, MatchPanel } = await import("#js/panels/match.js");
const { playback } = await import("#js/playback.js");
const { driveOn } = await import("#js/past.js");
const { Notice } = await import("#js/notice.js");
const { Menu } = await import("#js/popup.js");
const { PlotPicker } = await import("#js/plot_picker.js");
const { addToPlot } = await import("#js/plotting.js");
const { TimeBar } = await import("#js/timebar.js");
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

test("the console shows the levels and the words that a person wants, until the moment that is shown", () => {
  const line = (n, level, text) => ({ n, t: n, level, text });
  model.take({ type: "update", console: [line(1, "info", "hello"), line(2, "warning", "Low WARNING"), line(3, "error", "warned")] });
  const panel = new ConsolePanel({});
  const shown = (search = "") => {
    const found = elements(panel.render({}, { search, shown: 150 }));
    return [...found.filter((each) => each.props.line).map(({ props }) => props.line.text), ...found.filter((each) => each.props.class === "empty").map(({ props }) => props.children)];
  };
  assert.deepEqual([shown(), shown("warn"), shown("nothing")], [["hello", "Low WARNING", "warned"], ["Low WARNING", "warned"], ["No line matches."]]);
  const warnings = elements(panel.render({}, panel.state)).find((each) => each.key === "warning");
  warnings.props.onClick();
  assert.deepEqual(shown(), ["hello", "warned"]);
  warnings.props.onClick();
  model.show({ t: 2, values: new Map() });
  assert.deepEqual(shown(), ["hello", "Low WARNING"]);
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

test("what the robot publishes is offered first, then what it outputs, then its sensors and all else", () => {
  const row = (label, path, settable = false) => ({ label, settable, paths: [path] });
  const values = ["joysticks[0].axes[0]", "pwm[0].raw_value", "analog_in[0].voltage", "pwm[0].value", "nt:/FMSInfo/EventName0", "nt:/SmartDashboard/kP0"];
  model.take({
    type: "update", values: Object.fromEntries(values.map((path) => [path, 0])),
    panels: [{ title: "PWM", rows: [row("0  left motor", "pwm[0].value"), row("0  Analog", "analog_in[0].voltage", true)] }],
  });
  const offered = (search) => render(PlotPicker, { add() {} }, { open: true, search }).filter((each) => each.type === "button" && each.props.title).map(({ props }) => props.title);
  assert.deepEqual(offered("0"), ["nt:/SmartDashboard/kP0", "pwm[0].value", "analog_in[0].voltage", "joysticks[0].axes[0]", "nt:/FMSInfo/EventName0", "pwm[0].raw_value"]);
  assert.deepEqual(offered("left motor"), ["pwm[0].value"]);
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
  const list = one(elements(Chooser({ chooser: { name: "/SmartDashboard/Auto", options: ["Stay", "Go"], active: "Stay" } })), Select, { "aria-label": "Auto" });
  sent.length = 0;
  list.props.set("Go");
  assert.deepEqual([list.props.value, sent[0].name, sent[0].chooser, sent[0].option], ["Stay", "choose", "/SmartDashboard/Auto", "Go"]);
});

test("a row of the devices is pinned to the top and stays there", () => {
  const row = (path, label) => ({ paths: [path], label, kind: "lamp", tooltip: "" });
  model.take({ type: "update", panels: [{ title: "Analog", rows: [row("analog_in[2].voltage", "2 range finder")] }, { title: "PWM", rows: [row("pwm[0].value", "0")] }] });
  const groups = (search = "") => render(DevicesPanel, {}, { search, closed: {} }).filter((each) => each.type?.name === "Group");
  const tools = (group) => elements(group.type(group.props)).filter((each) => each.props.pin).map(({ props }) => props);
  assert.deepEqual(groups("range").map(({ props }) => props.title), ["Analog"]);
  tools(groups()[0])[0].pin();
  assert.deepEqual(settings.get("pins"), ["analog_in[2].voltage"]);
  const [pinned] = groups();
  assert.deepEqual([pinned.props.title, tools(pinned)[0].row.label, tools(pinned)[0].pinned], ["Pinned", "2 range finder", true]);
  tools(pinned)[0].pin();
  assert.deepEqual(settings.get("pins"), []);
});

test("each motor has one row above its devices, which are closed when they have many values, but for a search", () => {
  const row = (device, name, kind = "number") => ({ paths: [`${device}.${name}`], label: `  ${name}`, kind, tooltip: "" });
  const device = (number, label) => [
    { paths: [], label: `SPARK MAX [${number}]${label}`, kind: "text", tooltip: "" },
    ...["Applied Output", "Velocity", ...Array.from({ length: 10 }, (_, other) => `Other ${other}`)].map((name) => row(number, name)),
  ];
  model.take({ type: "update", panels: [{ title: "CAN and SimDevices", rows: Array.from({ length: 12 }, (_, number) => device(number, number === 2 ? "  front left drive" : "")).flat() }] });
  const groups = (search) => render(DevicesPanel, {}, { search, closed: {} }).filter((each) => each.type?.name === "Group").map(({ props }) => props);
  const table = (group) => {
    const made = group.content();
    return elements(made.type(made.props));
  };
  const [motors, devices] = groups("");
  assert.deepEqual([motors.title, motors.rows.length, devices.title, devices.closed], ["Motors", 12, "CAN and SimDevices", true]);
  assert.equal(table(motors).filter((each) => each.type === "tr").length, 13);
  const plotButtons = table(motors).filter((each) => each.type === PlotButton);
  PlotButton(plotButtons[2].props).props.onClick();
  assert.deepEqual(settings.get("plots")["plot:1"].curves.map(({ path }) => path), ["2.Applied Output", "2.Velocity"]);
  const found = groups("front left");
  assert.deepEqual(found.map(({ rows, closed }) => [rows.length, closed]), [[1, false], [13, false]]);
});

test("places are written as the project says, unless a person chooses otherwise", () => {
  model.hello.field.coordinates = "alliance";
  assert.equal(new FieldPanel({}).coordinates, "alliance");
  settings.set("coordinates", "blue");
  assert.equal(new FieldPanel({}).coordinates, "blue");
  settings.set("coordinates", "");
});

test("a page whose server has gone says which command that was", () => {
  const said = (connection, kind) => {
    model.hello.source.kind = kind;
    model.connection = connection;
    return one(render(Notice), "span").props.children;
  };
  assert.match(said("closed", "simulation"), /^The simulation was closed. This is its last state. Start pyfrc sim again/);
  assert.match(said("closed", "log"), /^pyfrc view has ended. This is its last state. Start pyfrc view again/);
  assert.match(said("lost", "simulation"), /^The connection to pyfrc sim was lost, reconnecting/);
  model.connection = "open";
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

test("a failure has its line, and the ways to go on", () => {
  const failure = { t: 3.5, headline: "robot.py:7: ZeroDivisionError", details: "Traceback", file: "robot.py", line: 7 };
  const shown = (given = {}) => {
    model.take({ type: "update", status: { state: "failed", failure: { ...failure, ...given } } });
    return render(FailureBar);
  };
  const named = (found, name) => found.find((each) => each.type === "button" && [each.props.children].flat().includes(name));
  const found = shown();
  assert.equal(one(found, "strong").props.children, failure.headline);
  assert.deepEqual([found.find((each) => each.props.file).props.line, one(found, "pre").props.children], [7, "Traceback"]);
  for (const name of ["Go back 2 s and drive on", "Load the code again", "Restart"]) named(found, name).props.onClick();
  const commands = sent.filter(({ type }) => type === "command").map(({ name, t }) => [name, t]);
  assert.deepEqual(commands, [["rewind", 1.5], ["reload", undefined], ["restart", undefined]]);
  named(found, "Values of that moment").props.onClick();
  assert.deepEqual([sent.at(-1).type, sent.at(-1).t], ["values", 3.5]);
  assert.equal(named(shown({ headline: "robot.py:7: SyntaxError" }), "Go back 2 s and drive on"), undefined); // it fails again at any moment
  model.hello.options.watch = true;
  assert.equal(named(shown(), "Load the code again"), undefined); // the corrected file is, when it is saved
});

test("time is run, stepped and scaled, up to no limit", () => {
  model.hello.options.speeds = { slowest: 0.1, fastest: 10 };
  const slider = one(render(TimeBar), "input", { "aria-label": "Speed" });
  for (const name of ["Run", "Step"]) one(render(TimeBar), "button", { "aria-label": name }).props.onClick();
  assert.deepEqual(sent.splice(0).map(({ name }) => name), ["toggle", "step"]);
  for (const value of ["1", "0"]) slider.props.onInput({ target: { value } });
  model.take({ type: "update", status: { speed: 0 } });
  const fast = render(TimeBar);
  assert.equal(one(fast, "b").props.children, "max");
  fast.find((each) => each.props.children === "Real time").props.onClick();
  assert.deepEqual(sent.map(({ factor }) => factor), [0, 0.1, 1]);
});
