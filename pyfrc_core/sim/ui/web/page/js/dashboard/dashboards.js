// The team's dashboards, as the project's file has them, the draft of the one that is being arranged, and the steps of
// arranging.
import { ask } from "#js/connection.js";
import { askWhether } from "#js/dialog.js";
import { fitted } from "#js/dashboard/grid.js";
import { Steps, same } from "#js/dashboard/steps.js";
import { model } from "#js/model.js";
import { isRecorded } from "#js/recorded.js";
import { settings } from "#js/settings.js";

const LOOK_EVERY = 2000; // milliseconds: another page, an editor or Git may have changed the file
// A page that is reloaded finds its draft here, in this tab of the browser.
const UNSAVED = "pyfrc-dashboard";

export const EMPTY = { columns: 12, rows: 8, widgets: [] };

class Dashboards {
  saved = {}; // by name
  problem = ""; // what is wrong with the file
  draft = null; // { name, columns, rows, widgets, base } while one is arranged; base: what the file had; null for a new one
  chosen = -1; // the widget of the draft that was touched last
  steps = new Steps(); // what this page has changed since it was opened
  #stepsBefore = this.steps; // when arranging began
  #stamp = "";
  #isWriting = false;

  get names() {
    return Object.keys(this.saved);
  }

  // The name of the one that is shown.
  get name() {
    if (this.draft) return this.draft.name;
    const chosen = settings.get("dashboard");
    return chosen in this.saved ? chosen : (this.names[0] ?? "");
  }

  // The one that is shown; null if there is none.
  get shown() {
    return this.draft ?? this.inFile(this.name);
  }

  // A dashboard as the file has it; null if it has none of this name.
  inFile(name) {
    return name in this.saved ? fitted({ name, ...this.saved[name] }) : null;
  }

  get isChanged() {
    const { draft } = this;
    return Boolean(draft) && (draft.base ? !same(draft, draft.base) : draft.widgets.length > 0);
  }

  // Whether Git, an editor or another page has written something else in the place of the draft since arranging began.
  get isOvertaken() {
    if (!this.draft || this.problem) return false;
    const { name, base } = this.draft;
    return Boolean(base && !same(base, this.inFile(base.name))) || (name !== base?.name && this.inFile(name) !== null);
  }

  choose(name) {
    settings.set("dashboard", name);
    model.announce("dashboards");
  }

  // -- the draft

  // Arrange the one that is shown, or a new one that has this name.
  arrange(name = "", content = EMPTY) {
    this.chosen = -1;
    const dashboard = name ? fitted({ ...content, name }) : this.shown;
    this.#stepsBefore = this.steps;
    this.draft = structuredClone({ ...dashboard, base: name ? null : dashboard });
    if (name) this.#record(null, this.draft);
    this.#keep();
  }

  change(change) {
    const { draft } = this;
    this.draft = fitted({ ...draft, ...change });
    this.#record(draft, this.draft);
    this.#keep();
  }

  discard() {
    this.draft = null;
    this.steps = this.#stepsBefore;
    this.#keep();
  }

  // Go on with what the file has now. It is a step: undone, it brings the draft back.
  takeOver() {
    const { draft } = this;
    const found = this.inFile(draft.base?.name) ?? this.inFile(draft.name);
    if (!found) return;
    this.draft = { ...found, base: found };
    this.#record(draft, this.draft);
    this.#keep();
  }

