// The keys: those of the Driver Station and of robot time, those that drive, and those that a person has bound.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame, elements, serve } from "./browser.js";

const sent = serve();
const handlers = {};
globalThis.addEventListener = (name, handler) => (handlers[name] = handler);
document.addEventListener = globalThis.addEventListener;
const { model } = await import("#js/model.js");
const { command, connect, write } = await import("#js/connection.js");
const { startKeys } = await import("#js/input/keys.js");
const { KeysPanel } = await import("#js/panels/keys.js");
const { settings } = await import("#js/settings.js");

connect((message) => model.set("problem", message.text), () => {});
startKeys();
await new Promise((resolve) => setTimeout(resolve));

const PAST = "The panels show the past. Choose “Live” to drive the robot, or “Drive on from here”.";
const LAYOUT = { name: "Two joysticks", help: "", axes: { w: [[0, 1, -1]], s: [[0, 1, 1]] } };
const KEYBOARD = { layouts: [LAYOUT], chosen: LAYOUT.name, gentle: 0.4, enable_chord: ["bracketleft", "bracketright", "backslash"], button_keys: { 5: 5 }, button_keys_text: "1" };
const AXIS = "joysticks[0].axes[1]";

beforeEach(() => {
  handlers.blur();
  model.show(null);
  model.take({
    type: "hello", readonly: false, t: 1, status: { length: 1, starts: 1 }, values: {}, marks: [], branches: [], known_from: 0, source: { drives: true },
    station: { kind: "enabled", enabled: true, attached: true }, options: { modes: {}, keyboard: KEYBOARD, buttons: { first: 1, most: 32 } },
  });
  settings.load({ version: 1, keyboard: { chosen: null, own: [] } });
  for (const part of ["problem", "hint"]) model.set(part, "");
  document.activeElement = null;
  drawFrame();
  sent.length = 0;
});

const ANYWHERE = { matches: () => false };
const event = (code, given = {}) => {
  const key = given.key ?? code.replace(/^(Key|Digit)/, "").toLowerCase();
  return { code, key, target: ANYWHERE, preventDefault() {}, stopPropagation() {}, ...given };
};
const down = (code, given) => handlers.keydown(event(code, given));
const up = (code) => handlers.keyup(event(code));
const press = (code, given) => [down(code, given), up(code)];
const commands = () => sent.splice(0).filter(({ type }) => type === "command").map(({ name, values, id: _, type: __, ...fields }) => values ?? [name, ...Object.values(fields)]);

test("keys that are held move axes and press buttons, gently with Shift, and let go", () => {
  for (const act of [() => down("KeyW"), () => down("ShiftLeft"), () => up("KeyW"), () => up("ShiftLeft"), () => press("Digit5")]) act();
  assert.deepEqual(commands(), [{ [AXIS]: -1 }, { [AXIS]: -0.4 }, { [AXIS]: 0 }, { "joysticks[0].buttons[5]": true }, { "joysticks[0].buttons[5]": false }]);
  for (const act of [() => down("KeyW"), () => down("KeyW", { repeat: true }), () => down("KeyS"), () => handlers.blur()]) act();
  assert.deepEqual(commands(), [{ [AXIS]: -1 }, { [AXIS]: 0 }]);
  down("KeyW");
  handlers.focusin({ target: { matches: () => true } }); // a box for text
  down("KeyW", { target: { matches: () => true } });
  assert.deepEqual(commands(), [{ [AXIS]: -1 }, { [AXIS]: 0 }]);
});

test("the keys of the Driver Station and of robot time", () => {
  for (const code of ["BracketLeft", "BracketRight", "Backslash"]) down(code);
  press("KeyE", { ctrlKey: true });
  for (const code of ["Enter", "NumpadEnter", "Space", "F5", "F6", "F8", "F9"]) press(code, { key: code });
  model.take({ type: "update", station: { attached: false } });
  press("F8", { key: "F8" });
  down("F5", { key: "F5", repeat: true });
  down("F6", { key: "F6", repeat: true });
  const expected = [["enable"], ["enable"], ["disable"], ["disable"], ["e_stop"], ["toggle"], ["step", 1], ["attach", false], ["restart"], ["attach", true], ["step", 1]];
  assert.deepEqual(commands(), expected);
});

