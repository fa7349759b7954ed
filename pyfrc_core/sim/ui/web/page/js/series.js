// The values of watched paths over time: from the server's history, and then as they change.
import { ask } from "#js/connection.js";
import { plain } from "#js/format.js";
import { model } from "#js/model.js";
import { indexAfter } from "#js/times.js";

const FIRST_POINTS = 8000; // more than the packets of a match, of the history, when a path begins to be watched
// A longer series keeps these newest points, and what is older in as many points as at first: memory does not grow.
const MOST_POINTS = 40000;
const NEWEST_POINTS = 20000;

const LATEST = 1e9; // seconds: whatever the newest moment is when the server replies

const series = new Map(); // path: { kind, t: [], v: [], users, isLoaded, exactFrom: since when each change is there }

// Watch a path, and return its series, which grows. Each `watch` needs an `unwatch`.
export function watch(path) {
  let one = series.get(path);
  if (!one) {
    one = { path, kind: "number", t: [], v: [], users: 0, isLoaded: false, exactFrom: 0 };
    series.set(path, one);
    subscribe();
    load(one);
  }
  one.users += 1;
  return one;
}

export function unwatch(path) {
  const one = series.get(path);
  if (!one) return;
  one.users -= 1;
  if (one.users > 0) return;
  series.delete(path);
  subscribe();
}

function subscribe() {
  ask("subscribe", { paths: [...series.keys()] }).catch(() => {});
}

async function load(one, until = LATEST) {
  try {
    const answer = await ask("plot", { paths: [one.path], from: 0, to: until, points: FIRST_POINTS, branch: null });
    const past = answer.series[one.path];
    one.isLoaded = true;
    if (!past) return model.announce("series");
    // What is newer than the answer follows it.
    const last = until < LATEST ? until : (past.t[past.t.length - 1] ?? -1);
    const newer = one.t.findIndex((t) => t > last);
    one.t = past.t.concat(newer < 0 ? [] : one.t.slice(newer));
    one.v = past.v.concat(newer < 0 ? [] : one.v.slice(newer));
    one.exactFrom = past.thinned ? last : 0;
    one.kind = kindOfAll(one);
    model.announce("series");
  } catch {
    // A new connection loads it again.
  }
}

// Whether a series has numbers, booleans or texts: the newest value decides.
function kindOfAll({ kind, v }) {
  const kinds = { number: "number", boolean: "boolean", string: "text" };
  const newest = plain(v[v.length - 1] ?? null);
  return newest === null ? kind : (kinds[typeof newest] ?? "other");
}

function append(samples) {
  for (const [path, list] of Object.entries(samples)) {
    const one = series.get(path);
    if (!one) continue;
    for (let index = 0; index < list.length; index += 2) {
      if (one.t.length && list[index] < one.t[one.t.length - 1]) continue;
      one.t.push(list[index]);
      one.v.push(list[index + 1]);
    }
    one.kind = kindOfAll(one);
    if (one.t.length > MOST_POINTS) shorten(one);
  }
  model.announce("series");
}

async function shorten(one) {
  if (one.isLoading) return;
  one.isLoading = true;
  await load(one, one.t[one.t.length - NEWEST_POINTS]);
  one.isLoading = false;
}

// Another run goes on from a moment: what came later is forgotten.
function forgetAfter(t) {
  for (const one of series.values()) {
    const end = indexAfter(one.t, t);
    one.t.length = end;
    one.v.length = end;
    load(one); // what came between that moment and this message
  }
  model.announce("series");
}

model.onSamples((what, content) => (what === "samples" ? append(content) : forgetAfter(content)));
model.listen((changed) => {
  if (!changed.has("hello") || !series.size) return;
  subscribe();
  for (const one of series.values()) {
    one.t = [];
    one.v = [];
    load(one);
  }
});

// The value in force at `t`; undefined before the first.
export function valueAt(one, t) {
  const index = indexAfter(one.t, t + 1e-6) - 1;
  return index < 0 ? undefined : one.v[index];
}
