// What the robot prints: by level, by time, by search.
import { clock } from "#js/format.js";
import { goTo } from "#js/input/moment_keys.js";
import { model } from "#js/model.js";
import { settings } from "#js/settings.js";
import { SourceLink } from "#js/source.js";
import { SearchBox } from "#js/controls.js";
import { Live, classes, createRef, html } from "#js/view.js";

const LEVELS = [["info", "Output"], ["warning", "Warnings"], ["error", "Errors"], ["pyfrc", "pyfrc"]];
const MOST_SHOWN = 150;
const APART = 1; // the most seconds between equal lines that are shown as one

// Equal lines that follow each other, as one: how many there are, and until when.
export function grouped(lines) {
  const groups = [];
  for (const line of lines) {
    const last = groups.at(-1);
    const repeats = last && last.line.text === line.text && last.line.level === line.level && line.t - last.until <= APART;
    if (!repeats) groups.push({ line, count: 0 });
    groups.at(-1).count += 1;
    groups.at(-1).until = line.t;
  }
  return groups;
}

export class ConsolePanel extends Live {
  parts = ["console", "shown", "settings", "hello"];
  interval = 150;
  state = { search: "", shown: MOST_SHOWN };
  search = (search) => this.setState({ search });
  list = createRef();
  follow = true;

  componentDidMount() {
    super.componentDidMount();
    this.scrollDown();
  }

  componentDidUpdate() {
    if (this.follow) this.scrollDown();
  }

  scrollDown() {
    const list = this.list.current;
    if (list) list.scrollTop = list.scrollHeight;
  }

  render(_, { search, shown }) {
    const levels = new Set(settings.get("console").levels);
    const wanted = search.toLowerCase();
    const until = model.past ? model.past.t + 1e-6 : Infinity;
    const chosen = model.console.filter((line) => levels.has(line.level) && line.t <= until && (!wanted || line.text.toLowerCase().includes(wanted)));
    const lines = grouped(chosen);
    const visible = lines.slice(-shown);
    return html`<div class="console content column">
      <div class="panel-tools flex">
        <${SearchBox} label="Search the output" text=${search} search=${this.search} />
        <div class="segments small" role="group" aria-label="Levels">
          ${LEVELS.map(([level, text]) => html`<button key=${level} aria-pressed=${levels.has(level)}
            class=${classes({ chosen: levels.has(level), [`level-${level}`]: true })} onClick=${() => toggle(level)}>${text}
            <small>${count(level)}</small></button>`)}
        </div>
      </div>
      <div class="lines fill scroll" ref=${this.list} onScroll=${this.scrolled} tabindex="0" role="log" aria-label="Output of the robot">
        ${model.dropped > 0 && html`<p class="faint">${model.dropped} lines were left out: the robot prints faster than anyone can read.</p>`}
        ${lines.length > visible.length && html`<button class="link" onClick=${() => this.setState({ shown: shown + MOST_SHOWN })}>Show earlier lines (${lines.length - visible.length})</button>`}
        ${visible.map((group) => html`<${Line} key=${group.line.n} ...${group} />`)}
        ${!lines.length && html`<p class="empty">${model.console.length ? "No line matches." : model.isOver ? "There is no output in it." : "What the robot prints appears here."}</p>`}
      </div>
    </div>`;
  }

  scrolled = () => {
    const list = this.list.current;
    this.follow = list.scrollHeight - list.scrollTop - list.clientHeight < 24;
  };
}

function Line({ line, count, until }) {
  return html`<div class=${`line ${line.level}`}>
    <button class="line-time" title="Look at this moment" onClick=${() => goTo(line.t)}>${clock(line.t)}</button>
    <span class="line-text">${line.text || " "}${count > 1 && html` <small>×${count}, until ${clock(until)}</small>`}</span>
    ${line.file && html`<${SourceLink} file=${line.file} line=${line.line} />`}
  </div>`;
}

function count(level) {
  return model.console.reduce((sum, line) => sum + (line.level === level), 0);
}

function toggle(level) {
  const { levels } = settings.get("console");
  settings.set("console", { levels: levels.includes(level) ? levels.filter((each) => each !== level) : [...levels, level] });
}
