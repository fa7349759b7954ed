// Why the robot program has ended: the user's own line first, and the ways to go on.
import { goTo } from "#js/input/moment_keys.js";
import { momentText } from "#js/match_clock.js";
import { model } from "#js/model.js";
import { commandLive } from "#js/past.js";
import { SourceLink } from "#js/source.js";
import { Icon, Live, html } from "#js/view.js";

const BACK = 2; // seconds
// The code cannot be loaded: it fails again at any moment.
const UNREADABLE = /\b(SyntaxError|IndentationError|TabError)\b/;

export class FailureBar extends Live {
  parts = ["status", "shown", "series"];

  render() {
    const failure = model.status.state === "failed" ? model.status.failure : null;
    if (!failure) return null;
    const goesBack = failure.t > 0 && !UNREADABLE.test(failure.headline);
    const watch = model.hello.options.watch && model.isDriven;
    return html`<section class="failure" role="alert" aria-label="The robot program has failed">
      <div class="failure-head flex">
        <${Icon} name="warning" />
        <div class="failure-text column fill">
          <strong>${failure.headline}</strong>
          <span>The robot program ended at ${momentText(failure.t)}. ${failure.file && html`<${SourceLink} file=${failure.file} line=${failure.line} />`}
            ${watch && " Save the corrected file, and the simulation goes on."}</span>
        </div>
        <div class="failure-actions">
          ${model.isOver && failure.t > 0 && html`<button onClick=${() => goTo(failure.t - BACK)}>2 s before</button>`}
          ${goesBack && model.isDriven && html`<button class="primary" onClick=${() => commandLive("rewind", { t: Math.max(failure.t - BACK, 0) })} disabled=${!model.mayDrive}>Go back 2 s and drive on</button>`}
          ${failure.t > 0 && html`<button onClick=${() => goTo(failure.t)}>Values of that moment</button>`}
          ${!watch && model.isDriven && html`<button onClick=${() => commandLive("reload")} disabled=${!model.mayDrive} title="After you have corrected it: run it with the same inputs until this moment">Load the code again</button>`}
          ${model.isDriven && html`<button onClick=${() => commandLive("restart")} disabled=${!model.mayDrive}><${Icon} name="restart" />Restart</button>`}
        </div>
      </div>
      ${failure.details && html`<details><summary>Traceback</summary><pre tabindex="0">${failure.details}</pre></details>`}
    </section>`;
  }
}
