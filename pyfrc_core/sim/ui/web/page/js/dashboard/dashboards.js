// The team's dashboards, as the project's file has them, and the draft of the one that is being arranged.
import { ask } from "#js/connection.js";
import { fitted } from "#js/dashboard/grid.js";
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
  draft = null; // { name, formerName, columns, rows, widgets } while one is arranged
  #stamp = "";
  #draftText = ""; // to see whether it was changed

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
    return this.draft ?? (this.name ? fitted(this.saved[this.name]) : null);
  }

  get isChanged() {
    return Boolean(this.draft) && JSON.stringify(this.draft) !== this.#draftText;
  }

  choose(name) {
    settings.set("dashboard", name);
    model.announce("dashboards");
  }

  // -- the draft

  // Arrange a new one, or the one that is shown.
  arrange(name = null) {
    const dashboard = name === null ? this.shown : EMPTY;
    this.draft = structuredClone({ ...dashboard, name: name ?? this.name, formerName: name === null ? this.name : null });
    this.#draftText = name === null ? JSON.stringify(this.draft) : "";
    this.#keep();
  }

  change(change) {
    this.draft = fitted({ ...this.draft, ...change });
    this.#keep();
  }

  discard() {
    this.draft = null;
    this.#keep();
  }

  async save() {
    const { name, formerName, columns, rows, widgets } = this.draft;
    if (await this.#write(name, { columns, rows, widgets }, formerName)) {
      this.draft = null;
      this.choose(name);
      this.#keep();
    }
  }

  async remove(name) {
    if (await this.#write(name, null, null)) this.discard();
  }

  async #write(name, content, formerName) {
    try {
      this.#take(await ask("save_dashboard", { dashboard: name, content, former_name: formerName }));
      return true;
    } catch (error) {
      model.set("problem", error.message);
      return false;
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
    this.saved = dashboards;
    this.problem = problem;
    model.announce("dashboards");
  }
}

export const dashboards = new Dashboards();

model.listen((changed) => {
  if (changed.has("hello")) dashboards.begin(model.hello);
});
