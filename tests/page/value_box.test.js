// Numbers, texts and lists in boxes: what is shown, what is typed, and what reaches the robot.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame, serve } from "./browser.js";

const sent = serve();
const { model } = await import("#js/model.js");
const { connect } = await import("#js/connection.js");
const { ValueBox } = await import("#js/value_box.js");

connect(() => {}, () => {});
await new Promise((resolve) => setTimeout(resolve));

const KP = "nt:/SmartDashboard/kP";
let box;
let element;

beforeEach(() => {
  model.take({ type: "hello", readonly: false, t: 0, values: { [KP]: 0.5 }, marks: [], known_from: 0, source: { writes: true } });
  model.set("problem", "");
  const classes = new Set();
  element = { value: "", title: "", classList: classes, select() {}, blur: () => document.activeElement === element && leave(), removeAttribute: () => (element.title = "") };
  classes.remove = classes.delete;
  box = new ValueBox({ path: KP, label: "kP" });
  box.element.current = element;
  document.activeElement = null;
  box.paint();
  drawFrame();
  sent.length = 0;
});

const written = () => sent.splice(0).map(({ values }) => values[KP]);
const publish = (value) => {
  model.take({ type: "update", values: { [KP]: value } });
  box.paint();
};
const enter = () => {
  document.activeElement = element;
  box.begin({ target: element });
};
const leave = () => {
  document.activeElement = null;
  box.leave({ target: element });
};
const press = (key) => box.key({ key, target: element, stopPropagation() {} });
const type = (text, key) => {
  enter();
  element.value = text;
  press(key);
};

test("a number keeps its digits unless it is edited", () => {
  for (const [value, text] of [[6e-5, "0.00006"], [1e-9, "1e-9"], [12345678.5, "12345678.5"], [1 / 3, "0.333333"]]) {
    publish(value);
    assert.equal(element.value, text);
    enter();
    press("Enter");
    enter();
    leave(); // Tab, or a click elsewhere
  }
  assert.equal(element.title, String(1 / 3));
  assert.deepEqual(written(), []);
  type("7e-5", "Enter");
  assert.deepEqual([written(), document.activeElement], [[7e-5], null]);
});

test("who leaves the box writes what was typed, Escape does not, and what is typed is left alone", () => {
  enter();
  element.value = "2,5";
  publish(9);
  assert.equal(element.value, "2,5");
  leave();
  assert.deepEqual(written(), [2.5]);
  publish(2.5);
  type("3", "Escape");
  assert.deepEqual([written(), element.value], [[], "2.5"]);
});

test("what is no number stays in the box, with the reason, until it is right", () => {
  const reasons = {
    "1,000": "write thousands without a comma and decimals with a point, not “1,000”.",
    three: "a number is needed, not “three”.",
    "": "a number is needed, not “”.",
    "1e999": "“1e999” is too large.",
  };
  for (const [text, reason] of Object.entries(reasons)) {
    type(text, "Enter");
    assert.deepEqual([model.problem, element.value, document.activeElement, element.classList.has("wrong")], [`kP: ${reason}`, text, element, true]);
  }
  press("Escape");
  assert.deepEqual([model.problem, element.value, element.classList.has("wrong"), written()], ["", "0.5", false, []]);
});

test("a list is edited with all digits of its numbers, and keeps its kind", () => {
  publish([1 / 3, 2]);
  assert.equal(element.value, "[0.333333,2]");
  enter();
  assert.equal(element.value, "[0.3333333333333333,2]");
  for (const text of ["[1, 2", '["one"]', "3"]) {
    type(text, "Enter");
    assert.equal(model.problem, `kP: a list such as [1, 2.5] is needed, not “${text}”.`);
  }
  type("[0.3333333333333333,0.5]", "Enter");
  assert.deepEqual(written(), [[1 / 3, 0.5]]);
});

test("a text is written as it is", () => {
  publish("left");
  type("1,000", "Enter");
  assert.deepEqual(written(), ["1,000"]);
});
