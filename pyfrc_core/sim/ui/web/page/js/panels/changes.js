// What has changed around the moment that is shown, what changes rarely first: a state, a fault, a command.
import { ask } from "#js/connection.js";
import { changeText, clock } from "#js/format.js";
import { goTo } from "#js/input/moment_keys.js";
import { momentText } from "#js/match_clock.js";
import { model } from "#js/model.js";
import { nameOf } from "#js/names.js";
import { PlotButton, Select } from "#js/controls.js";
import { carryPath } from "#js/plotting.js";
import { MOST_EACH } from "#js/recorded.js";
import { Live, html } from "#js/view.js";

const REACHES = [0.1, 0.5, 2]; // seconds before and after the moment
const LIVE_INTERVAL = 500; // milliseconds

export class ChangesPanel extends Live {
  parts = ["shown", "t", "status"];
  state = { reach: 0.5, t: -1, changes: [] };

  componentDidMount() {
    super.componentDidMount();
    this.update();
  }

  componentDidUpdate() {
    this.update();
  }

  // One question at a time; the newest moment counts.
  async update() {
    const t = model.past?.t ?? model.t;
    const { reach } = this.state;
    if (this.asking || (t === this.askedAt && reach === this.askedReach)) return;
    this.asking = true;
    this.askedAt = t;
    this.askedReach = reach;
    const answer = await ask("changes", { t, reach }).catch(() => null);
    this.asking = false;
    if (answer) this.setState({ t, changes: answer.changes });
  }

  render(_, { reach, t, changes }) {
    this.interval = model.past ? 0 : LIVE_INTERVAL;
    return html`<div class="networktables content column changes">
      <div class="changes-head flex"><span>Around ${momentText(Math.max(t, 0))}</span>
        <${Select} aria-label="How far around" value=${reach} options=${REACHES.map((each) => [each, `± ${each} s`])} set=${(each) => this.setState({ reach: Number(each) })} /></div>
      <div class="scroll fill" role="list">${changes.map((change) => html`<${Change} key=${`${change.path} ${change.t}`} ...${change} />`)}
        ${!changes.length && html`<p class="empty">Nothing has changed then. What changes rarely comes first here.</p>`}</div>
    </div>`;
  }
}

function Change({ path, t, before, after, count, near }) {
  const text = near > MOST_EACH ? `${near} changes` : changeText(before, after);
  return html`<div class="nt-row flex change" role="listitem" title=${`${path}, ${count} changes in all`} draggable="true" onDragStart=${(event) => carryPath(event, path)} data-path=${path}>
    <span class="row-label long-name"><bdi>${nameOf(path)}</bdi></span>
    <span class="faint">${text}</span>
    <span class="row-tools"><${PlotButton} name=${nameOf(path)} paths=${[path]} /></span>
    <button class="quiet when" title="Look at the moment of this change" onClick=${() => goTo(t)}>${clock(t)}</button></div>`;
}
