// The Driver Station's keys, the keys of robot time, and the keys that drive.
//
// Names of keys are those of the server: "w", "bracketleft", "return", "shift_l".
import { atRest, command, refusedInPast, write } from "#js/connection.js";
import { model } from "#js/model.js";
import { commandLive, lookByPackets } from "#js/past.js";
import { settings } from "#js/settings.js";

const BY_CODE = {
  BracketLeft: "bracketleft", BracketRight: "bracketright", Backslash: "backslash", Enter: "return", NumpadEnter: "kp_enter",
  Space: "space", ShiftLeft: "shift_l", ShiftRight: "shift_r", ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up",
  ArrowDown: "down",
};

const ACTIONS = {
  return: seen("disable"),
  kp_enter: seen("disable"),
  space: seen("e_stop"),
  f5: () => command("toggle"),
  f6: () => (model.past ? lookByPackets(1) : command("step", { packets: 1 })),
  f8: () => seen("attach", { attached: model.station.attached === false })(),
  f9: seen("restart"),
};
const REPEATING = new Set(["f6"]);

// What a key does that cannot drive, too.
const TAKEN = {
  return: "disables the robot", kp_enter: "disables the robot", space: "is the emergency stop", f5: "pauses the robot",
  f6: "steps by one packet", f8: "disconnects the driver station", f9: "restarts the robot", shift_l: "makes driving gentle",
  shift_r: "makes driving gentle",
};
const OF_BROWSER = /^(f\d+|tab|escape|control|alt|altgraph|meta|capslock|contextmenu|dead|process|unidentified)$/;

const held = new Set();
const pressedAs = new Map(); // code: name at the time of the press
let sent = {};
let starts = null;

// A command whose effect the person sees, also after a look at the past.
function seen(name, fields) {
  return () => {
    if (document.activeElement?.matches(".timeline")) /** @type {any} */ (document.activeElement).blur(); // arrows drive again
    commandLive(name, fields);
  };
}

// What a key does that cannot be bound; "" for any other one.
export function takenBy(name) {
  if (model.hello.options.keyboard.enable_chord.includes(name)) return "enables the robot, with two others";
  return TAKEN[name] ?? (OF_BROWSER.test(name) ? "belongs to the browser or the system" : "");
}

export function keyName(event) {
  if (BY_CODE[event.code]) return BY_CODE[event.code];
  if (/^(Digit|Numpad)\d$/.test(event.code)) return event.code.slice(-1);
  return event.key.toLowerCase();
}

// The bindings that are in force: those of the chosen layout, and the person's own.
export function bindings() {
  const { layouts, chosen } = model.hello.options.keyboard;
  const { chosen: own, own: saved } = settings.get("keyboard");
  const added = saved.filter((one) => !takenBy(one.key));
  const layout = layouts.find((each) => each.name === (own ?? chosen)) ?? layouts[0];
  const axes = Object.fromEntries(Object.entries(layout.axes).map(([key, moves]) => [key, [...moves]]));
  const buttons = Object.fromEntries(Object.entries(model.hello.options.keyboard.button_keys).map(([key, button]) => [key, [[0, button]]]));
  for (const one of added) {
    // The person's own binding replaces what the key did.
    delete axes[one.key];
    delete buttons[one.key];
  }
  for (const one of added) {
    if (one.kind === "axis") (axes[one.key] ??= []).push([one.stick, one.control, one.by]);
    else (buttons[one.key] ??= []).push([one.stick, one.control]);
  }
  return { layout, axes, buttons, added };
}

// What the joysticks' controls should be for the keys that are held: target: value.
function controls() {
  const { axes, buttons } = bindings();
  const gentle = held.has("shift_l") || held.has("shift_r") ? model.hello.options.keyboard.gentle : 1;
  const wanted = {};
  for (const [key, moves] of Object.entries(axes)) {
    for (const [stick, axis, by] of moves) {
      const target = `joysticks[${stick}].axes[${axis}]`;
      wanted[target] = (wanted[target] ?? 0) + (held.has(key) ? by * gentle : 0);
    }
  }
  for (const target of Object.keys(wanted)) wanted[target] = Math.min(Math.max(wanted[target], -1), 1);
  for (const [key, pressed] of Object.entries(buttons)) {
    for (const [stick, button] of pressed) {
      const target = `joysticks[${stick}].buttons[${button}]`;
      wanted[target] = wanted[target] || held.has(key);
    }
  }
  return wanted;
}

function move() {
  if (!model.hello || !model.mayDrive) return;
  const wanted = controls();
  const changed = {};
  for (const target of new Set([...Object.keys(wanted), ...Object.keys(sent)])) {
    const rest = atRest(target);
    const value = wanted[target] ?? rest;
    if (value !== (sent[target] ?? rest)) changed[target] = value;
  }
  sent = wanted;
  if (Object.keys(changed).length) write(changed);
  remind(Object.values(changed).some(Boolean));
}

// A robot that is disabled does not move: say so to a person who drives it.
function remind(drives) {
  const hint = model.station.kind !== "disabled" ? "" : drives ? "Enable the robot first: Ctrl+E" : model.hint;
  if (hint !== model.hint) model.set("hint", hint);
}

function isTyping(target) {
  return target.matches?.('input:not([type="range"]):not([type="checkbox"]):not([type="radio"]), textarea, select, [contenteditable]');
}

// Whether the keyboard is on a control that a key works. What only takes arrows, such as the timeline, leaves the emergency
// stop as it is; and what scrolls leaves arrows as they are, unless the person went there by keys.
function isControl(target, name) {
  if (["left", "right", "up", "down"].includes(name)) return target.matches?.('button, a, summary, input, [tabindex="0"]:is([role], :focus-visible)');
  return ["return", "kp_enter", "space"].includes(name) && target.matches?.("button, a, summary, input");
}

function down(event) {
  if (isTyping(event.target) || event.altKey || event.metaKey || !model.isDriven) return;
  const name = keyName(event);
  if (event.ctrlKey) {
    if (name === "e") {
      event.preventDefault();
      command("enable");
    }
    return;
  }
  if (isControl(event.target, name)) return;
  const act = ACTIONS[name];
  if (act) {
    event.preventDefault();
    if (!event.repeat || REPEATING.has(name)) act();
    return;
  }
  if (event.repeat) return;
  const chord = model.hello.options.keyboard.enable_chord;
  const { axes, buttons } = bindings();
  if ((name in axes || name in buttons) && refusedInPast()) return event.preventDefault();
  const before = chord.every((key) => held.has(key));
  held.add(name);
  pressedAs.set(event.code, name);
  if (!before && chord.every((key) => held.has(key))) command("enable");
  if (["left", "right", "up", "down"].includes(name)) event.preventDefault(); // no scrolling
  move();
}

function up(event) {
  held.delete(pressedAs.get(event.code) ?? keyName(event));
  pressedAs.delete(event.code);
  move();
}

function releaseAll() {
  held.clear();
  pressedAs.clear();
  move();
}

// A robot that was restarted, and a server that has lost this page, know nothing of what was sent.
function again() {
  starts = model.status.starts;
  sent = {};
  move();
}

export function startKeys() {
  addEventListener("keydown", down);
  addEventListener("keyup", up);
  addEventListener("blur", releaseAll);
  model.listen((changed) => {
    if (changed.has("hello") || (model.status.starts !== starts && model.status.state !== "starting")) again();
    if (model.past && held.size) releaseAll();
    if (model.hint && changed.has("station") && model.station.enabled) model.set("hint", "");
  });
  document.addEventListener("focusin", (event) => isTyping(event.target) && releaseAll());
}
