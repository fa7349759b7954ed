// Gamepads: which one moves which joystick, and what is sent of it, in frames that the test draws.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame, elements, serve } from "./browser.js";

const sent = serve();
const timers = [];
globalThis.setInterval = (act) => timers.push(act);
document.addEventListener = () => {};
let pads = [];
Object.defineProperty(globalThis, "navigator", { value: { getGamepads: () => pads } });
const { model } = await import("#js/model.js");
const { connect } = await import("#js/connection.js");
const { startGamepads } = await import("#js/input/gamepads.js");
const { Select } = await import("#js/controls.js");
const { JoysticksPanel } = await import("#js/panels/joysticks.js");
const { settings } = await import("#js/settings.js");

connect(() => {}, (state) => model.set("connection", state));
startGamepads();
await new Promise((resolve) => setTimeout(resolve));

const TWIN = "Twin Pad (STANDARD GAMEPAD Vendor: 1 Product: 2)";
const ORDER = { axes: ["left_x", "left_y", "left_trigger", "right_trigger", "right_x", "right_y"], buttons: ["a", "b", "x", "y", "left_bumper", "right_bumper"] };
const JOYSTICK = { axes: {}, buttons: {} };

const pad = (axes, pressed = [], given = {}) => ({
  id: TWIN, index: 0, connected: true, mapping: "standard", axes,
  buttons: Array.from({ length: 17 }, (_, index) => ({ pressed: pressed.includes(index), value: Number(pressed.includes(index)) })), ...given,
});
const writes = () => sent.splice(0).filter(({ name }) => name === "write").map(({ values }) => values);
// One turn of the timer, or of the frame that it has asked for.
const look = (found) => {
  pads = found;
  timers.at(-1)();
  drawFrame();
  return writes();
};

beforeEach(() => {
  look([]);
  model.show(null);
  settings.load({ version: 1, gamepads: {} });
  model.take({
    type: "hello", readonly: false, t: 1, status: { starts: 1 }, values: {}, marks: [], branches: [], known_from: 0, source: { drives: true },
    options: { buttons: { first: 1, most: 32 }, gamepad: ORDER, joysticks: Array(6).fill(JOYSTICK) },
  });
  look([]);
});

test("a gamepad moves the first joystick in the order of the Driver Station, and releases it when it is unplugged", () => {
  const [moved] = look([pad([0.5, -0.75, 0, 0.25], [1, 5, 12])]);
  const axes = [0, 1, 2, 3, 4, 5].map((axis) => moved[`joysticks[0].axes[${axis}]`] ?? 0);
  assert.deepEqual(axes, [0.5, -0.75, 0, 0, 0, 0.25]);
  const pressed = Object.keys(moved).filter((target) => target.includes("buttons") && moved[target]);
  assert.deepEqual([pressed, moved["joysticks[0].povs[0]"]], [["joysticks[0].buttons[2]", "joysticks[0].buttons[6]"], 0]);
  assert.deepEqual(look([pad([0.505, -1, 0, 0.25], [1, 5, 12])]), [{ "joysticks[0].axes[1]": -1 }]); // the smaller movement waits
  const [released] = look([]);
  assert.deepEqual([released["joysticks[0].axes[1]"], released["joysticks[0].buttons[2]"], released["joysticks[0].povs[0]"]], [0, false, -1]);
});

test("a person gives gamepads to joysticks, also two of the same name, and one that is gone is still chosen", () => {
  const found = [pad([0, 0.5, 0, 0]), pad([0, 1, 0, 0]), pad([0.25, -0.5], [0], { id: "Old Stick", mapping: "" })];
  look(found);
  const choice = (stick) => {
    const [made] = elements(new JoysticksPanel({}).render({}, { stick })).filter((each) => each.type?.name === "GamepadChoice");
    return elements(made.type(made.props)).find((each) => each.type === Select).props;
  };
  assert.deepEqual(choice(0).options.map(([, text]) => text), ["Twin Pad", "Keyboard and mouse only", "Twin Pad", "Twin Pad", "Old Stick"]);
  choice(0).set(choice(0).options[3][0]);
  assert.equal(look(found)[0]["joysticks[0].axes[1]"], 1);
  choice(0).set("Old Stick"); // without a layout: it keeps its own numbers
  const moved = Object.assign({}, ...look(found));
  assert.deepEqual([moved["joysticks[0].axes[0]"], moved["joysticks[0].axes[1]"], moved["joysticks[0].buttons[1]"]], [0.25, -0.5, true]);
  look([]);
  assert.deepEqual(choice(0).options.at(-1), ["Old Stick", "Old Stick (not connected)"]);
  choice(0).set("none");
  assert.ok(look(found).every((values) => Object.keys(values).every((target) => !target.startsWith("joysticks[0]"))));
});

test("a page that shows the past, or is hidden, releases them; a robot that was restarted gets everything again", () => {
  const held = [pad([0, -1, 0, 0])];
  const y = () => look(held)[0]["joysticks[0].axes[1]"];
  look(held);
  model.show({ t: 0, values: new Map() });
  assert.equal(y(), 0);
  model.show(null);
  assert.equal(y(), -1);
  /** @type {any} */ (document).hidden = true;
  assert.equal(y(), 0);
  /** @type {any} */ (document).hidden = false;
  look(held);
  model.take({ type: "update", status: { starts: 2 } });
  assert.equal(y(), -1);
});

test("a gamepad shakes as robot code says", () => {
  const played = [];
  const vibrationActuator = { playEffect: async (_, effect) => played.push(effect) };
  model.take({ type: "update", values: { "joysticks[0].left_rumble": 65535 } });
  look([pad([0, 0, 0, 0], [], { vibrationActuator })]);
  assert.deepEqual(played, [{ duration: 150, strongMagnitude: 1, weakMagnitude: 0 }]);
});
