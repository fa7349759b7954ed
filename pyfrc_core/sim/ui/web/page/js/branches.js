// The menu of the branches: former runs, and logs that are shown beside the present one.
import { command } from "#js/connection.js";
import { compared } from "#js/compare.js";
import { askText } from "#js/dialog.js";
import { clock, typedNumber } from "#js/format.js";
import { Menu } from "#js/popup.js";
import { model } from "#js/model.js";
import { chooseLog } from "#js/open_log.js";
import { FirstDifference, showDifferences, waiting } from "#js/panels/differences.js";
import { isRecorded } from "#js/recorded.js";
import { html } from "#js/view.js";

export function BranchesMenu() {
  const opens = model.isOver && !isRecorded && !model.readonly;
  if (!model.branches.length && !opens) return null;
  /** @type {any[]} */
  const items = model.branches.map((branch) => ({
    text: branch.name,
    note: `${clock(branch.from)} – ${clock(branch.to)}`,
    checked: model.compared === branch.id,
    act: () => model.set("compared", model.compared === branch.id ? null : branch.id),
  }));
  const chosen = model.branches.find((branch) => branch.id === model.compared);
  if (chosen) {
    items.push({ separator: true }, { text: `Name “${chosen.name}”…`, act: () => nameBranch(chosen), disabled: model.readonly });
    if (compared.first) items.push({ text: "What differs, and what moves the sensors", act: showDifferences });
    if (chosen.offset !== undefined) items.push({ text: "Move it in time…", act: () => moveBranch(chosen), disabled: model.readonly });
  }
  if (opens) items.push(...(items.length ? [{ separator: true }] : []), { text: "Show another log beside it…", act: chooseLog });
  const { first } = compared;
  const waits = chosen && !first && chosen.compared;
  return html`${chosen && first && html`<${FirstDifference} first=${first} />`}${waits && html`<span class="faint">${waiting()}</span>`}
    <${Menu} label=${model.branches.length ? `Branches ${model.branches.length}` : "Compare"} icon="branch" title=${model.isOver ? "Compare with another log" : "Compare with an earlier run"} items=${items} />`;
}

async function nameBranch(branch) {
  const name = await askText("The name of the branch", branch.name);
  if (name) command("name_branch", { branch: branch.id, text: name });
}

async function moveBranch(branch) {
  const text = await askText(`How many seconds later “${branch.name}” is shown; a negative number shows it earlier`, String(branch.offset));
  if (!text) return;
  try {
    command("move_branch", { branch: branch.id, offset: typedNumber(text) });
  } catch (error) {
    model.set("problem", error.message);
  }
}
