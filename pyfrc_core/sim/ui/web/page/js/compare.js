// The branch that the person compares with: a ghost on the field, dashed curves in the plots.
import { Disconnected, ask } from "#js/connection.js";
import { model } from "#js/model.js";
import { length } from "#js/past.js";
import { valueAt } from "#js/series.js";

const POINTS = 4000;
const AGAIN = 2000; // the fewest milliseconds between two comparisons while the robot runs

class Compared {
  id = null;
  pose = { t: [], v: [] };
  offset; // of the branch that was asked for
  first = null; // where the branch first differs from the present run: { t, paths, others, until }; of a log that drives it, more
  #compared = ""; // how far the run was when it was compared
  #waits = false;

  get branch() {
    return model.branches.find((each) => each.id === this.id);
  }

  // What tells apart the curves of branches, also before and after one was moved in time; null without a branch.
  get key() {
    return this.id === null ? null : `${this.id} ${this.branch?.offset}`;
  }

  // Where the branch ends, which may be later than the present; 0 without a branch.
  get end() {
    return this.branch?.to ?? 0;
  }

  // The robot's place in the branch at a moment; null where the branch knows none.
  poseAt(t) {
    if (this.id === null) return null;
    if (t > this.end + 1e-6) return null;
    return valueAt(this.pose, t) ?? null;
  }

  async choose(id) {
    this.id = id;
    this.offset = this.branch?.offset;
    this.pose = { t: [], v: [] };
    this.first = null;
    this.#compared = "";
    if (id === null) return;
    this.compare();
    try {
      const answer = await ask("plot", { paths: ["sim.pose"], from: 0, to: this.end, points: POINTS, branch: id });
      if (this.id === id) this.pose = answer.series["sim.pose"] ?? this.pose;
    } catch {
      // It may be gone: then there is nothing to show.
    } finally {
      model.announce("compared-series", "robot");
    }
  }

  // Compare the branch with this run, again as long as the run goes on. Times of another clock never agree exactly, so other
  // logs are not compared; a former run keeps its first difference.
  async compare() {
    const { id, branch, first } = this;
    if (!branch || branch.compared === false || (branch.offset === undefined && first?.t != null)) return;
    const place = `${id} ${this.offset} ${model.run.number} ${model.run.t} ${length()}`;
    if (this.#waits || place === this.#compared) return;
    this.#waits = true;
    this.#compared = place;
    const began = performance.now();
    model.announce("compared-series");
    try {
      const answer = await ask("first_difference", { branch: id, paths: null });
      if (this.id === id) this.first = answer;
    } catch (error) {
      if (error instanceof Disconnected) this.#compared = ""; // else it may be gone
    }
    model.announce("compared-series");
    setTimeout(() => {
      this.#waits = false;
      this.compare();
    }, Math.max(AGAIN, performance.now() - began)); // a long one has half of the time
  }
}

export const compared = new Compared();

const known = new Set(); // the logs that drive the run: they are compared with it at first

model.listen((changed) => {
  if (changed.has("branches")) {
    for (const { id, compared: drives } of model.branches) {
      if (!drives || known.has(id)) continue;
      known.add(id);
      model.set("compared", id);
    }
  }
  if (changed.has("t") || changed.has("status") || changed.has("run")) compared.compare();
  // A branch that was just opened, or moved in time, is asked for again.
  const moved = changed.has("branches") && compared.id !== null && compared.branch?.offset !== compared.offset;
  if (changed.has("compared") || moved) compared.choose(model.compared);
});
