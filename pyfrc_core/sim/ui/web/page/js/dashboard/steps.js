// The steps of arranging dashboards, as values: each is what a dashboard was before, and what it was after it. Nothing
// here knows the page or the file, and nothing is changed in place.
//
// A dashboard is { name, columns, rows, widgets }, or null where there is none.

export class Steps {
  /**
   * @param {any[]} done { before, after } of each step, the oldest first
   * @param {any[]} undone the same, the one that was undone last at the end
   */
  constructor(done = [], undone = []) {
    this.done = done;
    this.undone = undone;
  }

  // The step that would be undone or done again next; undefined if there is none.
  next(isUndo) {
    return (isUndo ? this.done : this.undone).at(-1);
  }

  // With one more step, unless it changes nothing. What was undone before it is gone.
  with(before, after) {
    return same(before, after) ? this : new Steps([...this.done, { before, after }]);
  }

  // With the next step undone, or done again.
  after(isUndo) {
    const step = this.next(isUndo);
    if (!step) return this;
    return isUndo ? new Steps(this.done.slice(0, -1), [...this.undone, step]) : new Steps([...this.done, step], this.undone.slice(0, -1));
  }
}

// Whether two dashboards are the same, however their widgets are spelled: the file leaves out what is empty.
export function same(one, other) {
  return JSON.stringify(spelled(one)) === JSON.stringify(spelled(other));
}

function spelled(dashboard) {
  if (!dashboard) return null;
  const { name, columns, rows, widgets } = dashboard;
  return { name, columns, rows, widgets: widgets.map(withoutEmpty) };
}

function differ(widget, other) {
  return JSON.stringify(withoutEmpty(widget)) !== JSON.stringify(withoutEmpty(other));
}

function withoutEmpty(widget = {}) {
  const isEmpty = (value) => value === undefined || value === null || value === "" || (Array.isArray(value) && !value.length);
  return Object.entries(widget).filter(([, value]) => !isEmpty(value)).sort(([one], [other]) => (one < other ? -1 : 1));
}

// What a step has changed, in a few words.
export function stepText({ before, after }, titleOf) {
  if (!before) return `“${after.name}” made`;
  if (!after) return `“${before.name}” removed`;
  if (before.name !== after.name) return `“${before.name}” renamed`;
  if (before.columns !== after.columns || before.rows !== after.rows) return "grid changed";
  const [less, more] = [before.widgets.length, after.widgets.length];
  if (more === less + 1) return `${titleOf(after.widgets[less])} added`;
  const index = before.widgets.findIndex((widget, each) => !after.widgets[each] || differ(widget, after.widgets[each]));
  if (more === less - 1) return `${titleOf(before.widgets[index])} removed`;
  if (more !== less || index < 0) return `“${after.name}” replaced`;
  const [was, is] = [before.widgets[index], after.widgets[index]];
  const what = was.w !== is.w || was.h !== is.h ? "size changed" : was.x !== is.x || was.y !== is.y ? "moved" : "settings changed";
  return `${titleOf(is)}: ${what}`;
}