test("a control that has the keyboard keeps its keys, but the emergency stop works on the timeline", () => {
  const button = { matches: (selector) => selector.startsWith("button") };
  for (const code of ["Enter", "Space", "ArrowUp"]) press(code, { target: button, key: code });
  assert.deepEqual(commands(), []);
  let left = 0;
  document.activeElement = { matches: (selector) => selector === ".timeline", blur: () => (left += 1) };
  press("Space", { key: " " });
  assert.deepEqual([commands(), left], [[["e_stop"]], 1]);
});

test("who drives a disabled robot is reminded to enable it", () => {
  model.take({ type: "update", station: { kind: "disabled", enabled: false } });
  press("KeyW");
  assert.equal(model.hint, "Enable the robot first: Ctrl+E");
  model.take({ type: "update", station: { kind: "enabled", enabled: true } });
  drawFrame();
  assert.equal(model.hint, "");
});

test("while the panels show the past, nothing drives, and what stops the robot shows the present", async () => {
  const look = () => model.show({ t: 0.5, values: new Map() });
  down("KeyW");
  look();
  drawFrame();
  assert.deepEqual(commands(), [{ [AXIS]: -1 }, { [AXIS]: 0 }]); // the key that is held is released
  for (const code of ["KeyW", "Digit5"]) {
    model.set("problem", "");
    press(code);
    assert.equal(model.problem, PAST);
  }
  model.set("problem", "");
  press("KeyE", { ctrlKey: true });
  assert.deepEqual([commands(), model.problem], [[], PAST]);
  model.set("problem", "");
  write({ "dio[3].value": true });
  command("button", { stick: 0, button: 1, pressed: true });
  command("button", { stick: 0, button: 1, pressed: false }); // letting go is always possible
  assert.deepEqual([commands(), model.problem], [[["button", 0, 1, false]], PAST]);
  press("F6", { key: "F6" });
  await new Promise((resolve) => setTimeout(resolve));
  assert.deepEqual([commands(), model.past.t], [[], 0.52]);
  for (const code of ["Enter", "Space"]) {
    look();
    press(code, { key: code });
    assert.equal(model.past, null);
  }
  assert.deepEqual(commands(), [["disable"], ["e_stop"]]);
});

test("a key that is held drives on in another run", () => {
  down("KeyW");
  model.take({ type: "update", status: { starts: 2, state: "starting" } });
  drawFrame();
  assert.deepEqual(commands(), [{ [AXIS]: -1 }]);
  model.take({ type: "update", status: { state: "running" } });
  drawFrame();
  assert.deepEqual(commands(), [{ [AXIS]: -1 }]);
});

test("a person's own key replaces what it did, and a key with another use is refused with the reason", () => {
  const panel = new KeysPanel({});
  panel.setState = (state) => Object.assign(panel.state, state);
  const add = () => elements(panel.render({}, panel.state)).find((each) => each.props.children === "Add").props;
  const reasons = {
    Space: "Space is the emergency stop. Choose another key.",
    Enter: "Enter disables the robot. Choose another key.",
    F9: "F9 restarts the robot. Choose another key.",
    F11: "F11 belongs to the browser or the system. Choose another key.",
    ShiftLeft: "ShiftLeft makes driving gentle. Choose another key.",
    BracketLeft: "BracketLeft enables the robot, with two others. Choose another key.",
  };
  for (const [code, reason] of Object.entries(reasons)) {
    panel.takeKey(event(code, { key: code }));
    assert.deepEqual([model.problem, add().disabled], [reason, true]);
  }
  panel.takeKey(event("KeyW"));
  assert.deepEqual([model.problem, add().disabled], ["", false]);
  Object.assign(panel.state, { control: "2", by: "-0.5" });
  const box = { reportValidity: () => false }; // the browser says why not
  panel.fields.current = { elements: [box] };
  add().onClick();
  assert.deepEqual(settings.get("keyboard").own, []);
  box.reportValidity = () => true;
  add().onClick();
  panel.takeKey(event("KeyK"));
  add().onClick();
  for (const code of ["KeyW", "KeyK"]) press(code);
  assert.deepEqual(commands(), Array(2).fill([{ "joysticks[0].axes[2]": -0.5 }, { "joysticks[0].axes[2]": 0 }]).flat());
});
