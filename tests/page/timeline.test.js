// The timeline: moments as places, marks near the pointer, keys, and a past that is forgotten.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { drawFrame, elements, serve } from "./browser.js";

const { model } = await import("#js/model.js");
const { Timeline } = await import("#js/timeline.js");
const { connect } = await import("#js/connection.js");

const sent = serve();
connect(() => {}, () => {});

let timeline;

beforeEach(() => {
  model.show(null);
  model.take({ type: "hello", options: { modes: {} }, t: 100, status: { length: 100 }, values: {}, marks: [], branches: [], known_from: 0 });
  model.set("problem", "");
  timeline = new Timeline();
  timeline.size = { width: 1016 };
  timeline.canvas.current = { getBoundingClientRect: () => ({ left: 0, width: 1016 }) };
});

const settled = () => new Promise((resolve) => setTimeout(resolve)).then(drawFrame);
const press = (key, shiftKey = false) => timeline.key({ key, shiftKey, preventDefault() {}, stopPropagation() {} });

test("a place is a moment, and beyond the ends there is none", () => {
  assert.equal(timeline.x(25), 258);
  for (const [clientX, t] of [[258, 25], [0, 0], [2000, 100]]) assert.equal(timeline.timeAt({ clientX }), t);
  model.take({ type: "update", t: 2, status: { length: 2 } });
  assert.equal(timeline.x(5), 508); // a short run has ten seconds
  assert.equal(timeline.timeAt({ clientX: 900 }), 2);
});

test("marks near the pointer are named, the last ones if there are many", () => {
  model.take({ type: "update", marks: [10, 10.4, 11, 50].map((t, n) => ({ n: n + 1, t, kind: "own", text: `at ${t}` })) });
  assert.deepEqual(timeline.marksNear(10.1).map((mark) => mark.t), [10, 10.4]);
  model.take({ type: "update", marks: Array.from({ length: 9 }, (_, n) => ({ n: n + 5, t: 50, kind: "press", text: `${n}` })) });
  assert.deepEqual(timeline.marksNear(50).map((mark) => mark.text), ["4", "5", "6", "7", "8"]);
});

test("keys look at other packets, and at the present again", async () => {
  const seen = [];
  for (const [key, shift] of [["Home"], ["ArrowRight"], ["ArrowRight", true], ["PageUp"], ["ArrowLeft"], ["End"]]) {
    press(key, shift);
    await settled();
    seen.push(model.past && Number(model.past.t.toFixed(2)));
  }
  assert.deepEqual(seen, [0, 0.02, 1.02, 2.02, 2, null]);
});

test("a panel that opens while a moment is on its way gets its values", async () => {
  drawFrame();
  sent.length = 0;
  press("Home");
  model.announce("needs"); // as when its rows are bound
  drawFrame();
  await settled();
  const asked = () => sent.filter(({ type }) => type === "show" || type === "values").map(({ type }) => type);
  assert.equal(asked().at(-1), "values");
  assert.ok(asked().includes("show") && asked().indexOf("show") < asked().lastIndexOf("values"));
});

test("before what is known, the first known packet is shown, and a sentence says why", async () => {
  model.take({ type: "update", known_from: 60.003 });
  press("Home");
  await settled();
  assert.equal(model.past.t, 60.02);
  assert.equal(model.problem, "The values before 1:00.00 were forgotten, since memory for them is limited.");
  const tip = (t) => elements(timeline.render({}, { hover: { t, left: 60 } })).filter((each) => each.type === "span").map(({ props }) => props.children);
  assert.deepEqual([tip(5), tip(70)], [["Values forgotten"], []]);
  model.set("problem", "");
  press("ArrowRight");
  await settled();
  assert.deepEqual([model.past.t, model.problem], [60.04, ""]);
});