  async save() {
    await this.look();
    const { draft } = this;
    if (!draft) return; // a second click
    const seen = this.#seen(draft.base, draft); // before the question: meanwhile, there may be a third one
    const found = this.inFile(draft.name) ?? this.inFile(draft.base?.name);
    if (this.isOvertaken && !(await askWhether(overtakenText(draft.base?.name ?? draft.name, found), found ? "Replace it" : "Save"))) return;
    if (!(await this.#write(draft.base, draft, seen))) return;
    if (found && !same(found, draft.base)) this.#record(found, draft); // undone, it brings the other one back
    this.draft = null;
    this.choose(draft.name);
    this.#keep();
  }

  // -- what is written at once

  async rename(name) {
    const dashboard = this.shown;
    const renamed = { ...dashboard, name };
    if (!(await this.#write(dashboard, renamed))) return;
    this.#record(dashboard, renamed);
    this.choose(name);
  }

  async remove() {
    const dashboard = this.shown;
    if (await this.#write(dashboard, null)) this.#record(dashboard, null);
  }

  // Take over a layout for Elastic, of the robot or of the project: each of its tabs becomes a dashboard.
  async takeLayout() {
    const found = await ask("elastic_layout").catch((error) => model.set("problem", error.message));
    if (!found) return;
    const taken = [];
    for (const [name, content] of Object.entries(found.dashboards)) {
      const [before, after] = [this.inFile(name), { ...content, name }];
      if (before && !same(before, after) && !(await askWhether(`There is a dashboard “${name}” already. Replace it? Undo brings it back.`, "Replace it"))) continue;
      if (!(await this.#write(before, after))) return;
      this.#record(before, after);
      taken.push(name);
    }
    if (taken.length) this.choose(taken[0]);
    const missing = found.missing.length ? ` Not shown, since there is no such widget here: ${found.missing.join("; ")}.` : "";
    model.set("problem", `From ${found.from}: ${taken.join(", ") || "nothing"}.${missing}`);
  }

  // -- steps

  // Undo a step, or do the next one again: in the draft while one is arranged, otherwise in the file.
  async go(isUndo) {
    const way = this.way(isUndo);
    if (!way || this.#isWriting) return;
    if (!this.draft) await this.look();
    const { from, to } = way;
    if (!this.fits(way)) {
      const what = isUndo ? "can no longer be undone" : "can no longer be done again";
      return model.set("problem", `“${(from ?? to).name}” was changed elsewhere since then: this step ${what}.`);
    }
    const steps = this.steps.after(isUndo);
    if (this.draft) this.draft = { ...to, base: this.draft.base };
    else if (await this.#write(from, to)) this.choose((to ?? from).name);
    else return;
    this.steps = steps;
    this.#keep();
  }

  // From which dashboard to which one the next step leads; null if there is none. A draft has only its own steps.
  way(isUndo) {
    const step = this.steps.next(isUndo);
    if (!step) return null;
    const way = isUndo ? { from: step.after, to: step.before, step } : { from: step.before, to: step.after, step };
    return this.draft && (!way.to || way.from?.name !== this.draft.name) ? null : way;
  }

  // Whether a dashboard is as the step has left it, so that undoing it loses nothing else.
  fits({ from, to }) {
    if (this.draft) return same(from, this.draft);
    const isNew = to && to.name !== from?.name;
    return same(from, from && this.inFile(from.name)) && !(isNew && to.name in this.saved);
  }

  #record(before, after) {
    this.steps = this.steps.with(before && content(before), after && content(after));
  }

  // -- writing

  // What the file has in the places of two dashboards, as far as this page knows.
  #seen(from, to) {
    return Object.fromEntries([from, to].filter(Boolean).map(({ name }) => [name, this.saved[name] ?? null]));
  }

  // Have the file contain another dashboard in the place of one; null: none. Nothing is written if the file has something
  // else there than what was seen.
  async #write(from, to, seen = this.#seen(from, to)) {
    const { name } = to ?? from;
    const written = to && { columns: to.columns, rows: to.rows, widgets: to.widgets };
    this.#isWriting = true;
    try {
      this.#take(await ask("save_dashboard", { dashboard: name, content: written, former_name: from?.name ?? null, seen }));
      return true;
    } catch (error) {
      model.set("problem", error.message);
      this.look(); // what was changed meanwhile
      return false;
    } finally {
      this.#isWriting = false;
    }
  }

  #keep() {
    if (!isRecorded) {
      if (this.draft) sessionStorage.setItem(UNSAVED, JSON.stringify({ root: model.hello.project.root, draft: this.draft }));
      else sessionStorage.removeItem(UNSAVED);
    }
    model.announce("dashboards");
  }

  // -- the file

  // Follow the file as long as a panel shows it. Returns a function that ends it.
  follow() {
    if (isRecorded) return () => {};
    const timer = setInterval(() => this.look(), LOOK_EVERY);
    this.look();
    return () => clearInterval(timer);
  }

  async look() {
    const found = await ask("dashboards", { stamp: this.#stamp }).catch(() => null);
    if (found?.dashboards) this.#take(found);
  }

  // What the server has sent at first.
  begin({ dashboards, project, readonly }) {
    if (dashboards) this.#take(dashboards);
    const unsaved = isRecorded || readonly || this.draft ? null : sessionStorage.getItem(UNSAVED);
    if (!unsaved) return;
    const { root, draft } = JSON.parse(unsaved);
    if (root === project.root) this.draft = draft;
  }

  #take({ stamp, dashboards, problem }) {
    this.#stamp = stamp;
    if (!problem) this.saved = dashboards; // otherwise the last that were read: drivers may be looking at one
    this.problem = problem;
    model.announce("dashboards");
  }
}

function content({ name, columns, rows, widgets }) {
  return { name, columns, rows, widgets };
}

function overtakenText(name, found) {
  const what = found ? "changed" : "removed";
  return `“${name}” was ${what} in sim/dashboards.json since you began to arrange it. ${found ? "Replace it? Undo brings the other one back." : "Save it again?"}`;
}

export const dashboards = new Dashboards();

model.listen((changed) => {
  if (changed.has("hello")) dashboards.begin(model.hello);
});
