// The state of the simulation, as the server has sent it, and the moment that the panels show.
//
// `model.values` and its neighbours are the present. `model.shown` is what panels draw: the present, or a moment of
// the past while `model.past` is set. Changes are announced once per frame of the screen.

const MOST_LINES = 2000; // of plain output
const MOST_IMPORTANT = 500; // of each other level
const MOST_MARKS = 2000; // and no limit for the person's own

class Model {
  connection = "connecting";
  hello = null;
  readonly = false; // whether the address of this page only shows
  t = 0;
  status = {};
  station = {};
  values = new Map();
  types = {};
  panels = [];
  robot = null;
  trail = [];
  formerTrail = [];
  drawings = [];
  targets = [];
  choosers = [];
  opmodes = [];
  console = [];
  dropped = 0;
  marks = [];
  branches = [];
  compared = null; // the number of the branch that plots show, too
  run = { number: 1, t: 0 };
  clients = 1;
  knownFrom = 0; // the moment from which on values are known: more than 0 when the oldest were forgotten
  tuning = false; // whether this page may set values on a robot elsewhere: only after the person has switched it on
  problem = "";
  hint = ""; // what a person who drives a disabled robot should do
  found = null; // { path, t }: the value that a person is led to, and when; `added`: its curve came with that
  past = null; // { t, values } while the panels show a moment of the past

  #listeners = new Set();
  #bound = new Map(); // path: functions that draw its value
  #needed = new Map(); // owner: beginnings of paths
  #changed = new Set();
  #paths = new Set();
  #scheduled = false;
  #sampleListeners = new Set();

  get shown() {
    return this.past ?? this;
  }

  // Whether the page shows what can be driven, such as a simulation; otherwise it is a log, or a robot elsewhere.
  get isDriven() {
    return Boolean(this.hello?.source?.drives);
  }

  // Whether it shows what is over: a log, or a recorded run.
  get isOver() {
    return Boolean(this.hello?.source?.over);
  }

  // What this page may do to it: drive, set values of NetworkTables.
  get mayDrive() {
    return this.isDriven && !this.readonly;
  }

  get mayWrite() {
    return Boolean(this.hello?.source?.writes) && !this.readonly && (this.tuning || this.hello.source.kind !== "robot");
  }

  // Call a function with the set of changed parts, at most once per frame. Returns a function that ends it.
  listen(listener) {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  // Call a function with a path's value now and whenever it changes. Returns a function that ends it.
  bind(path, draw) {
    if (!this.#bound.has(path)) {
      this.#bound.set(path, new Set());
      this.announce("needs");
    }
    this.#bound.get(path).add(draw);
    draw(this.shown.values.get(path));
    return () => {
      this.#bound.get(path)?.delete(draw);
      if (this.#bound.get(path)?.size !== 0) return;
      this.#bound.delete(path);
      this.announce("needs");
    };
  }

  // Have the server send the values whose paths begin with one of these, as long as `owner` needs them; [] ends it. What is
  // bound comes in any case, and each value when it is new.
  need(owner, beginnings) {
    if (JSON.stringify(beginnings) === JSON.stringify(this.#needed.get(owner) ?? [])) return;
    if (beginnings.length) this.#needed.set(owner, beginnings);
    else this.#needed.delete(owner);
    this.announce("needs");
  }

  get needs() {
    return { paths: [...this.#bound.keys()], beginnings: [...new Set([...this.#needed.values()].flat())] };
  }

  // Call a function with ("samples", {path: [t, v, …]}) or ("run", t), at once.
  onSamples(listener) {
    this.#sampleListeners.add(listener);
    return () => this.#sampleListeners.delete(listener);
  }

  set(part, value) {
    this[part] = value;
    this.announce(part);
  }

  announce(...parts) {
    for (const part of parts) this.#changed.add(part);
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#flush());
  }

  #flush() {
    this.#scheduled = false;
    const changed = this.#changed;
    const paths = this.#paths;
    this.#changed = new Set();
    this.#paths = new Set();
    const values = this.shown.values;
    if (changed.has("shown")) {
      for (const [path, draws] of this.#bound) for (const draw of draws) draw(values.get(path));
    } else if (!this.past) {
      for (const path of paths) {
        const draws = this.#bound.get(path);
        if (draws) for (const draw of draws) draw(values.get(path));
      }
    }
    for (const listener of [...this.#listeners]) listener(changed);
  }

  // Show a moment of the past in every panel, or the present (null).
  show(past) {
    this.past = past;
    this.announce("shown", "values", "station", "robot");
  }

  // Take in `hello` or an `update`.
  take(message) {
    if (message.type === "hello") this.#begin(message);
    else if (message.field) this.hello = { ...this.hello, field: message.field };
    if (message.run) this.#goOn(message.run, message);
    if (message.t !== undefined) this.t = message.t;
    if (message.status) this.status = { ...this.status, ...message.status };
    if (message.station) this.station = { ...this.station, ...message.station };
    for (const [path, value] of Object.entries(message.values ?? {})) {
      if (!this.values.has(path)) this.announce("paths");
      this.values.set(path, value);
      this.#paths.add(path);
    }
    for (const path of message.gone ?? []) {
      this.values.delete(path);
      this.#paths.add(path);
      this.announce("paths");
    }
    if (message.types) Object.assign(this.types, message.types);
    if (message.trail) this.trail = this.trail.slice(0, message.trail.from).concat(message.trail.points);
    if (message.former_trail) this.formerTrail = message.former_trail;
    if (message.console) this.console = lastLines(this.console.concat(message.console));
    if (message.console_dropped) this.dropped += message.console_dropped;
    if (message.marks) this.marks = limited(this.marks.concat(message.marks));
    for (const part of ["panels", "robot", "drawings", "targets", "choosers", "opmodes", "branches", "clients"]) {
      if (part in message) this[part] = message[part];
    }
    if (message.known_from !== undefined) this.knownFrom = message.known_from;
    if (message.samples) for (const listener of this.#sampleListeners) listener("samples", message.samples);
    this.announce(...Object.keys(message));
  }

  #begin(hello) {
    this.hello = hello;
    this.readonly = hello.readonly;
    this.tuning = false;
    this.values = new Map();
    this.types = {};
    this.trail = [];
    this.console = [];
    this.dropped = 0;
    this.marks = [];
    this.announce("hello", "paths", "shown", "needs");
  }

  #goOn(run, message) {
    this.run = run;
    if (message.type === "hello") return;
    if (this.past && this.past.t > run.t) this.show(null);
    this.marks = [];
    for (const listener of this.#sampleListeners) listener("run", run.t);
    this.announce("marks");
  }
}

// The lines without the oldest of too many. A flood of prints leaves the warnings.
function lastLines(lines) {
  if (lines.length <= MOST_LINES) return lines;
  const counts = {};
  const kept = (line) => (counts[line.level] = (counts[line.level] ?? 0) + 1) <= (line.level === "info" ? MOST_LINES : MOST_IMPORTANT);
  return lines.reverse().filter(kept).reverse();
}

// The marks without the oldest of too many.
function limited(marks) {
  let excess = marks.length - MOST_MARKS;
  return excess > 0 ? marks.filter((mark) => mark.kind === "own" || excess-- <= 0) : marks;
}

export const model = new Model();
