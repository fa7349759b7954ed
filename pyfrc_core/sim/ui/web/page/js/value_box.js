// A box that shows a value of the robot and takes what a person types: Enter, Tab and a click elsewhere write it, Escape
// does not. Only what was edited is written, because the value may have more digits than the box shows.
import { write } from "#js/connection.js";
import { plain, quoted, shownNumber, typedNumber } from "#js/format.js";
import { model } from "#js/model.js";
import { Bound, createRef, html } from "#js/view.js";

const LISTS = { number: "[1, 2.5]", boolean: "[true, false]", string: '["one", "two"]' };

export class ValueBox extends Bound {
  element = createRef();

  get value() {
    return plain(model.shown.values.get(this.props.path));
  }

  // What a person types is left alone.
  paint() {
    const box = this.element.current;
    if (!box || document.activeElement === box) return;
    const whole = wholeText(this.value);
    box.value = shownText(this.value);
    if (whole === box.value) box.removeAttribute("title");
    else box.title = whole;
  }

  render({ path: _, label, ...attributes }) {
    return html`<input type="text" ref=${this.element} aria-label=${label} spellcheck="false" disabled=${!model.mayWrite}
      onFocus=${this.begin} onKeyDown=${this.key} onBlur=${this.leave} ...${attributes} />`;
  }

  begin = ({ target }) => {
    this.before = Array.isArray(this.value) ? wholeText(this.value) : shownText(this.value);
    target.value = this.before;
    target.select();
  };

  key = (event) => {
    event.stopPropagation();
    const box = event.target;
    if (event.key === "Escape") box.value = this.before;
    if (event.key === "Escape" || (event.key === "Enter" && this.take(box))) box.blur();
  };

  leave = ({ target }) => {
    if (target.value === this.before) this.say("");
    this.take(target);
    target.classList.remove("wrong");
    this.paint();
  };

  // Write what was typed, and return true. What is wrong stays in the box, with the reason above.
  take(box) {
    if (box.value === this.before) return true;
    try {
      write({ [this.props.path]: parsed(this.value, box.value) });
    } catch (error) {
      box.classList.add("wrong");
      this.say(`${this.props.label}: ${error.message}.`);
      return false;
    }
    this.before = box.value;
    this.say("");
    return true;
  }

  say(problem) {
    if (problem || model.problem === this.problem) model.set("problem", problem);
    this.problem = problem;
  }
}

function shownText(value) {
  if (typeof value === "number") return shownNumber(value);
  if (Array.isArray(value)) return JSON.stringify(value.map((each) => (typeof each === "number" ? Number(shownNumber(each)) : each)));
  return String(value ?? "");
}

function wholeText(value) {
  return Array.isArray(value) ? JSON.stringify(value) : String(value ?? "");
}

// What a typed text means for a value of this kind.
function parsed(before, text) {
  if (typeof before === "number") return typedNumber(text);
  if (!Array.isArray(before)) return text;
  const kind = typeof (before[0] ?? 0);
  const fits = (each) => (before.length === 0 || typeof each === kind) && (typeof each !== "number" || Number.isFinite(each));
  const list = listIn(text);
  if (!list?.every(fits)) throw new Error(`a list such as ${LISTS[kind]} is needed, not ${quoted(text)}`);
  return list;
}

function listIn(text) {
  try {
    const found = JSON.parse(text);
    return Array.isArray(found) ? found : null;
  } catch {
    return null;
  }
}
