// The browser's gamepads move joysticks: the first one joystick 0 and so on, unless the person assigns others.
import { atRest, write } from "#js/connection.js";
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";

// The controls of a gamepad with the browser's "standard" mapping: numbers of axes, and of buttons.
const STANDARD_AXES = { left_x: 0, left_y: 1, right_x: 2, right_y: 3 };
const STANDARD_BUTTONS = {
  a: 0, b: 1, x: 2, y: 3, left_bumper: 4, right_bumper: 5, left_trigger: 6, right_trigger: 7, back: 8, start: 9, left_stick: 10,
  right_stick: 11, up: 12, down: 13, left: 14, right: 15, guide: 16,
};
const HATS = { "0,-1": 0, "1,-1": 45, "1,0": 90, "1,1": 135, "0,1": 180, "-1,1": 225, "-1,0": 270, "-1,-1": 315 };
const STEP = 0.01; // the smallest movement that is passed on
const STICKS = 6;
const RUMBLES = ["left_rumble", "right_rumble"];

const passedOn = {}; // joystick: what was sent last, target: value
let names = "";
let starts = null;
let hello = null;
let polling = false; // once a frame

export function gamepads() {
  return [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad?.connected);
}

// The gamepad of a joystick: "" for none, otherwise its id with a number if there are several of the kind.
export function assignedTo(stick, pads = gamepads()) {
  const chosen = settings.get("gamepads")[stick];
  if (chosen === "none") return null;
  if (chosen !== undefined) return pads.find((pad) => labelOf(pad, pads) === chosen) ?? null;
  const taken = new Set(Object.values(settings.get("gamepads")));
  return pads.filter((pad) => !taken.has(labelOf(pad, pads)))[stick] ?? null;
}

export function labelOf(pad, pads) {
  const same = pads.filter((each) => each.id === pad.id);
  return same.length > 1 ? `${pad.id} #${same.indexOf(pad) + 1}` : pad.id;
}

export function padName(pad) {
  return pad.id.replace(/\s*\((STANDARD GAMEPAD )?.*Vendor:.*\)$/, "") || pad.id;
}

// The state of a gamepad as axes, buttons and POV in the order of the Driver Station.
export function read(pad) {
  if (pad.mapping !== "standard") {
    return { axes: [...pad.axes], buttons: pad.buttons.map((button) => button.pressed), pov: -1 };
  }
  const order = model.hello.options.gamepad;
  const axis = (name) => (name in STANDARD_AXES ? pad.axes[STANDARD_AXES[name]] : (pad.buttons[STANDARD_BUTTONS[name]]?.value ?? 0));
  const pressed = (index) => Number(Boolean(pad.buttons[index]?.pressed));
  const hat = `${pressed(15) - pressed(14)},${pressed(13) - pressed(12)}`;
  return {
    axes: order.axes.map(axis),
    buttons: order.buttons.map((name) => pressed(STANDARD_BUTTONS[name])),
    pov: HATS[hat] ?? -1,
  };
}

function targetsOf(stick, reading) {
  const targets = {};
  reading.axes.slice(0, 12).forEach((value, axis) => {
    targets[`joysticks[${stick}].axes[${axis}]`] = Math.min(Math.max(value ?? 0, -1), 1);
  });
  const { first, most } = model.hello.options.buttons;
  reading.buttons.slice(0, most).forEach((pressed, index) => {
    targets[`joysticks[${stick}].buttons[${first + index}]`] = pressed;
  });
  targets[`joysticks[${stick}].povs[0]`] = reading.pov;
  return targets;
}

function poll() {
  polling = gamepads().length > 0 || Object.keys(passedOn).length > 0;
  if (polling) requestAnimationFrame(poll);
  if (!model.hello || !model.mayDrive || model.connection !== "open") return;
  // A robot that was restarted, and a server that has lost this page, know nothing of what was passed on.
  if (model.hello !== hello || (model.status.starts !== starts && model.status.state !== "starting")) {
    hello = model.hello;
    starts = model.status.starts;
    for (const stick of Object.keys(passedOn)) delete passedOn[stick];
  }
  // A page that does not show what they do gets nothing from its gamepads: they are released.
  const pads = document.hidden || model.past ? [] : gamepads();
  const seen = pads.map((pad) => pad.id).join("\n");
  if (seen !== names) {
    names = seen;
    model.announce("gamepads");
  }
  const changed = {};
  for (let stick = 0; stick < STICKS; stick++) {
    const pad = assignedTo(stick, pads);
    const before = passedOn[stick];
    if (!pad && !before) continue;
    const now = pad ? targetsOf(stick, read(pad)) : Object.fromEntries(Object.keys(before).map((target) => [target, atRest(target)]));
    for (const [target, value] of Object.entries(now)) {
      const old = before?.[target] ?? atRest(target);
      const small = typeof value === "number" && Math.abs(value - old) < STEP && ![-1, 0, 1].includes(value);
      if (value === old || small) now[target] = old;
      else changed[target] = value;
    }
    if (pad) passedOn[stick] = now;
    else delete passedOn[stick];
  }
  if (Object.keys(changed).length) write(changed);
}

// Let a joystick's gamepad shake, as long as the robot's code says so.
function rumble() {
  const pads = gamepads();
  for (let stick = 0; stick < STICKS; stick++) {
    const strength = RUMBLES.map((name) => Number(model.values.get(`joysticks[${stick}].${name}`) ?? 0));
    if (!strength.some((each) => each > 0)) continue;
    const [strong, weak] = strength.map((each) => Math.min(each / 65535, 1));
    assignedTo(stick, pads)?.vibrationActuator
      ?.playEffect("dual-rumble", { duration: 150, strongMagnitude: strong, weakMagnitude: weak })
      .catch(() => {});
  }
}

// A page that asks for frames without a gamepad would keep the browser busy while nothing changes.
function look() {
  if (!polling) poll();
  rumble();
}

export function startGamepads() {
  model.need("rumble", Array.from({ length: STICKS }, (_, stick) => RUMBLES.map((name) => `joysticks[${stick}].${name}`)).flat());
  setInterval(look, 100);
  document.addEventListener("visibilitychange", poll); // frames no longer come when it is hidden
}
