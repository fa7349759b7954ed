// The branch that the person compares with: a ghost on the field, dashed curves in the plots.
import { ask } from "#js/connection.js";
import { model } from "#js/model.js";
import { valueAt } from "#js/series.js";

const POINTS = 4000;

class Compared {
  id = null;
  pose = { t: [], v: [] };
  difference; // the first moment at which the branch differs from the present run; null: none, undefined: not known

  // Where the branch ends, which may be later than the present; 0 without a branch.
  get end() {
    return model.branches.find((each) => each.id === this.id)?.to ?? 0;
  }

  // The robot's place in the branch at a moment; null where the branch knows none.
  poseAt(t) {
    if (this.id === null) return null;
    if (t > this.end + 1e-6) return null;
    return valueAt(this.pose, t) ?? null;
  }

  async choose(id) {
    this.id = id;
    this.pose = { t: [], v: [] };
    this.difference = undefined;
    if (id === null) return;
    try {
      const answer = await ask("plot", { paths: ["sim.pose"], from: 0, to: this.end, points: POINTS, branch: id });
      if (this.id === id) this.pose = answer.series["sim.pose"] ?? this.pose;
      const first = await ask("first_difference", { branch: id, paths: null });
      if (this.id === id) this.difference = first.t;
    } catch {
      // It may be gone: then there is nothing to show.
    }
    model.announce("compared-series", "robot");
  }
}

export const compared = new Compared();

model.listen((changed) => {
  if (changed.has("compared")) compared.choose(model.compared);
});
